// SPDX-License-Identifier: Apache-2.0
#include "core/io/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "core/base/error.h"

namespace beam {
namespace {

constexpr std::int64_t kMaxSide = 16384;
constexpr std::size_t kMaxRawBytes = std::size_t{1} << 30;  // keeps PIZ's 32-bit arithmetic in range
constexpr std::int64_t kMaxExpansion = 1100;                // deflate's own limit is about 1030 : 1
constexpr std::uint32_t kMaxAttributeBytes = 64 << 10;
constexpr std::int32_t kMaxEdge = 1 << 24;  // of a window; sums and differences of edges stay in 32 bits
constexpr int kMaxAttributes = 256;
constexpr std::size_t kMaxChannels = 64;
constexpr std::uint32_t kTiledFlag = 0x200, kDeepFlag = 0x800, kMultiPartFlag = 0x1000;

struct Compression {
  const char* name;
  int rows;  // scanlines a block; 0: not read
};
constexpr std::array<Compression, 10> kCompressions = {{{"NONE", 1},
                                                        {"RLE", 1},
                                                        {"ZIPS", 1},
                                                        {"ZIP", 16},
                                                        {"PIZ", 32},
                                                        {"PXR24", 0},
                                                        {"B44", 0},
                                                        {"B44A", 0},
                                                        {"DWAA", 0},
                                                        {"DWAB", 0}}};

struct Box {
  std::array<std::int32_t, 4> edge{};  // min x, min y, max x, max y
  std::int64_t width() const { return std::int64_t{edge[2]} - edge[0] + 1; }
  std::int64_t height() const { return std::int64_t{edge[3]} - edge[1] + 1; }
};

class ExrGate {
 public:
  ExrGate(std::span<const std::byte> bytes, const std::filesystem::path& path) : bytes_(bytes), path_(path) {}

  void check() {
    magic();
    for (int n = 0; at_ < bytes_.size() && bytes_[at_] != std::byte{0}; ++n) {
      if (n == kMaxAttributes) bad(fmt::format("the header holds more than {} attributes", kMaxAttributes));
      attribute();
    }
    get<std::uint8_t>();  // the header's closing 0
    if (compression_ < 0 || raw_bytes_per_pixel_ == 0 || !has_data_window_ || !has_display_window_) {
      bad("expected the attributes channels, compression, dataWindow and displayWindow, not all are there");
    }
    sizes();
  }

  const FileNotes& notes() const { return notes_; }

 private:
  [[noreturn]] void bad(const std::string& what) const {
    throw Error(Error::Kind::Data, fmt::format("\"{}\": {}", path_.string(), what));
  }

