// SPDX-License-Identifier: Apache-2.0
// What the JSON library says of a text that it does not understand, in words for people.
#pragma once

#include <exception>
#include <string>

namespace beam {

// "line 3, column 5: unexpected end of input; expected '}'", "settings/a.b: expected string, found number":
// without the exception's name and number.
std::string jsonComplaint(const std::exception& e);

// Objects and lists in each other; ours need six, and deep ones would exhaust the stack of whoever copies or
// prints them.
inline constexpr int kDeepestJson = 64;
void requireShallowJson(int depth);  // throws Error{Data}
// For Json::parse(), which calls it as it goes deeper.
template <class Json>
bool shallowJson(int depth, typename Json::parse_event_t, Json&) {
  requireShallowJson(depth);
  return true;
}

// A value as messages show it: not all of a long one.
std::string shortJson(std::string text);

}  // namespace beam
