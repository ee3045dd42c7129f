// SPDX-License-Identifier: Apache-2.0
// What is said of captures, panoramas and splats that are looked at, and of what is wrong with them.
#include "core/io/capture_check.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/base/rng.h"
#include "core/io/file.h"
#include "tests/core/io/tiny_capture.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

// It is that of camera b in frame 000004.
void putCaptureWithATruncatedPicture(const std::filesystem::path& folder) {
  put(folder / "dataset.json", kDataset);
  putPictures(folder);
  const std::filesystem::path picture = folder / "images/b/000004.png";
  const std::string whole = readTextFile(picture);
  put(picture, whole.substr(0, whole.size() - 9));
}

TEST(CaptureCheck, NamesFileCameraAndFrameOfEachDamagedPicture) {
  const TempDir dir;
  putCaptureWithATruncatedPicture(dir.path());
  writePng(dir / "masks/a/000004.png", Image<std::uint8_t>(7, 7));
  const CheckReport r = checkPath(dir.path());
  EXPECT_EQ(r.kind, "capture");
  EXPECT_EQ(r.cameras[0].frames, 1);
  EXPECT_EQ(r.cameras[1].frames, 1);
  EXPECT_EQ(r.cameras[1].mask_coverage, 1);
  EXPECT_THAT(r.warnings, Contains(AllOf(HasSubstr("b/000004.png"), HasSubstr("truncated"),
                                         HasSubstr("camera b"), HasSubstr("frame 000004"))));
  EXPECT_THAT(r.warnings, Contains(AllOf(HasSubstr("masks/a/000004.png"), HasSubstr("7 x 7"))));
  EXPECT_THAT(toJson(r), AllOf(HasSubstr("\"layout\": \"dataset.json\""), HasSubstr("\"up\": \"+Z\"")));
  EXPECT_THAT(toText(r), HasSubstr("frames: 2 (000003 to 000004)"));
}

TEST(CaptureCheck, NamesAMaskWithAFlippedByte) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPictures(dir.path());
  std::string bytes = readTextFile(dir / "masks/b/000004.png");
  const std::size_t pixels = bytes.find("IDAT") + 5;
  bytes[pixels] = static_cast<char>(bytes[pixels] ^ 0xff);
  put(dir / "masks/b/000004.png", bytes);
  EXPECT_THAT(checkPath(dir.path()).warnings,
              Contains(AllOf(HasSubstr("masks/b/000004.png"), HasSubstr("damaged near byte"))));
}

TEST(CaptureCheck, SaysInTwoHalvesWhatItSaysAtOnce) {
  const TempDir dir;
  putCaptureWithATruncatedPicture(dir.path());
  const ImportedCapture capture = openCapture(dir.path());
  CheckReport r = checkDescription(dir.path(), capture);
  ASSERT_EQ(r.cameras.size(), 3u);
  EXPECT_EQ(r.cameras[0].frames, 0) << "no picture was looked at";
  EXPECT_THAT(r.warnings, Not(Contains(HasSubstr("truncated"))));
  double fraction = 0;
  Progress progress({}, [&](const ProgressReport& report) { fraction = report.fraction; });
  checkPictures(capture.set, r, progress);
  EXPECT_EQ(fraction, 1);
  EXPECT_EQ(toJson(r), toJson(checkPath(dir.path())));
  EXPECT_EQ(toText(r), toText(checkPath(dir.path())));
  EXPECT_THAT(r.warnings, Contains(HasSubstr("truncated")));
}

TEST(CaptureCheck, EndsWhenItIsAskedTo) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPictures(dir.path());
  std::stop_source stop;
  stop.request_stop();
  Progress progress(stop.get_token());
  EXPECT_THROW(checkPath(dir.path(), {}, &progress), Cancelled);
}

TEST(CaptureCheck, ListsWhatWasRepairedInAPanorama) {
  const TempDir dir;
  Planes p(8, 4, 3, 0.5f);
  p.values[5] = INFINITY;
  p.values[6] = -1;
  writeExr(dir / "e.exr", p, {"R", "G", "B"}, ExrPrecision::Float);
  const CheckReport r = checkPath(dir / "e.exr");
  ASSERT_TRUE(r.panorama);
  EXPECT_EQ(r.panorama->width, 8);
  EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("finite")));
}

// Pictures of many colours, which nobody takes for a lens cap.
void putPhotographs(const std::filesystem::path& folder) {
  putPictures(folder);
  const RandomStream random(3);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "images")) {
    if (!entry.is_regular_file()) continue;
    Image<u8vec3> photo(20, 12);
    for (std::size_t i = 0; i < photo.pixels.size(); ++i)
      photo.pixels[i] = u8vec3(static_cast<std::uint8_t>(255 * random.uniform(i)));
    writePng(entry.path(), photo);
  }
}