  template <class T>
  T get() {
    if (bytes_.size() - at_ < sizeof(T)) bad("the OpenEXR header ends early; the file is truncated");
    T v;
    std::memcpy(&v, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return v;
  }

  const char* chars() const { return reinterpret_cast<const char*>(bytes_.data()) + at_; }

  std::string text() {
    std::string s;
    while (const char c = get<char>()) {
      if (s.size() == 255) bad("a name in the OpenEXR header is longer than 255 bytes");
      s += c;
    }
    return s;
  }

  void magic() {
    if (bytes_.empty()) bad("the file is empty; expected an OpenEXR picture");
    if (bytes_.size() < 8 || get<std::uint32_t>() != 0x01312f76) bad("expected an OpenEXR picture");
    const auto version = get<std::uint32_t>();
    if ((version & 0xff) != 2) bad(fmt::format("expected OpenEXR version 2, found {}", version & 0xff));
    if (version & kDeepFlag) bad("deep OpenEXR pictures are not read; flatten the picture");
    if (version & kMultiPartFlag) bad("OpenEXR pictures of several parts are not read; save one part");
    tiled_ = (version & kTiledFlag) != 0;
  }

  void attribute() {
    const std::string name = text(), type = text();
    const auto size = get<std::uint32_t>();
    const std::size_t left = bytes_.size() - at_;
    if (size > kMaxAttributeBytes || size > left) {
      bad(fmt::format("the attribute \"{}\" announces {} bytes, expected at most {} and {} are left", name,
                      size, kMaxAttributeBytes, left));
    }
    const std::size_t end = at_ + size;
    if (name == "channels" && type == "chlist") channels(end);
    if (name == "compression" && type == "compression" && size >= 1) compression_ = get<std::uint8_t>();
    if (name == "dataWindow" && type == "box2i" && size == 16) {
      data_window_ = box();
      has_data_window_ = true;
    }
    if (name == "displayWindow" && type == "box2i" && size == 16) {
      display_window_ = box();
      has_display_window_ = true;
    }
    if (type == "string") notes_.emplace_back(name, std::string(chars(), size));
    if (name == "tiles" && type == "tiledesc" && size == 9) {
      tile_width_ = get<std::uint32_t>();
      tile_height_ = get<std::uint32_t>();
      if ((get<std::uint8_t>() & 0xf) != 0) bad("mip-mapped OpenEXR pictures are not read; save one level");
    }
    if (at_ > end) bad(fmt::format("the attribute \"{}\" is longer than it announces", name));
    at_ = end;
  }

  void channels(std::size_t end) {
    for (std::size_t n = 0; at_ < end && bytes_[at_] != std::byte{0}; ++n) {
      if (n == kMaxChannels) bad(fmt::format("expected at most {} channels", kMaxChannels));
      const std::string name = text();
      const auto type = get<std::int32_t>();
      get<std::uint32_t>();  // pLinear and three reserved bytes
      const auto x_sampling = get<std::int32_t>(), y_sampling = get<std::int32_t>();
      if (type < 0 || type > 2) bad(fmt::format("channel {} has the unknown pixel type {}", name, type));
      if (x_sampling < 1 || y_sampling < 1) bad(fmt::format("channel {} has a sampling below 1", name));
      raw_bytes_per_pixel_ += type == 1 ? 2 : 4;
    }
  }

  Box box() {
    Box b;
    for (std::int32_t& e : b.edge) {
      e = get<std::int32_t>();
      if (e < -kMaxEdge || e > kMaxEdge) bad(fmt::format("a window of the header reaches to {}", e));
    }
    return b;
  }

  void sizes() {
    if (compression_ >= static_cast<int>(kCompressions.size()) || kCompressions[compression_].rows == 0) {
      const bool known = compression_ < static_cast<int>(kCompressions.size());
      bad(fmt::format("the compression {} is not read; save the picture with ZIP or PIZ",
                      known ? kCompressions[compression_].name : std::to_string(compression_)));
    }
    for (const Box& b : {data_window_, display_window_}) {
      if (b.width() < 1 || b.height() < 1 || b.width() > kMaxSide || b.height() > kMaxSide) {
        bad(fmt::format("expected 1 to {} pixels a side, the header says {} x {}", kMaxSide, b.width(),
                        b.height()));
      }
    }
    const std::int64_t w = data_window_.width(), h = data_window_.height();
    const auto left = static_cast<std::int64_t>(bytes_.size() - at_);
    const std::int64_t raw = w * h * raw_bytes_per_pixel_;
    if (raw >= std::int64_t{kMaxRawBytes}) {
      bad(fmt::format("{} x {} pixels of {} bytes are more than {} bytes; save a smaller picture", w, h,
                      raw_bytes_per_pixel_, kMaxRawBytes));
    }
    const std::int64_t rows = kCompressions[compression_].rows;
    blocks_ = (h + rows - 1) / rows;
    if (tiled_) {
      if (tile_width_ < 1 || tile_height_ < 1 || tile_width_ > kMaxSide || tile_height_ > kMaxSide ||
          tile_width_ * tile_height_ * raw_bytes_per_pixel_ >= std::int64_t{kMaxRawBytes}) {
        bad(fmt::format("the header gives tiles of {} x {} pixels", tile_width_, tile_height_));
      }
      blocks_ = ((w + tile_width_ - 1) / tile_width_) * ((h + tile_height_ - 1) / tile_height_);
    }
    // Every block has an entry of 8 bytes in the offset table and 8 bytes of its own head.
    if (blocks_ * 16 > left || raw > left * kMaxExpansion) {
      bad(
          fmt::format("the header says {} x {} pixels of {} bytes, which {} bytes cannot hold; the file is "
                      "truncated or damaged",
                      w, h, raw_bytes_per_pixel_, left));
    }
  }

  std::span<const std::byte> bytes_;
  const std::filesystem::path& path_;
  std::size_t at_ = 0;
  bool tiled_ = false, has_data_window_ = false, has_display_window_ = false;
  int compression_ = -1;
  std::int64_t raw_bytes_per_pixel_ = 0;
  Box data_window_, display_window_;
  std::int64_t tile_width_ = 0, tile_height_ = 0, blocks_ = 0;
  FileNotes notes_;
};

}  // namespace

void checkExrHeader(std::span<const std::byte> bytes, const std::filesystem::path& path) {
  ExrGate(bytes, path).check();
}

FileNotes exrNotes(std::span<const std::byte> bytes, const std::filesystem::path& path) {
  ExrGate gate(bytes, path);
  gate.check();
  return gate.notes();
}

void requireExrSize(int width, int height, std::size_t channels, std::size_t pixel_bytes,
                    const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& what) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\" is not written: {}", path.string(), what));
  };
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
    refuse(fmt::format("expected 1 to {} pixels a side, found {} x {}", kMaxSide, width, height));
  if (channels < 1 || channels > kMaxChannels)
    refuse(fmt::format("expected 1 to {} channels in an OpenEXR file, found {}", kMaxChannels, channels));
  if (pixel_bytes > kMaxRawBytes || static_cast<std::size_t>(width) * height * pixel_bytes >= kMaxRawBytes) {
    refuse(fmt::format(
        "{} x {} pixels of {} bytes are more than the {} bytes that an OpenEXR file is read with; "
        "choose fewer channels a file or smaller pictures",
        width, height, pixel_bytes, kMaxRawBytes));
  }
}

}  // namespace beam
