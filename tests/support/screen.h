// SPDX-License-Identifier: Apache-2.0
// A terminal's screen, as far as beam draws on one: letters, carriage return, line feed, erase to the end of
// the line, colours. Lines that have left the screen at the top stay readable.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace beam::testing {

class Screen {
 public:
  explicit Screen(std::size_t columns) : columns_(columns) {}

  // Narrower it takes effect with the line after the next: one may have been made for the old width already.
  void resize(std::size_t columns) {
    next_columns_ = columns < columns_ ? columns : 0;
    if (next_columns_ == 0) columns_ = columns;
    old_lines_ = 1;
  }

  void take(const std::string& bytes) {
    for (const char c : bytes) take(c);
  }

  std::size_t wraps() const { return wraps_; }  // lines that the terminal had to break
  const std::vector<std::string>& lines() const { return lines_; }
  bool holds(const std::string& text) const {
    for (const std::string& line : lines_)
      if (line.find(text) != std::string::npos) return true;
    return false;
  }

 private:
  void take(char c) {
    if (!escape_.empty() || c == '\033') return escaped(c);
    if (c == '\r') {
      beginLine();
    } else if (c == '\n') {
      lines_.emplace_back();
      beginLine();
    } else if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) {  // no further byte of a letter
      if (at_ == columns_) {
        ++wraps_;
        lines_.emplace_back();
        at_ = 0;
      }
      std::string& line = lines_.back();
      if (line.size() <= at_) line.resize(at_ + 1, ' ');
      line[at_++] = c;
    }
  }
  void beginLine() {
    at_ = 0;
    if (next_columns_ == 0 || old_lines_-- > 0) return;
    columns_ = next_columns_;
    next_columns_ = 0;
  }
  // "ESC [ ... letter"
  void escaped(char c) {
    escape_ += c;
    if (escape_.size() < 3 || c < '@' || c > '~') return;
    if (c == 'K') lines_.back().resize(std::min(lines_.back().size(), at_));
    escape_.clear();
  }

  std::size_t columns_, next_columns_ = 0, at_ = 0, wraps_ = 0;
  int old_lines_ = 0;
  std::vector<std::string> lines_ = {""};
  std::string escape_;
};

}  // namespace beam::testing
