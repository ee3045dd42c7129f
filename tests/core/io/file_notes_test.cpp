// SPDX-License-Identifier: Apache-2.0
// What files say of themselves: read back from whole files alone; and OpenEXR files of several layers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>

#include "core/base/error.h"
#include "core/io/exr_header.h"
#include "core/io/file.h"
#include "core/io/file_notes.h"
#include "core/io/image_file.h"
#include "core/io/mesh_ply.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const FileNotes kNotes = {{"Software", "BEAM Studio, beam render"}, {"source", "0123"}, {"frame", "a b"}};

void put(const fs::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

Planes ramp(int width, int height, int channels) {
  Planes p(width, height, channels);
  for (std::size_t i = 0; i < p.values.size(); ++i) p.values[i] = 0.01f * static_cast<float>(i);
  return p;
}

// One file of each format with notes.
std::vector<fs::path> writeAll(const TempDir& dir) {
  writePng(dir / "a.png", Image<u8vec3>(9, 7, u8vec3(80), Encoding::Srgb), kNotes);
  writeExr(dir / "a.exr", ramp(9, 70, 1), {"Y"}, ExrPrecision::Half, kNotes);
  Mesh m;
  m.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  m.triangles = {{0, 1, 2}, {1, 3, 2}};
  writeMeshPly(dir / "a.ply", m, {.notes = kNotes});
  m.normals.assign(4, vec3(0, 0, 1));
  m.uv.assign(4, vec2(0));
  writeMeshPly(dir / "full.ply", m, {.notes = kNotes});
  return {dir / "a.png", dir / "a.exr", dir / "a.ply", dir / "full.ply"};
}

TEST(FileNotes, ComeBackFromEveryFormatThatHasThem) {
  const TempDir dir;
  for (const fs::path& file : writeAll(dir)) {
    const FileNotes found = notesIn(file);
    for (const auto& [name, text] : kNotes) EXPECT_EQ(noteIn(found, name), text) << file;
    EXPECT_EQ(noteIn(found, "nobody"), "");
  }
}

TEST(FileNotes, OfAFileThatIsNotWholeThereAreNone) {
  const TempDir dir;
  for (const fs::path& file : writeAll(dir)) {
    const std::string whole = readTextFile(file);
    for (const std::size_t kept : {whole.size() - 1, whole.size() - 13, whole.size() / 2, std::size_t{20}}) {
      put(file, whole.substr(0, kept));
      EXPECT_THAT(notesIn(file), IsEmpty()) << file << " of " << kept << " bytes";
    }
    put(file, whole + "x");
    EXPECT_THAT(notesIn(file), IsEmpty()) << file << " and a byte more";
    put(file, whole);
    EXPECT_FALSE(notesIn(file).empty()) << file;
  }
}

TEST(FileNotes, OfAFileWhoseBytesChangedAnywhereThereAreNone) {
  const TempDir dir;
  for (const fs::path& file : writeAll(dir)) {
    const std::string whole = readTextFile(file);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      // The checksum of the note itself is no content.
      std::string bytes = whole;
      bytes[i] = static_cast<char>(bytes[i] ^ 1);
      const std::size_t note = whole.find("content");
      if (file.extension() == ".png" && i >= note + 40 && i < note + 44) continue;
      put(file, bytes);
      ASSERT_THAT(notesIn(file), IsEmpty()) << file << " at byte " << i;
    }
  }
}

TEST(FileNotes, OfAPictureThatAnotherProgramResizedAndLeftItsTextsThereAreNone) {
  const TempDir dir;
  const fs::path file = writeAll(dir)[0];
  constexpr std::size_t kHeader = 8 + 25;
  const std::string whole = readTextFile(file);
  const std::size_t end = whole.find("tEXtcontent") + 4 + 8 + 32 + 4;
  writePng(file, Image<u8vec3>(4, 3, u8vec3(80), Encoding::Srgb));
  std::string small = readTextFile(file);
  put(file, small.insert(kHeader, whole.substr(kHeader, end - kHeader)));
  EXPECT_EQ(readPhoto(file).width, 4);
  EXPECT_THAT(notesIn(file), IsEmpty());
}

