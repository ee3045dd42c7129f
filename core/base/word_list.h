// SPDX-License-Identifier: Apache-2.0
// Lists of words as people type them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace beam {

// Without blanks around it.
std::string_view trimmed(std::string_view text);
// What stands between the commas, trimmed; none that are empty.
std::vector<std::string> splitAtCommas(std::string_view text);
// "a, b, c and 12 more".
std::string shortList(const std::vector<std::string>& names, std::size_t most = 5);
// Of A to Z alone.
std::string lowerCase(std::string_view word);

// Whether it is whole UTF-8 (RFC 3629): no overlong form, surrogate or value above 10FFFF.
bool isUtf8(std::string_view text);

}  // namespace beam
