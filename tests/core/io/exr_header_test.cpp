// SPDX-License-Identifier: Apache-2.0
// The gate before the OpenEXR library: what it lets pass, and that everything else is refused by name.
#include "core/io/exr_header.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <climits>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/rng.h"

namespace beam {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

template <class T>
std::string raw(T value) {
  std::string s(sizeof(T), '\0');
  std::memcpy(s.data(), &value, sizeof(T));
  return s;
}

std::string word(const std::string& text) { return text + '\0'; }

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return word(name) + word(type) + raw(static_cast<std::uint32_t>(value.size())) + value;
}

std::string box(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
  return raw(x0) + raw(y0) + raw(x1) + raw(y1);
}

std::string channel(const std::string& name, std::int32_t type = 1, std::int32_t sampling = 1) {
  return word(name) + raw(type) + raw(std::uint32_t{0}) + raw(sampling) + raw(sampling);
}

// A header in parts; a test spoils one. The default is right: 64 x 32 pixels of three halves.
struct Header {
  std::uint32_t magic = 0x01312f76, version = 2;
  std::string channels = channel("B") + channel("G") + channel("R") + '\0';
  char compression = 3;  // ZIP
  std::string data_window = box(0, 0, 63, 31), display_window = box(0, 0, 63, 31);
  std::string more = {};  // attributes
  std::size_t pixel_bytes = 4096;

  std::string bytes() const {
    return raw(magic) + raw(version) + attribute("channels", "chlist", channels) +
           attribute("compression", "compression", {compression}) +
           attribute("dataWindow", "box2i", data_window) +
           attribute("displayWindow", "box2i", display_window) + more + '\0' + std::string(pixel_bytes, 'p');
  }
};

// What the gate says; nothing: it lets pass.
std::optional<std::string> refusalOf(const std::string& bytes) {
  try {
    checkExrHeader(std::as_bytes(std::span(bytes)), "some/where.exr");
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Data);
    EXPECT_THAT(e.what(), HasSubstr("some/where.exr"));
    return e.what();
  }
  return std::nullopt;
}

void expectRefused(const Header& header, const std::string& reason) {
  const auto refusal = refusalOf(header.bytes());
  ASSERT_TRUE(refusal) << "expected a refusal: " << reason;
  EXPECT_THAT(*refusal, HasSubstr(reason));
}

