// SPDX-License-Identifier: Apache-2.0
// Foreign bytes: pictures and panoramas of the less common kinds are read right, damaged and hostile ones are
// refused by name before memory is taken.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/io/image_file.h"
#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"

namespace beam {
namespace {

using testing::dataErrorOf;
using ::testing::HasSubstr;
using testing::TempDir;

void put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string encoded(const char* extension, const cv::Mat& m) {
  std::vector<unsigned char> bytes;
  EXPECT_TRUE(cv::imencode(extension, m, bytes));
  return {bytes.begin(), bytes.end()};
}

cv::Mat ramp(int type) {
  cv::Mat m(24, 40, type);
  for (int y = 0; y < m.rows; ++y) {
    unsigned char* row = m.ptr(y);
    for (std::size_t i = 0; i < m.cols * m.elemSize(); ++i)
      row[i] = static_cast<unsigned char>(5 * y + 3 * i);
  }
  return m;
}

template <class T>
std::string raw(T value) {
  std::string s(sizeof(T), '\0');
  std::memcpy(s.data(), &value, sizeof(T));
  return s;
}

TEST(PngFile, SixteenBitsGrayAndAlphaBecomeEightBitsColorAndCoverage) {
  const TempDir dir;
  put(dir / "deep.png", encoded(".png", cv::Mat(4, 6, CV_16UC3, cv::Scalar(257 * 30, 257 * 20, 257 * 10))));
  EXPECT_EQ(readPhoto(dir / "deep.png")(5, 3), u8vec3(10, 20, 30));
  put(dir / "gray.png", encoded(".png", cv::Mat(4, 6, CV_8UC1, cv::Scalar(77))));
  EXPECT_EQ(readPhoto(dir / "gray.png")(0, 0), u8vec3(77));
  EXPECT_FALSE(readImageSize(dir / "gray.png").has_alpha);
  put(dir / "alpha.png", encoded(".png", cv::Mat(4, 6, CV_8UC4, cv::Scalar(3, 2, 1, 99))));
  EXPECT_TRUE(readImageSize(dir / "alpha.png").has_alpha);
  EXPECT_EQ(readPhoto(dir / "alpha.png")(0, 0), u8vec3(1, 2, 3));
  EXPECT_EQ(readAlpha(dir / "alpha.png")(5, 0), 99);
  EXPECT_THAT(dataErrorOf([&] { readAlpha(dir / "gray.png"); }), HasSubstr("alpha"));
}

TEST(PngFile, ItsLastChunkMustBeWhole) {
  const TempDir dir;
  const std::string whole = encoded(".png", ramp(CV_8UC3));
  put(dir / "whole.png", whole + "trailing bytes");
  EXPECT_EQ(checkImageFile(dir / "whole.png").width, 40);
  for (const std::size_t missing : {1, 4, 12, 40}) {
    put(dir / "cut.png", whole.substr(0, whole.size() - missing));
    EXPECT_THAT(dataErrorOf([&] { checkImageFile(dir / "cut.png"); }), HasSubstr("truncated")) << missing;
  }
}

TEST(PngFile, PixelsThatTheBytesCannotHoldAreRefused) {
  const TempDir dir;
  std::string bytes = encoded(".png", ramp(CV_8UC3));
  bytes.replace(16, 8, std::string("\x00\x00\x3f\xff\x00\x00\x1f\xff", 8));
  put(dir / "bomb.png", bytes);
  EXPECT_THAT(dataErrorOf([&] { readPhoto(dir / "bomb.png"); }), HasSubstr("cannot hold"));
}

TEST(JpegFile, IsReadAndATruncatedOneIsAnErrorEvenWhenItsThumbnailIsWhole) {
  const TempDir dir;
  const std::string whole = encoded(".jpg", ramp(CV_8UC3));
  put(dir / "a.jpg", whole);
  EXPECT_EQ(readPhoto(dir / "a.jpg").width, 40);
  EXPECT_EQ(readImageSize(dir / "a.jpg").height, 24);
  // An application segment that holds a whole little JPEG, end marker included, before the real picture.
  const std::size_t length = whole.size() + 2;
  ASSERT_LT(length, 65536u);
  const std::string segment =
      std::string("\xff\xe1", 2) + static_cast<char>(length >> 8) + static_cast<char>(length & 0xff) + whole;
  const std::string with_thumbnail = whole.substr(0, 2) + segment + whole.substr(2);
  put(dir / "b.jpg", with_thumbnail);
  EXPECT_EQ(readPhoto(dir / "b.jpg").pixels, readPhoto(dir / "a.jpg").pixels);
  for (const std::size_t missing : {std::size_t{2}, whole.size() / 2}) {
    put(dir / "cut.jpg", with_thumbnail.substr(0, with_thumbnail.size() - missing));
    EXPECT_THAT(dataErrorOf([&] { readPhoto(dir / "cut.jpg"); }), HasSubstr("truncated"));
  }
}

TEST(Files, APipeInThePlaceOfAFileIsRefusedAndNotWaitedFor) {
  const TempDir dir;
  ASSERT_EQ(mkfifo((dir / "p.png").c_str(), 0600), 0);
  EXPECT_THAT(dataErrorOf([&] { readPhoto(dir / "p.png"); }), HasSubstr("regular file"));
}

Planes ramp(int width, int height, int channels) {
  Planes p(width, height, channels);
  for (std::size_t i = 0; i < p.values.size(); ++i) p.values[i] = 0.25f * static_cast<float>(i);
  return p;
}

std::string exrBytes(const TempDir& dir, const Planes& p, const std::vector<std::string>& channels) {
  writeExr(dir / "made.exr", p, channels, ExrPrecision::Float);
  return readTextFile(dir / "made.exr");
}

TEST(ExrFile, AConstantPictureIsNotTakenForABomb) {
  const TempDir dir;
  for (const ExrPrecision precision : {ExrPrecision::Half, ExrPrecision::Float}) {
    writeExr(dir / "z.exr", Planes(3000, 2000, 3), {"R", "G", "B"}, precision);
    EXPECT_EQ(readExr(dir / "z.exr", {"G"}).width, 3000);
  }
}

TEST(ExrFile, TheOnlyLayerServesWhenPlainNamesAreMissing) {
  const TempDir dir;
  const Planes p = ramp(5, 3, 4);
  writeExr(dir / "l.exr", p, {"env.R", "env.G", "env.B", "id.Y"}, ExrPrecision::Float);
  const Image<vec3> im = readRadiance(dir / "l.exr");
  EXPECT_EQ(im(2, 1), vec3(p.plane(0)[7], p.plane(1)[7], p.plane(2)[7]));
  writeExr(dir / "two.exr", ramp(5, 3, 6), {"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"}, ExrPrecision::Float);
  EXPECT_THAT(dataErrorOf([&] { readRadiance(dir / "two.exr"); }), HasSubstr("more than one layer"));
}

TEST(ExrFile, LuminanceAloneIsGrayAndLuminanceChromaIsRefused) {
  const TempDir dir;
  writeExr(dir / "y.exr", ramp(5, 3, 1), {"Y"}, ExrPrecision::Float);
  EXPECT_EQ(readRadiance(dir / "y.exr")(1, 0), vec3(0.25f));
  writeExr(dir / "yc.exr", ramp(5, 3, 3), {"Y", "RY", "BY"}, ExrPrecision::Float);
  EXPECT_THAT(dataErrorOf([&] { readRadiance(dir / "yc.exr"); }), HasSubstr("luminance-chroma"));
}

TEST(ExrFile, ASmallerDataWindowIsPlacedInItsDisplayWindow) {
  const TempDir dir;
  std::string bytes = exrBytes(dir, ramp(5, 3, 1), {"Y"});
  const std::size_t at = bytes.find(std::string("displayWindow\0box2i\0", 20)) + 24;
  bytes.replace(at, 16,
                raw(std::int32_t{-2}) + raw(std::int32_t{-1}) + raw(std::int32_t{7}) + raw(std::int32_t{5}));
  put(dir / "w.exr", bytes);
  const Planes p = readExr(dir / "w.exr", {"Y"});
  EXPECT_EQ(ivec2(p.width, p.height), ivec2(10, 7));
  EXPECT_EQ(p.values[0], 0);
  EXPECT_EQ(p.values[1 * 10 + 3], 0.25f);  // data (1, 0) lies at display (3, 1)
}

TEST(ExrFile, HeadersThatPromiseWhatIsNotThereAreRefused) {
  const TempDir dir;
  const std::string whole = exrBytes(dir, ramp(5, 3, 1), {"Y"});
  const auto refused = [&](const std::string& bytes) {
    put(dir / "h.exr", bytes);
    return dataErrorOf([&] { readExr(dir / "h.exr", {"Y"}); });
  };
  std::string windows = whole;
  for (const char* window : {"dataWindow", "displayWindow"}) {
    const std::size_t at = windows.find(window) + std::strlen(window) + 1 + 6 + 4;
    windows.replace(at + 8, 8, raw(std::int32_t{16383}) + raw(std::int32_t{8191}));
  }
  EXPECT_THAT(refused(windows), HasSubstr("cannot hold"));
  std::string attribute =
      whole.substr(0, 8) + std::string("big\0string\0", 11) + raw(std::uint32_t{1900000000});
  EXPECT_THAT(refused(attribute), HasSubstr("1900000000"));
  std::string deep = whole, parts = whole, squeezed = whole;
  deep[5] = 8;
  EXPECT_THAT(refused(deep), HasSubstr("deep"));
  parts[5] = 16;
  EXPECT_THAT(refused(parts), HasSubstr("parts"));
  squeezed[squeezed.find(std::string("compression\0compression\0", 24)) + 28] = 8;
  EXPECT_THAT(refused(squeezed), HasSubstr("DWAA"));
  for (const std::size_t size : {5, 60, 200}) refused(whole.substr(0, size));
}

TEST(ExrFile, BlockOffsetsOutsideTheFileAreRefused) {
  const TempDir dir;
  const std::string whole = exrBytes(dir, ramp(5, 3, 1), {"Y"});
  std::size_t table = 0;  // one block: the table's only entry names the byte after itself
  for (std::size_t i = 200; i + 8 < whole.size() && !table; ++i) {
    if (whole.compare(i, 8, raw(std::uint64_t{i + 8})) == 0) table = i;
  }
  ASSERT_NE(table, 0u);
  for (const std::uint64_t offset : {~std::uint64_t{0}, ~std::uint64_t{0} - 7, std::uint64_t{1} << 40}) {
    std::string bytes = whole;
    put(dir / "o.exr", bytes.replace(table, 8, raw(offset)));
    dataErrorOf([&] { readExr(dir / "o.exr", {"Y"}); });
  }
}

TEST(HdrFile, AllEightOrientationsGiveTheSamePicture) {
  const TempDir dir;
  // Rows top to bottom: 1 2 3 / 4 5 6, as exponents' mantissas; the order in which each orientation stores
  // them.
  const struct {
    const char* resolution;
    const char* order;
  } kinds[] = {{"-Y 2 +X 3", "123456"}, {"-Y 2 -X 3", "321654"}, {"+Y 2 +X 3", "456123"},
               {"+Y 2 -X 3", "654321"}, {"+X 3 -Y 2", "142536"}, {"+X 3 +Y 2", "415263"},
               {"-X 3 -Y 2", "362514"}, {"-X 3 +Y 2", "635241"}};
  for (const auto& kind : kinds) {
    std::string bytes = "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n" + std::string(kind.resolution) + "\n";
    for (const char* c = kind.order; *c; ++c) {
      bytes += std::string(3, static_cast<char>(16 * (*c - '0'))) + static_cast<char>(136);
    }
    put(dir / "o.hdr", bytes);
    const Image<vec3> im = readRadiance(dir / "o.hdr");
    ASSERT_EQ(ivec2(im.width, im.height), ivec2(3, 2)) << kind.resolution;
    for (int i = 0; i < 6; ++i)
      EXPECT_EQ(im.pixels[i].x, 16.0f * static_cast<float>(i + 1)) << kind.resolution << i;
  }
}

TEST(HdrFile, LongRunsShiftByEightBitsAndHugeSizesNeedTheirBytes) {
  const TempDir dir;
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  // 300 pixels: one, then a run of 299 = 43 + (1 << 8).
  put(dir / "a.hdr",
      head + "-Y 1 +X 300\n" + std::string("\x10\x20\x30\x88\x01\x01\x01\x2b\x01\x01\x01\x01", 12));
  EXPECT_EQ(readRadiance(dir / "a.hdr")(299, 0), vec3(16, 32, 48));
  put(dir / "b.hdr", head + "-Y 16000 +X 8000\n");
  EXPECT_THAT(dataErrorOf([&] { readRadiance(dir / "b.hdr"); }), HasSubstr("truncated"));
  put(dir / "c.hdr", head + "-Y 16000 +X 16000\n" + std::string(70000, '\1'));
  EXPECT_THAT(dataErrorOf([&] { readRadiance(dir / "c.hdr"); }), HasSubstr("16000"));
  put(dir / "d.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234");
  EXPECT_THAT(dataErrorOf([&] { readRadiance(dir / "d.hdr"); }), HasSubstr("xyze"));
}

std::string plyHeader(const std::string& format, const std::string& rest) {
  return "ply\r\nformat " + format + " 1.0\r\ncomment made elsewhere\r\nobj_info x\r\n" + rest +
         "end_header\r\n";
}

TEST(MeshPly, EveryByteOrderAndTypeGivesTheSameMesh) {
  const TempDir dir;
  const std::string layout =
      "element vertex 3\r\nproperty double x\r\nproperty float y\r\nproperty short z\r\n"
      "element face 1\r\nproperty list uchar uint vertex_indices\r\n";
  std::string little = plyHeader("binary_little_endian", layout),
              big = plyHeader("binary_big_endian", layout);
  const auto both = [&](const std::string& bytes) {
    little += bytes;
    big.append(bytes.rbegin(), bytes.rend());
  };
  for (const ivec3& v : {ivec3(0, 0, 0), ivec3(1, 0, -2), ivec3(0, 3, 500)}) {
    both(raw(static_cast<double>(v.x)));
    both(raw(static_cast<float>(v.y)));
    both(raw(static_cast<std::int16_t>(v.z)));
  }
  both(raw(std::uint8_t{3}));
  for (const std::uint32_t i : {0u, 1u, 2u}) both(raw(i));
  put(dir / "l.ply", little);
  put(dir / "b.ply", big);
  put(dir / "a.ply", plyHeader("ascii", layout) + "0 0 0\r\n+1 0 -2\r\n0 3e0 500\r\n3 0 1 2\r\n");
  for (const char* name : {"l.ply", "b.ply", "a.ply"}) {
    const Mesh m = readMeshPly(dir / name);
    EXPECT_EQ(m.vertices, (std::vector<vec3>{{0, 0, 0}, {1, 0, -2}, {0, 3, 500}})) << name;
    EXPECT_EQ(m.triangles.size(), 1u) << name;
  }
  put(dir / "n.ply", plyHeader("ascii",
                               "element vertex 1\r\nproperty float x\r\nproperty float y\r\nproperty float "
                               "z\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\n") +
                         "0 0 0\n3 0 -1 0\n");
  EXPECT_THAT(dataErrorOf([&] { readMeshPly(dir / "n.ply"); }), HasSubstr("-1"));
}

std::string splatHeader(std::size_t count, int rest) {
  std::string h = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) + "\n";
  const auto add = [&](const std::string& name) { h += "property float " + name + "\n"; };
  for (const char* n : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2"}) add(n);
  for (int k = 0; k < rest; ++k) add("f_rest_" + std::to_string(k));
  for (const char* n : {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    add(n);
  return h + "end_header\n";
}

TEST(SplatPly, LowerDegreesAreReadChannelAfterChannelAndRotationsAreMadeUnit) {
  const TempDir dir;
  std::string bytes = splatHeader(1, 9);
  for (const float v : {1.f, 2.f, 3.f, 0.f, 0.f, 0.f}) bytes += raw(v);
  for (int k = 0; k < 9; ++k) bytes += raw(static_cast<float>(k));
  for (const float v : {0.f, -1.f, -2.f, -3.f, 2.f, 0.f, 0.f, 0.f}) bytes += raw(v);
  put(dir / "d1.ply", bytes);
  const SplatFile f = readSplatPly(dir / "d1.ply");
  EXPECT_EQ(f.sh_degree, 1);
  for (int channel = 0; channel < 3; ++channel) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(f.cloud.color.of(0)[(1 + k) * 3 + channel], static_cast<float>(channel * 3 + k));
    }
  }
  EXPECT_EQ(f.cloud.color.of(0)[4 * 3], 0);
  EXPECT_EQ(f.cloud.rotation[0], quat(1, 0, 0, 0));
  EXPECT_FLOAT_EQ(f.cloud.opacity[0], 0.5f);
  put(dir / "empty.ply", splatHeader(0, 45));
  EXPECT_EQ(readSplatPly(dir / "empty.ply").cloud.size(), 0u);
}

TEST(SplatPly, NotFiniteMissingOrTruncatedContentIsRefusedByFile) {
  const TempDir dir;
  std::string bytes = splatHeader(1, 0);
  for (int k = 0; k < 14; ++k) bytes += raw(k == 7 ? std::nanf("") : 0.5f);
  put(dir / "nan.ply", bytes);
  EXPECT_THAT(dataErrorOf([&] { readSplatPly(dir / "nan.ply"); }), HasSubstr("nan.ply"));
  put(dir / "cut.ply", bytes.substr(0, bytes.size() - 1));
  EXPECT_THAT(dataErrorOf([&] { readSplatPly(dir / "cut.ply"); }), HasSubstr("truncated"));
  put(dir / "points.ply",
      "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n");
  EXPECT_THAT(dataErrorOf([&] { readSplatPly(dir / "points.ply"); }), HasSubstr("missing"));
  put(dir / "odd.ply", splatHeader(0, 7));
  EXPECT_THAT(dataErrorOf([&] { readSplatPly(dir / "odd.ply"); }), HasSubstr("f_rest_"));
}

}  // namespace
}  // namespace beam
