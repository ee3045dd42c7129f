// SPDX-License-Identifier: Apache-2.0
#include "core/base/json_words.h"

#include <fmt/format.h>

#include <string_view>

#include "core/base/error.h"

namespace beam {
namespace {

void cut(std::string& text, std::string_view what, std::string_view by = {}) {
  if (const std::size_t at = text.find(what); at != std::string::npos) text.replace(at, what.size(), by);
}

// "syntax error while parsing object key - " tells the parser's state, not the user's mistake.
void cutParserState(std::string& text) {
  const std::size_t begin = text.find("syntax error while parsing "), end = text.find(" - ", begin);
  if (begin != std::string::npos && end != std::string::npos) text.erase(begin, end + 3 - begin);
}

}  // namespace

std::string jsonComplaint(const std::exception& e) {
  std::string text = e.what();
  if (text.starts_with("[json.exception.")) text.erase(0, text.find("] ") + 2);
  cut(text, "parse error at ");
  cut(text, "parse error: ");
  cutParserState(text);
  // "(/capture/relative) type must be string, but is number"
  if (text.starts_with("(/")) {
    text.erase(0, 2);
    cut(text, ") ", ": ");
  }
  for (const char* access : {"cannot use at() with ", "cannot use value() with "})
    cut(text, access, "expected object, found ");
  cut(text, "type must be ", "expected ");
  cut(text, ", but is ", ", found ");
  if (const std::size_t key = text.find("key '"); key != std::string::npos) {
    cut(text, "key '", "expected \"");
    cut(text, "' not found", "\", found none");
  }
  return text;
}

void requireShallowJson(int depth) {
  if (depth <= kDeepestJson) return;
  throw Error(Error::Kind::Data, fmt::format("expected at most {} levels, found more", kDeepestJson));
}

std::string shortJson(std::string text) {
  constexpr std::size_t kLongest = 60;
  return text.size() > kLongest ? text.substr(0, kLongest) + " ..." : text;
}

}  // namespace beam
