// SPDX-License-Identifier: Apache-2.0
#include "core/io/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <sstream>

#include "core/base/error.h"
#include "core/io/file.h"

namespace beam {
namespace {

constexpr std::uint64_t kMaxFile = 8ull << 30;
constexpr std::size_t kMaxCount = 1u << 26;

enum class Format { Ascii, Little, Big };

std::string canonicalType(const std::string& t) {
  static const std::map<std::string, std::string> kNames = {
      {"char", "char"},   {"int8", "char"},     {"uchar", "uchar"},   {"uint8", "uchar"},
      {"short", "short"}, {"int16", "short"},   {"ushort", "ushort"}, {"uint16", "ushort"},
      {"int", "int"},     {"int32", "int"},     {"uint", "uint"},     {"uint32", "uint"},
      {"float", "float"}, {"float32", "float"}, {"double", "double"}, {"float64", "double"}};
  const auto found = kNames.find(t);
  return found == kNames.end() ? "" : found->second;
}

std::size_t sizeOfType(const std::string& t) {
  if (t == "char" || t == "uchar") return 1;
  if (t == "short" || t == "ushort") return 2;
  return t == "double" ? 8 : 4;
}

class PlyReader {
 public:
  explicit PlyReader(const std::filesystem::path& path) : path_(path), bytes_(readTextFile(path, kMaxFile)) {}

  std::vector<PlyElement> read() {
    header();
    for (PlyElement& e : elements_) {
      checkCount(e);
      body(e);
    }
    return std::move(elements_);
  }

 private:
  [[noreturn]] void bad(const std::string& what) const {
    throw Error(Error::Kind::Data, fmt::format("\"{}\": {}", path_.string(), what));
  }

  std::string line() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string::npos || end - at_ > 65536) bad("expected a PLY header that ends in end_header");
    std::string text = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.pop_back();
    return text;
  }

  void header() {
    if (line() != "ply") bad("expected a PLY file");
    for (std::string text = line(); text != "end_header"; text = line()) {
      std::istringstream in(text);
      std::string word;
      in >> word;
      if (word == "format") {
        in >> word;
        if (word != "ascii" && word != "binary_little_endian" && word != "binary_big_endian") {
          bad(fmt::format("unknown PLY format \"{}\"", word));
        }
        format_ = word == "ascii"                  ? Format::Ascii
                  : word == "binary_little_endian" ? Format::Little
                                                   : Format::Big;
      } else if (word == "element") {
        PlyElement e;
        long long count = -1;
        in >> e.name >> count;
        if (!in || count < 0) bad(fmt::format("expected \"element NAME COUNT\", found \"{}\"", text));
        e.count = static_cast<std::size_t>(count);
        elements_.push_back(std::move(e));
      } else if (word == "property") {
        property(in, text);
      }
    }
  }

  void property(std::istringstream& in, const std::string& text) {
    if (elements_.empty()) bad("a property stands before any element");
    PlyProperty p;
    in >> p.type;
    if (p.type == "list") {
      in >> p.list_type >> p.type;
      p.list_type = canonicalType(p.list_type);
      if (p.list_type.empty()) bad(fmt::format("unknown type in \"{}\"", text));
    }
    p.type = canonicalType(p.type);
    in >> p.name;
    if (p.type.empty() || p.name.empty()) bad(fmt::format("cannot understand \"{}\"", text));
    elements_.back().properties.push_back(std::move(p));
  }

  // The count against the bytes that are left, before anything is allocated.
  void checkCount(const PlyElement& e) const {
    std::size_t least = 0;
    for (const PlyProperty& p : e.properties) {
      least += format_ == Format::Ascii ? 2 : sizeOfType(p.list_type.empty() ? p.type : p.list_type);
    }
    const std::size_t left = bytes_.size() - at_ + 1;
    if (e.count > kMaxCount || (least > 0 && e.count > left / least)) {
      bad(fmt::format(
          "the header announces {} rows of \"{}\", {} bytes are left; the file is truncated or damaged",
          e.count, e.name, left));
    }
  }

  void body(PlyElement& e) {
    bool has_list = false;
    for (const PlyProperty& p : e.properties) has_list |= !p.list_type.empty();
    e.columns.assign(e.properties.size(), {});
    for (std::size_t c = 0; c < e.properties.size(); ++c) {
      if (e.properties[c].list_type.empty()) e.columns[c].reserve(e.count);
    }
    if (has_list) e.lists.reserve(e.count);
    for (std::size_t row = 0; row < e.count; ++row) {
      bool first_list = true;
      for (std::size_t c = 0; c < e.properties.size(); ++c) {
        const PlyProperty& p = e.properties[c];
        if (p.list_type.empty()) {
          e.columns[c].push_back(value(p.type));
          continue;
        }
        const double n = value(p.list_type);
        if (!(n >= 0 && n <= 1024))
          bad(fmt::format("row {} of \"{}\" has a list of {} entries", row, e.name, n));
        std::vector<std::uint32_t> list;
        for (int i = 0; i < static_cast<int>(n); ++i)
          list.push_back(static_cast<std::uint32_t>(value(p.type)));
        if (first_list) e.lists.push_back(std::move(list));
        first_list = false;
      }
    }
  }

  double value(const std::string& type) {
    return format_ == Format::Ascii ? asciiValue() : binaryValue(type);
  }

  double asciiValue() {
    while (at_ < bytes_.size() && std::isspace(static_cast<unsigned char>(bytes_[at_]))) ++at_;
    double v = 0;
    const char* end = bytes_.data() + bytes_.size();
    const auto result = std::from_chars(bytes_.data() + at_, end, v);
    if (result.ec != std::errc()) bad("expected a number, found something else or the file's end");
    at_ = static_cast<std::size_t>(result.ptr - bytes_.data());
    return v;
  }

  template <class T>
  T raw() {
    if (at_ + sizeof(T) > bytes_.size()) bad("the file ends before its last row; it is truncated");
    std::array<char, sizeof(T)> b;
    std::memcpy(b.data(), bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    if (format_ == Format::Big) std::reverse(b.begin(), b.end());
    return std::bit_cast<T>(b);
  }

  double binaryValue(const std::string& t) {
    if (t == "float") return raw<float>();
    if (t == "double") return raw<double>();
    if (t == "char") return raw<std::int8_t>();
    if (t == "uchar") return raw<std::uint8_t>();
    if (t == "short") return raw<std::int16_t>();
    if (t == "ushort") return raw<std::uint16_t>();
    if (t == "int") return raw<std::int32_t>();
    return raw<std::uint32_t>();
  }

  std::filesystem::path path_;
  std::string bytes_;
  std::size_t at_ = 0;
  Format format_ = Format::Ascii;
  std::vector<PlyElement> elements_;
};

}  // namespace

const std::vector<double>* PlyElement::column(const std::string& property) const {
  for (std::size_t c = 0; c < properties.size(); ++c) {
    if (properties[c].name == property && properties[c].list_type.empty()) return &columns[c];
  }
  return nullptr;
}

std::vector<PlyElement> readPly(const std::filesystem::path& path) { return PlyReader(path).read(); }

const PlyElement* findElement(const std::vector<PlyElement>& elements, const std::string& name) {
  for (const PlyElement& e : elements) {
    if (e.name == name) return &e;
  }
  return nullptr;
}

}  // namespace beam
