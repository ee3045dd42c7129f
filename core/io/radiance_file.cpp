// SPDX-License-Identifier: Apache-2.0
#include "core/io/radiance_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <sstream>

#include "core/base/error.h"
#include "core/io/file.h"

namespace beam {
namespace {

constexpr int kMaxSide = 16384;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 27;

using Rgbe = std::array<std::uint8_t, 4>;

class HdrReader {
 public:
  explicit HdrReader(const std::filesystem::path& path)
      : path_(path), bytes_(readTextFile(path, 1ull << 30)) {}

  Image<vec3> read() {
    header();
    const std::size_t left = bytes_.size() - at_;
    if (static_cast<std::size_t>(rows_) * 4 > left)
      bad(fmt::format("{} rows cannot lie in {} bytes; the file is truncated", rows_, left));
    // Runs may shrink a scanline to a few bytes, so no size is promised by the length of the file: memory
    // grows with the scanlines that are really there.
    std::vector<Rgbe> pixels, line(columns_);
    for (int row = 0; row < rows_; ++row) {
      scanline(line);
      pixels.insert(pixels.end(), line.begin(), line.end());
    }
    Image<vec3> out(columns_first_ ? rows_ : columns_, columns_first_ ? columns_ : rows_, vec3(0),
                    Encoding::Linear);
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        place(out, row, column, pixels[static_cast<std::size_t>(row) * columns_ + column]);
      }
    }
    return out;
  }

 private:
  [[noreturn]] void bad(const std::string& what) const {
    throw Error(Error::Kind::Data, fmt::format("\"{}\": {}", path_.string(), what));
  }

  std::string textLine() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string::npos || end - at_ > 4096) bad("expected a Radiance header, found none");
    std::string line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
  }

  void header() {
    if (bytes_.empty()) bad("the file is empty");
    const std::string magic = textLine();
    if (magic.rfind("#?", 0) != 0) bad("expected \"#?RADIANCE\" at the start");
    for (std::string line = textLine(); !line.empty(); line = textLine()) {
      if (line.rfind("FORMAT=", 0) == 0 && line != "FORMAT=32-bit_rle_rgbe") {
        bad(fmt::format("expected FORMAT=32-bit_rle_rgbe, found {}", line));
      }
      if (line.rfind("EXPOSURE=", 0) == 0) {
        const double e = std::atof(line.c_str() + 9);
        if (!(e > 0 && std::isfinite(e))) bad(fmt::format("expected a positive EXPOSURE, found {}", line));
        exposure_ *= e;
      }
    }
    resolution(textLine());
  }

  // "-Y H +X W" and its seven relatives: the first axis runs over scanlines.
  void resolution(const std::string& line) {
    std::istringstream in(line);
    std::string first, second;
    long n1 = 0, n2 = 0;
    in >> first >> n1 >> second >> n2;
    const auto axis = [](const std::string& s) {
      return s.size() == 2 && (s[0] == '+' || s[0] == '-') ? s[1] : ' ';
    };
    const bool known =
        (axis(first) == 'Y' && axis(second) == 'X') || (axis(first) == 'X' && axis(second) == 'Y');
    if (!in || !known)
      bad(fmt::format("expected a resolution such as \"-Y 256 +X 512\", found \"{}\"", line));
    if (n1 < 1 || n2 < 1 || n1 > kMaxSide || n2 > kMaxSide) {
      bad(fmt::format("expected 1 to {} pixels a side, found {} and {}", kMaxSide, n1, n2));
    }
    if (std::int64_t{n1} * n2 > kMaxPixels) {
      bad(fmt::format("expected at most {} pixels, the header says {} x {}", kMaxPixels, n1, n2));
    }
    rows_ = static_cast<int>(n1);
    columns_ = static_cast<int>(n2);
    columns_first_ = axis(first) == 'X';
    // Pictures are stored top to bottom as -Y and left to right as +X.
    flip_rows_ = columns_first_ ? first[0] == '-' : first[0] == '+';
    flip_columns_ = columns_first_ ? second[0] == '+' : second[0] == '-';
  }

  std::uint8_t byte() {
    if (at_ >= bytes_.size()) bad("the file ends before its last scanline; it is truncated");
    return static_cast<std::uint8_t>(bytes_[at_++]);
  }

  void scanline(std::vector<Rgbe>& line) {
    Rgbe p = {byte(), byte(), byte(), byte()};
    const bool new_runs = columns_ >= 8 && columns_ < 32768 && p[0] == 2 && p[1] == 2 && p[2] < 128;
    if (!new_runs) return oldScanline(line, p);
    if ((p[2] << 8 | p[3]) != columns_) bad("a scanline has another length than the header says");
    for (int c = 0; c < 4; ++c) {
      for (int x = 0; x < columns_;) {
        int count = byte();
        const bool run = count > 128;
        if (run) count -= 128;
        if (count == 0 || x + count > columns_) bad("a run reaches past its scanline");
        const std::uint8_t value = run ? byte() : 0;
        for (int i = 0; i < count; ++i) line[x++][c] = run ? value : byte();
      }
    }
  }

  void oldScanline(std::vector<Rgbe>& line, Rgbe p) {
    int shift = 0;
    for (int x = 0; x < columns_;) {
      if (p[0] == 1 && p[1] == 1 && p[2] == 1 && x > 0) {
        const int count = shift < 24 ? p[3] << shift : kMaxSide + 1;
        if (x + count > columns_) bad("a run reaches past its scanline");
        for (int i = 0; i < count; ++i, ++x) line[x] = line[x - 1];
        shift += 8;
      } else {
        line[x++] = p;
        shift = 0;
      }
      if (x < columns_) p = {byte(), byte(), byte(), byte()};
    }
  }

  void place(Image<vec3>& out, int row, int column, const Rgbe& p) const {
    const int r = flip_rows_ ? rows_ - 1 - row : row, c = flip_columns_ ? columns_ - 1 - column : column;
    const float unit = p[3] == 0 ? 0.0f : static_cast<float>(std::ldexp(1.0 / exposure_, p[3] - 136));
    const vec3 value = unit * vec3(p[0], p[1], p[2]);
    if (columns_first_) {
      out(r, c) = value;
    } else {
      out(c, r) = value;
    }
  }

  std::filesystem::path path_;
  std::string bytes_;
  std::size_t at_ = 0;
  double exposure_ = 1;
  int rows_ = 0, columns_ = 0;
  bool columns_first_ = false, flip_rows_ = false, flip_columns_ = false;
};

}  // namespace

Image<vec3> readRadianceHdr(const std::filesystem::path& path) { return HdrReader(path).read(); }

}  // namespace beam