TEST(FileNotes, TheirPngIsWholeToOtherReaders) {
  const TempDir dir;
  const fs::path file = writeAll(dir)[0];
  EXPECT_EQ(readPhoto(file).pixels[5], u8vec3(80));
  // libpng refuses or warns of a wrong checksum; ours is compared here by hand.
  const std::string bytes = readTextFile(file);
  const std::size_t chunk = bytes.find("tEXtcontent");
  ASSERT_NE(chunk, std::string::npos);
  const auto sum = ::crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()) + chunk, 4 + 8 + 32);
  for (int k = 0; k < 4; ++k)
    EXPECT_EQ(static_cast<unsigned char>(bytes[chunk + 44 + k]), sum >> (24 - 8 * k) & 255u);
}

TEST(FileNotes, OfWhatIsNoPictureOrNotThereThereAreNone) {
  const TempDir dir;
  put(dir / "text", "Software BEAM Studio, beam render");
  put(dir / "empty", "");
  put(dir / "ply", "ply\nformat ascii 1.0\ncomment source 0123\nelement vertex 0\nend_header\n");
  for (const char* name : {"text", "empty", "ply", "nowhere"})
    EXPECT_THAT(notesIn(dir / name), IsEmpty()) << name;
  EXPECT_THAT(notesIn(dir.path()), IsEmpty()) << "a folder";
}

TEST(ExrLayers, ComeBackByTheirNamesAndInTheirPrecision) {
  const TempDir dir;
  const Planes color = ramp(40, 70, 3), depth = ramp(40, 70, 1);
  const std::vector<ExrChannel> channels = {{"R", ExrPrecision::Half, color.plane(0)},
                                            {"normal.X", ExrPrecision::Half, color.plane(1)},
                                            {"depth.Z", ExrPrecision::Float, depth.plane(0)}};
  writeExr(dir / "l.exr", 40, 70, channels, kNotes);
  EXPECT_THAT(exrChannels(dir / "l.exr"), ::testing::ElementsAre("R", "depth.Z", "normal.X"));
  EXPECT_EQ(readExr(dir / "l.exr", {"depth.Z"}).values, depth.values);
  const Planes x = readExr(dir / "l.exr", {"normal.X"});
  for (std::size_t i = 0; i < x.values.size(); ++i)
    EXPECT_NEAR(x.values[i], color.plane(1)[i], 1e-3f * color.plane(1)[i]);
  EXPECT_EQ(noteIn(notesIn(dir / "l.exr"), "source"), "0123");
}

TEST(ExrLayers, TheSameChannelsGiveTheSameBytesAsPlanes) {
  const TempDir dir;
  for (const ExrPrecision precision : {ExrPrecision::Half, ExrPrecision::Float}) {
    const Planes p = ramp(33, 600, 3);
    writeExr(dir / "planes.exr", p, {"R", "G", "B"}, precision, kNotes);
    const std::vector<ExrChannel> channels = {
        {"B", precision, p.plane(2)}, {"G", precision, p.plane(1)}, {"R", precision, p.plane(0)}};
    writeExr(dir / "channels.exr", 33, 600, channels, kNotes);
    EXPECT_EQ(readTextFile(dir / "planes.exr"), readTextFile(dir / "channels.exr"));
  }
}

TEST(ExrLayers, MoreThanIsReadAgainIsRefusedBeforeItTakesMemory) {
  const TempDir dir;
  const std::vector<ExrChannel> many(65, {"Y", ExrPrecision::Half, nullptr});
  const std::vector<ExrChannel> four(4, {"Y", ExrPrecision::Float, nullptr});
  EXPECT_THAT(dataErrorOf([&] { writeExr(dir / "m.exr", 8, 8, many); }), HasSubstr("64 channels"));
  EXPECT_THAT(dataErrorOf([&] { writeExr(dir / "m.exr", 16384, 16384, four); }),
              AllOf(HasSubstr("m.exr"), HasSubstr("16384 x 16384"), HasSubstr("fewer channels")));
  EXPECT_THAT(dataErrorOf([&] { writeExr(dir / "m.exr", 20000, 8, four); }),
              HasSubstr("16384 pixels a side"));
  EXPECT_FALSE(fs::exists(dir / "m.exr"));
  EXPECT_NO_THROW(requireExrSize(8192, 8192, 4, 8, dir / "m.exr"));
}

}  // namespace
}  // namespace beam::testing
