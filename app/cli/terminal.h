// SPDX-License-Identifier: Apache-2.0
// What is known of a terminal, and text that fits into it. Widths are columns of the screen: a letter of an
// East Asian script takes two, a combining mark none.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace beam {

// A terminal on which lines can be drawn over: none for TERM=dumb or without TERM.
bool isDrawable(int descriptor);
// As it is now, at least 20; 80 where the terminal does not say.
int columnsOf(int descriptor);

std::size_t columnsOf(std::string_view text);
// The whole text where it fits, else its beginning and "...".
std::string cutToColumns(std::string_view text, std::size_t columns);
// Broken at blanks, further lines indented by two; a word that is longer than a line stays whole.
std::string foldedToColumns(std::string_view text, std::size_t columns);

}  // namespace beam
