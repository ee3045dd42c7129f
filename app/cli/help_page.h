// SPDX-License-Identifier: Apache-2.0
// Text of help: headings, paragraphs and rows of two columns, no line wider than kHelpColumns.
#pragma once

#include <string>
#include <string_view>

namespace beam {

inline constexpr std::size_t kHelpColumns = 80;

class HelpPage {
 public:
  explicit HelpPage(std::size_t left_columns = 26) : left_columns_(left_columns) {}

  void heading(std::string_view title);  // with a blank line before it
  void paragraph(std::string_view text, std::size_t indent = 0);
  void blank();
  // `left` on a line of its own where it is too long.
  void row(std::string_view left, std::string_view right);

  // A line as typed, whole even where it is too long for the page: it is broken with a backslash, as a shell
  // takes it.
  void example(std::string_view typed, std::string_view what);
  void append(const HelpPage& rows);

  const std::string& text() const { return text_; }  // ends with its last line, without a line break

 private:
  void line(std::size_t indent, std::string_view text);

  std::size_t left_columns_;
  std::string text_;
};

}  // namespace beam
