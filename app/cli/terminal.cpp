// SPDX-License-Identifier: Apache-2.0
#include "app/cli/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>
#include <clocale>
#include <cstdlib>
#include <cstring>
#include <cwchar>

#include <algorithm>

namespace beam {
namespace {

constexpr int kLeast = 20, kUsual = 80;
constexpr std::string_view kCut = "...";

// wcwidth() knows letters beyond ASCII only in a locale that has them; the program's own stays "C".
class Utf8 {
 public:
  Utf8() : locale_(::newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr)) {
    if (locale_) before_ = ::uselocale(locale_);
  }
  ~Utf8() {
    if (!locale_) return;
    ::uselocale(before_);
    ::freelocale(locale_);
  }
  Utf8(const Utf8&) = delete;
  Utf8& operator=(const Utf8&) = delete;

  struct Letter {
    std::size_t bytes = 1, columns = 1;
  };
  static Letter next(std::string_view text) {
    std::mbstate_t state{};
    wchar_t letter = 0;
    const std::size_t bytes = std::mbrtowc(&letter, text.data(), text.size(), &state);
    if (bytes == 0 || bytes > text.size()) return {};  // no UTF-8: a byte shows as one column
    return {bytes, static_cast<std::size_t>(std::max(0, ::wcwidth(letter)))};
  }

 private:
  locale_t locale_, before_ = nullptr;
};

}  // namespace

bool isDrawable(int descriptor) {
  const char* kind = std::getenv("TERM");
  return ::isatty(descriptor) != 0 && kind && *kind && std::strcmp(kind, "dumb") != 0;
}

int columnsOf(int descriptor) {
  winsize size{};
  if (::ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kUsual;
  return std::max<int>(size.ws_col, kLeast);
}

std::size_t columnsOf(std::string_view text) {
  const Utf8 utf8;
  std::size_t columns = 0;
  while (!text.empty()) {
    const Utf8::Letter letter = Utf8::next(text);
    columns += letter.columns;
    text.remove_prefix(letter.bytes);
  }
  return columns;
}

std::string cutToColumns(std::string_view text, std::size_t columns) {
  if (columnsOf(text) <= columns) return std::string(text);
  if (columns <= kCut.size()) return std::string(kCut.substr(0, columns));
  const Utf8 utf8;
  std::size_t kept = 0, used = 0;
  for (;;) {
    const Utf8::Letter letter = Utf8::next(text.substr(kept));
    if (used + letter.columns > columns - kCut.size()) break;
    used += letter.columns;
    kept += letter.bytes;
  }
  return std::string(text.substr(0, kept)).append(kCut);
}

namespace {

void addFolded(std::string_view line, std::size_t columns, std::string& out) {
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  const std::string hang(std::min(indent + 2, columns / 2), ' ');
  std::size_t used = indent;
  out.append(line.substr(0, indent));
  line.remove_prefix(indent);
  for (bool first = true; !line.empty(); first = false) {
    const std::size_t end = std::min(line.find(' '), line.size());
    const std::string_view word = line.substr(0, end);
    const std::size_t width = columnsOf(word);
    if (!first && used + 1 + width > columns) {
      out.append("\n").append(hang);
      used = hang.size();
    } else if (!first) {
      out += ' ';
      ++used;
    }
    out += word;
    used += width;
    line.remove_prefix(std::min(end + 1, line.size()));
  }
}

}  // namespace

std::string foldedToColumns(std::string_view text, std::size_t columns) {
  std::string out;
  while (true) {
    const std::size_t end = text.find('\n');
    addFolded(text.substr(0, end), columns, out);
    if (end == std::string_view::npos) return out;
    out += '\n';
    text.remove_prefix(end + 1);
  }
}

}  // namespace beam