TEST(ExrHeader, LetsTheAllowedCompressionsPassAndNamesTheOthers) {
  const char* const names[] = {"NONE", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"};
  for (char c = 0; c < 10; ++c) {
    Header h;
    h.compression = c;
    if (c <= 4) {
      EXPECT_EQ(refusalOf(h.bytes()), std::nullopt) << names[static_cast<int>(c)];
    } else {
      expectRefused(h, std::string(names[static_cast<int>(c)]) + " is not read");
    }
  }
  Header unknown;
  for (const int c : {10, 77, 255}) {
    unknown.compression = static_cast<char>(c);
    expectRefused(unknown, std::to_string(c));
  }
}

TEST(ExrHeader, RefusesWhatIsNoPictureOfOnePart) {
  EXPECT_THAT(refusalOf("").value_or(""), HasSubstr("empty"));
  EXPECT_THAT(refusalOf("v/1").value_or(""), HasSubstr("expected an OpenEXR picture"));
  Header h;
  h.magic = 0x01312f77;
  expectRefused(h, "expected an OpenEXR picture");
  h = {};
  h.version = 1;
  expectRefused(h, "version 2, found 1");
  h.version = 2 | 0x800;
  expectRefused(h, "deep");
  h.version = 2 | 0x1000;
  expectRefused(h, "several parts");
}

TEST(ExrHeader, EveryAttributeThatIsNeededIsMissed) {
  const Header h;
  for (const char* name : {"channels", "compression", "dataWindow", "displayWindow"}) {
    std::string bytes = h.bytes();
    bytes[bytes.find(word(name))] = 'x';
    EXPECT_THAT(refusalOf(bytes).value_or(""), HasSubstr("not all are there")) << name;
  }
}

TEST(ExrHeader, RefusesWindowsThatNoPictureHas) {
  const std::pair<std::string, const char*> windows[] = {
      {box(0, 0, -1, 31), "0 x 32"},         {box(10, 0, 9, 31), "0 x 32"},
      {box(0, 0, 63, -2), "64 x -1"},        {box(0, 0, 16384, 0), "16385 x 1"},
      {box(0, -16384, 0, 0), "1 x 16385"},   {box(INT_MIN, INT_MIN, INT_MAX, INT_MAX), "-2147483648"},
      {box(0, 0, INT_MAX, 0), "2147483647"}, {box(-(1 << 24) - 1, 0, -(1 << 24), 0), "-16777217"},
  };
  for (const auto& [window, reason] : windows) {
    Header data, display;
    data.data_window = window;
    display.display_window = window;
    expectRefused(data, reason);
    expectRefused(display, reason);
  }
}

TEST(ExrHeader, HoldsPixelsAgainstTheBytesThatAreThere) {
  Header h;
  h.data_window = h.display_window = box(0, 0, 16383, 8191);
  expectRefused(h, "cannot hold");
  h.compression = 0;
  h.data_window = h.display_window = box(0, 0, 0, 16383);
  expectRefused(h, "cannot hold");  // 16,384 blocks of at least 16 bytes
  h.pixel_bytes = 16 * 16384;
  EXPECT_EQ(refusalOf(h.bytes()), std::nullopt);
  // However many bytes there are: 2^28 pixels of three halves.
  h.data_window = h.display_window = box(0, 0, 16383, 16383);
  h.pixel_bytes = 4u << 20;
  expectRefused(h, "more than 1073741824 bytes");
}

TEST(ExrHeader, HoldsTilesToTheSameLimits) {
  const auto tiles = [](std::uint32_t w, std::uint32_t h, std::uint8_t mode) {
    Header header;
    header.version = 2 | 0x200;
    header.more = attribute("tiles", "tiledesc", raw(w) + raw(h) + raw(mode));
    return header;
  };
  EXPECT_EQ(refusalOf(tiles(32, 32, 0).bytes()), std::nullopt);
  expectRefused(tiles(32, 32, 1), "mip-mapped");
  expectRefused(tiles(32, 32, 2), "mip-mapped");
  expectRefused(tiles(0, 32, 0), "tiles of 0 x 32");
  expectRefused(tiles(32, 0, 0), "tiles of 32 x 0");
  expectRefused(tiles(UINT_MAX, UINT_MAX, 0), "tiles of 4294967295");
  expectRefused(tiles(16384, 16384, 0), "tiles of 16384 x 16384");
  Header without;
  without.version = 2 | 0x200;
  expectRefused(without, "tiles of 0 x 0");
  Header small = tiles(1, 1, 0);  // 2,048 blocks
  expectRefused(small, "cannot hold");
}

TEST(ExrHeader, BoundsAttributesInNumberLengthAndName) {
  Header h;
  for (int i = 0; i < 252; ++i) h.more += attribute(fmt::format("a{}", i), "int", raw(i));
  EXPECT_EQ(refusalOf(h.bytes()), std::nullopt) << "256 of them";
  h.more += attribute("one too many", "int", raw(0));
  expectRefused(h, "more than 256 attributes");
  h.more = attribute("note", "string", std::string(64 << 10, 'n'));
  EXPECT_EQ(refusalOf(h.bytes()), std::nullopt);
  h.more = attribute("note", "string", std::string((64 << 10) + 1, 'n'));
  expectRefused(h, "\"note\" announces 65537 bytes");
  h.more = word("note") + word("string") + raw(std::uint32_t{60000});
  expectRefused(h, "\"note\" announces 60000 bytes");
  h.more = word("note") + word("string") + raw(~std::uint32_t{0});
  expectRefused(h, "\"note\" announces 4294967295 bytes");
  h.more = attribute(std::string(255, 'n'), "int", raw(0));
  EXPECT_EQ(refusalOf(h.bytes()), std::nullopt);
  h.more = attribute(std::string(256, 'n'), "int", raw(0));
  expectRefused(h, "longer than 255 bytes");
}

TEST(ExrHeader, BoundsChannels) {
  Header h;
  h.channels = channel("Y", 3) + '\0';
  expectRefused(h, "unknown pixel type 3");
  h.channels = channel("Y", -1) + '\0';
  expectRefused(h, "unknown pixel type -1");
  for (const int sampling : {0, -1, INT_MIN}) {
    h.channels = channel("Y", 1, sampling) + '\0';
    expectRefused(h, "sampling below 1");
  }
  h.channels.clear();
  for (int i = 0; i < 64; ++i) h.channels += channel(fmt::format("c{}", i));
  EXPECT_EQ(refusalOf(Header{.channels = h.channels + '\0'}.bytes()), std::nullopt);
  h.channels += channel("c64") + '\0';
  expectRefused(h, "at most 64 channels");
  h.channels = std::string(1, '\0');
  expectRefused(h, "not all are there");
  h.channels = channel("Y").substr(0, 10);  // the last one reaches over its attribute's end
  expectRefused(h, "");
}

TEST(ExrHeader, CutAnywhereItIsRefused) {
  const std::string whole = Header{.pixel_bytes = 0}.bytes();
  for (std::size_t size = 8; size < whole.size(); ++size) {
    EXPECT_THAT(refusalOf(whole.substr(0, size)).value_or(""),
                AnyOf(HasSubstr("ends early"), HasSubstr("announces")))
        << size;
  }
  for (std::size_t size = 0; size < 8; ++size) EXPECT_TRUE(refusalOf(whole.substr(0, size))) << size;
}

TEST(ExrHeader, DamagedAnywhereItIsReadOrRefusedButNothingElseHappens) {
  const std::string whole = Header{.more = attribute("tiles", "tiledesc", raw(32) + raw(32) + '\0')}.bytes();
  const std::size_t header = whole.size() - 4096;
  const RandomStream random(3);
  int refused = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    std::string bytes = whole;
    for (std::uint64_t k = 0; k < 1 + i % 4; ++k)
      bytes[random.below(10 * i + 2 * k, header)] = static_cast<char>(random.below(10 * i + 2 * k + 1, 256));
    refused += refusalOf(bytes).has_value();
  }
  EXPECT_GT(refused, 10000);
  EXPECT_LT(refused, 20000);
}

}  // namespace
}  // namespace beam
