// SPDX-License-Identifier: Apache-2.0
#include "core/io/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include "core/base/error.h"
#include "core/io/file.h"

namespace beam {
namespace {

constexpr std::uint64_t kMaxFile = 8ull << 30;
constexpr std::size_t kMaxProperties = 1024, kMaxElements = 64;

enum class Format { Ascii, Little, Big };

std::optional<PlyType> typeOf(const std::string& name) {
  static const std::map<std::string, PlyType> kNames = {
      {"char", PlyType::Char},     {"int8", PlyType::Char},     {"uchar", PlyType::UChar},
      {"uint8", PlyType::UChar},   {"short", PlyType::Short},   {"int16", PlyType::Short},
      {"ushort", PlyType::UShort}, {"uint16", PlyType::UShort}, {"int", PlyType::Int},
      {"int32", PlyType::Int},     {"uint", PlyType::UInt},     {"uint32", PlyType::UInt},
      {"float", PlyType::Float},   {"float32", PlyType::Float}, {"double", PlyType::Double},
      {"float64", PlyType::Double}};
  const auto found = kNames.find(name);
  if (found == kNames.end()) return std::nullopt;
  return found->second;
}

std::size_t sizeOfType(PlyType t) {
  switch (t) {
    case PlyType::Char:
    case PlyType::UChar:
      return 1;
    case PlyType::Short:
    case PlyType::UShort:
      return 2;
    case PlyType::Double:
      return 8;
    default:
      return 4;
  }
}

class PlyReader {
 public:
  PlyReader(const std::filesystem::path& path, std::size_t most_rows, std::string bytes)
      : path_(path), most_rows_(most_rows), bytes_(std::move(bytes)) {}

  std::vector<PlyElement> readHeader() {
    header();
    return std::move(elements_);
  }

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
        if (elements_.size() == kMaxElements) bad(fmt::format("more than {} elements", kMaxElements));
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
    PlyElement& e = elements_.back();
    if (e.properties.size() == kMaxProperties) bad(fmt::format("more than {} properties", kMaxProperties));
    PlyProperty p;
    std::string word;
    in >> word;
    if (word == "list") {
      in >> word;
      p.count_type = typeOf(word);
      if (!p.count_type) bad(fmt::format("unknown type in \"{}\"", text));
      in >> word;
    }
    const std::optional<PlyType> type = typeOf(word);
    in >> p.name;
    if (!type || p.name.empty()) bad(fmt::format("cannot understand \"{}\"", text));
    p.type = *type;
    e.columns += p.count_type ? 0 : 1;
    e.properties.push_back(std::move(p));
  }

  // The count against the bytes that are left, before anything is allocated.
  void checkCount(const PlyElement& e) const {
    std::size_t least = 0;
    for (const PlyProperty& p : e.properties) {
      least += format_ == Format::Ascii ? 2 : sizeOfType(p.count_type.value_or(p.type));
    }
    const std::size_t left = bytes_.size() - at_ + 1;
    if (e.count > left / std::max<std::size_t>(least, 1)) {
      bad(fmt::format(
          "the header announces {} rows of \"{}\", {} bytes are left; the file is truncated or damaged",
          e.count, e.name, left));
    }
    requireRowsWithin(e.count, most_rows_, e.name, path_);
  }

  void body(PlyElement& e) {
    const bool as_stored = format_ == Format::Little &&
                           std::all_of(e.properties.begin(), e.properties.end(), [](const PlyProperty& p) {
                             return p.type == PlyType::Float && !p.count_type;
                           });
    e.values.resize(e.count * e.columns);
    if (as_stored) {
      const std::size_t size = e.values.size() * sizeof(float);
      if (size > bytes_.size() - at_) bad("the file ends before its last row; it is truncated");
      if (size > 0) std::memcpy(e.values.data(), bytes_.data() + at_, size);
      at_ += size;
      return;
    }
    if (e.columns < e.properties.size()) e.lists.reserve(e.count);
    const bool wide = std::any_of(e.properties.begin(), e.properties.end(), [](const PlyProperty& p) {
      return p.type == PlyType::Double && !p.count_type;
    });
    if (wide) e.wide.reserve(e.values.size());
    float* out = e.values.data();
    for (std::size_t row = 0; row < e.count; ++row) {
      bool first_list = true;
      for (const PlyProperty& p : e.properties) {
        if (!p.count_type) {
          const double v = value(p.type);
          *out++ = static_cast<float>(v);
          if (wide) e.wide.push_back(v);
        } else {
          std::vector<std::uint32_t> list = listOf(e, row, p);
          if (first_list) e.lists.push_back(std::move(list));
          first_list = false;
        }
      }
    }
  }

