// SPDX-License-Identifier: Apache-2.0
// What the JSON library says of a text that it does not understand, in words for people.
#pragma once

#include <exception>
#include <string>

namespace beam {

// "line 3, column 5: unexpected end of input; expected '}'", "settings/a.b: expected string, found number":
// without the exception's name and number.
std::string jsonComplaint(const std::exception& e);

}  // namespace beam
