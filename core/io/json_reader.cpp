// SPDX-License-Identifier: Apache-2.0
#include "core/io/json_reader.h"

#include <cctype>
#include <cmath>

#include "core/base/json_words.h"
#include "core/base/word_list.h"
#include "core/io/file.h"

namespace beam {
namespace {

constexpr int kMaxSide = 65536;

// Puts quotation marks around the words nan, inf and infinity (any case, with or without a minus) outside of
// strings.
std::string quoteNonNumbers(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  bool in_string = false;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (in_string || !std::isalpha(static_cast<unsigned char>(c))) {
      if (c == '"') in_string = !in_string;
      out += c;
      if (in_string && c == '\\' && i + 1 < text.size()) out += text[++i];
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && std::isalpha(static_cast<unsigned char>(text[end]))) ++end;
    const std::string word = text.substr(i, end - i), lower = lowerCase(word);
    if (lower == "nan" || lower == "inf" || lower == "infinity") {
      const bool minus = !out.empty() && out.back() == '-';
      if (minus) out.pop_back();
      out += fmt::format("\"{}{}\"", minus ? "-" : "", word);
    } else {
      out += word;
    }
    i = end;
  }
  return out;
}

}  // namespace

nlohmann::json readJson(const std::filesystem::path& path) {
  const std::string text = readTextFile(path);
  try {
    return nlohmann::json::parse(quoteNonNumbers(text), shallowJson<nlohmann::json>);
  } catch (const Error& e) {
    throw Error(e.kind(), fmt::format("\"{}\": {}", path.string(), e.what()));
  } catch (const nlohmann::json::exception& e) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\" is no valid JSON: {}", path.string(), jsonComplaint(e)));
  }
}

double finiteNumber(const nlohmann::json& object, const char* key, const std::string& where) {
  if (!object.contains(key)) {
    throw Error(Error::Kind::Data, fmt::format("{}: expected a number \"{}\", found none", where, key));
  }
  const nlohmann::json& v = object.at(key);
  if (!v.is_number() || !std::isfinite(v.get<double>())) {
    throw Error(Error::Kind::Data, fmt::format("{}: expected \"{}\" to be a finite number, found {}", where,
                                               key, shortJson(v.dump())));
  }
  return v.get<double>();
}

int pictureSide(const nlohmann::json& object, const char* key, const std::string& where) {
  const double v = finiteNumber(object, key, where);
  if (!(v >= 1 && v <= kMaxSide)) {
    throw Error(Error::Kind::Data,
                fmt::format("{}: expected \"{}\" from 1 to {} pixels, found {}", where, key, kMaxSide, v));
  }
  return static_cast<int>(v);
}

}  // namespace beam