  std::vector<std::uint32_t> listOf(const PlyElement& e, std::size_t row, const PlyProperty& p) {
    const double n = value(*p.count_type);
    if (!(n >= 0 && n <= 1024)) bad(fmt::format("row {} of \"{}\" has a list of {} entries", row, e.name, n));
    std::vector<std::uint32_t> list;
    for (int i = 0; i < static_cast<int>(n); ++i) {
      const double v = value(p.type);
      if (!(v >= 0 && v <= 4294967295.0)) {
        bad(fmt::format("row {} of \"{}\" lists {}, expected an index", row, e.name, v));
      }
      list.push_back(static_cast<std::uint32_t>(v));
    }
    return list;
  }

  double value(PlyType type) { return format_ == Format::Ascii ? asciiValue() : binaryValue(type); }

  double asciiValue() {
    while (at_ < bytes_.size() && std::isspace(static_cast<unsigned char>(bytes_[at_]))) ++at_;
    if (at_ < bytes_.size() && bytes_[at_] == '+') ++at_;  // from_chars knows no plus
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

  double binaryValue(PlyType t) {
    switch (t) {
      case PlyType::Char:
        return raw<std::int8_t>();
      case PlyType::UChar:
        return raw<std::uint8_t>();
      case PlyType::Short:
        return raw<std::int16_t>();
      case PlyType::UShort:
        return raw<std::uint16_t>();
      case PlyType::Int:
        return raw<std::int32_t>();
      case PlyType::UInt:
        return raw<std::uint32_t>();
      case PlyType::Float:
        return raw<float>();
      case PlyType::Double:
        return raw<double>();
    }
    return 0;
  }

  std::filesystem::path path_;
  std::size_t most_rows_;
  std::string bytes_;
  std::size_t at_ = 0;
  Format format_ = Format::Ascii;
  std::vector<PlyElement> elements_;
};

}  // namespace

std::optional<std::size_t> PlyElement::column(const std::string& property) const {
  std::size_t position = 0;
  for (const PlyProperty& p : properties) {
    if (p.count_type) continue;
    if (p.name == property) return position;
    ++position;
  }
  return std::nullopt;
}

void requireRowsWithin(std::size_t rows, std::size_t most, const std::string& element,
                       const std::filesystem::path& path) {
  if (rows <= most) return;
  throw Error(
      Error::Kind::Data,
      fmt::format("\"{}\": {} rows of \"{}\" pass the limit of {} that a PLY file is read and written "
                  "with; make it with fewer",
                  path.string(), rows, element, most));
}

std::vector<PlyElement> readPly(const std::filesystem::path& path, std::size_t most_rows) {
  return PlyReader(path, most_rows, readTextFile(path, kMaxFile)).read();
}

std::vector<PlyElement> readPlyHeader(const std::filesystem::path& path) {
  constexpr std::size_t kMostHeader = 1u << 20;
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed))
    throw Error(Error::Kind::Data, fmt::format("\"{}\": expected a PLY file", path.string()));
  std::ifstream in(path, std::ios::binary);
  std::string bytes(kMostHeader, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return PlyReader(path, kMostPlyRows, std::move(bytes)).readHeader();
}

std::string plyComments(const FileNotes& notes) {
  std::string lines;
  for (const auto& [name, text] : notes) lines += fmt::format("comment {} {}\n", name, text);
  return lines;
}

const PlyElement* findElement(const std::vector<PlyElement>& elements, const std::string& name) {
  for (const PlyElement& e : elements) {
    if (e.name == name) return &e;
  }
  return nullptr;
}

}  // namespace beam