TEST(CaptureCheck, WarnsOfPicturesOfOneColourOnceACamera) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPhotographs(dir.path());
  EXPECT_THAT(checkPath(dir.path()).warnings, Not(Contains(HasSubstr("one colour"))));
  writePng(dir / "images/b/000004.png", Image<u8vec3>(20, 12, u8vec3(0)));
  EXPECT_THAT(checkPath(dir.path()).warnings,
              Contains(AllOf(HasSubstr("camera b, frame 000004"), HasSubstr("found one colour all over"))));
  writePng(dir / "images/b/000003.png", Image<u8vec3>(20, 12, u8vec3(90, 91, 92)));
  EXPECT_THAT(checkPath(dir.path()).warnings, Contains(HasSubstr("camera b, frames 000003, 000004:")));
}

TEST(CaptureCheck, WarnsOfOtherPicturesAmongThePhotographs) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPhotographs(dir.path());
  writeExr(dir / "images/a/000003.exr", Planes(20, 12, 1, 2.0f), {"Y"}, ExrPrecision::Float);
  put(dir / "images/a/clip.MOV", "x");
  EXPECT_THAT(checkPath(dir.path()).warnings,
              Contains(AllOf(HasSubstr("images/a"), HasSubstr("found also 000003.exr, clip.MOV"),
                             HasSubstr("are not used"))));
}

TEST(CaptureCheck, WarnsOfAPanoramaThatIsNotTwiceAsWideAsHighAndOfOneChannel) {
  const TempDir dir;
  writeExr(dir / "right.exr", Planes(8, 4, 3, 0.5f), {"R", "G", "B"}, ExrPrecision::Float);
  writeExr(dir / "square.exr", Planes(6, 6, 3, 0.5f), {"R", "G", "B"}, ExrPrecision::Float);
  writeExr(dir / "depth.exr", Planes(8, 4, 1, 2.0f), {"Y"}, ExrPrecision::Float);
  EXPECT_THAT(checkPath(dir / "right.exr").warnings, ElementsAre());
  EXPECT_THAT(checkPath(dir / "square.exr").warnings,
              ElementsAre(AllOf(HasSubstr("twice as wide as high"), HasSubstr("6 x 6"))));
  EXPECT_THAT(checkPath(dir / "depth.exr").warnings, ElementsAre(HasSubstr("found Y alone")));
}

TEST(CaptureCheck, NamesAPanoramaOfEightBitsInsteadOfSayingThatThereIsNone) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPhotographs(dir.path());
  writePng(dir / "environment.png", Image<u8vec3>(8, 4, u8vec3(200)));
  const CheckReport r = checkPath(dir.path());
  EXPECT_THAT(r.warnings, Contains(AllOf(HasSubstr("environment.png\" is not used"), HasSubstr("8 bits"))));
  EXPECT_THAT(r.warnings, Not(Contains(HasSubstr("no panorama"))));
}

TEST(CaptureCheck, RefusesACaptureOfWhichNothingCanBeUsed) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPhotographs(dir.path());
  EXPECT_EQ(refusalOf(checkPath(dir.path())), "");
  for (const char* frame : {"000003.png", "000004.png"}) put(dir / "images/a" / frame, "no picture");
  EXPECT_THAT(refusalOf(checkPath(dir.path())), AllOf(HasSubstr("at least 2"), HasSubstr("found 1")));
  for (const char* frame : {"000003.png", "000004.png"}) put(dir / "images/b" / frame, "no picture");
  EXPECT_THAT(refusalOf(checkPath(dir.path())), HasSubstr("found 0"));
}

// White around a black middle: a mask of everything but the subject.
TEST(CaptureCheck, SaysThatMasksLookInvertedAndNothingOfTheSeedPoints) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPhotographs(dir.path());
  put(dir / "points3D.ply",
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\n0 0 0.9\n0 0.1 0.9\n");
  Image<std::uint8_t> mask(20, 12, 0);
  for (int y = 4; y < 9; ++y)
    for (int x = 7; x < 12; ++x) mask(x, y) = 255;
  const auto put_masks = [&](const Image<std::uint8_t>& m) {
    for (const char* camera : {"a", "b"})
      for (const char* frame : {"000003.png", "000004.png"}) writePng(dir / "masks" / camera / frame, m);
  };
  put_masks(mask);
  EXPECT_THAT(checkPath(dir.path()).warnings, Not(Contains(HasSubstr("inverted"))));
  for (std::uint8_t& m : mask.pixels) m = 255 - m;
  put_masks(mask);
  const CheckReport r = checkPath(dir.path());
  EXPECT_THAT(r.warnings, Contains(HasSubstr("the masks look inverted")));
  EXPECT_THAT(r.warnings, Not(Contains(HasSubstr("seed points"))));
}

}  // namespace
}  // namespace beam::testing
