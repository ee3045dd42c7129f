// SPDX-License-Identifier: Apache-2.0
#include "app/cli/help_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "app/cli/terminal.h"

namespace beam {
namespace {

constexpr std::size_t kIndent = 2;

// Lines of at most `columns`, broken at blanks; a word that is longer stays whole.
std::vector<std::string> linesOf(std::string_view text, std::size_t columns) {
  std::vector<std::string> lines(1);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    if (!lines.back().empty() && columnsOf(lines.back()) + 1 + columnsOf(word) > columns)
      lines.emplace_back();
    else if (!lines.back().empty())
      lines.back() += ' ';
    lines.back() += word;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// Likewise, broken before flags.
std::vector<std::string> linesOfCommand(std::string_view typed, std::size_t columns) {
  std::vector<std::string> lines(1);
  while (!typed.empty()) {
    const std::size_t flag = typed.find(" --", 1);
    const std::string_view part = typed.substr(0, flag);
    if (columnsOf(lines.back()) + columnsOf(part) > columns) {
      lines.emplace_back(part.substr(1));
    } else {
      lines.back() += part;
    }
    typed.remove_prefix(std::min(flag, typed.size()));
  }
  return lines;
}

}  // namespace

void HelpPage::line(std::size_t indent, std::string_view text) {
  if (!text_.empty()) text_ += '\n';
  if (text.empty()) return;
  text_ += std::string(indent, ' ');
  text_ += text;
}

void HelpPage::blank() {
  if (!text_.empty()) line(0, "");
}

void HelpPage::heading(std::string_view title) {
  blank();
  line(0, fmt::format("{}:", title));
}

void HelpPage::paragraph(std::string_view text, std::size_t indent) {
  for (const std::string& l : linesOf(text, kHelpColumns - indent)) line(indent, l);
}

void HelpPage::example(std::string_view typed, std::string_view what) {
  const std::vector<std::string> lines =
      linesOfCommand(typed, kHelpColumns - 2 * kIndent - 2);  // " \\" at the end
  for (std::size_t i = 0; i < lines.size(); ++i)
    line(i == 0 ? kIndent : 2 * kIndent, lines[i] + (i + 1 < lines.size() ? " \\" : ""));
  paragraph(what, 3 * kIndent);
}

void HelpPage::append(const HelpPage& rows) { text_ += '\n' + rows.text_; }

void HelpPage::row(std::string_view left, std::string_view right) {
  const std::size_t column = kIndent + left_columns_ + 2, width = columnsOf(left);
  std::vector<std::string> lines = linesOf(right, kHelpColumns - column);
  if (width > left_columns_) {
    for (const std::string& l : linesOf(left, kHelpColumns - kIndent)) line(kIndent, l);
  } else {
    line(kIndent, fmt::format("{}{}{}", left, std::string(right.empty() ? 0 : left_columns_ - width + 2, ' '),
                              lines.front()));
    lines.erase(lines.begin());
  }
  for (const std::string& l : lines) line(column, l);
}

}  // namespace beam
