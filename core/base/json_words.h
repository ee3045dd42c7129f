// SPDX-License-Identifier: Apache-2.0
// What the JSON library says of a text that it does not understand, in words for people.
#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace beam {

// "line 3, column 5: unexpected end of input; expected '}'", "settings/a.b: expected string, found number":
// without the exception's name and number.
std::string jsonComplaint(const std::exception& e);

// Objects and lists in each other; ours need six, and deep ones would exhaust the stack of whoever copies or
// prints them.
inline constexpr int kDeepestJson = 64;
// What Json::parse() calls: throws Error{Data} for a text that goes deeper.
bool shallowJson(int depth);

// A value as messages show it: not all of a long one.
std::string shortJson(std::string text);

}  // namespace beam
