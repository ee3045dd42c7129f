// SPDX-License-Identifier: Apache-2.0
// Captures: one capture in three descriptions gives the same cameras; damage is refused or left out by name.
#include "core/io/capture_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "core/base/error.h"
#include "core/io/image_file.h"
#include "tests/core/io/tiny_capture.h"
#include "tests/support/temp_dir.h"

namespace beam {
namespace {

using testing::errorOf;
using ::testing::HasSubstr;
using testing::kDataset;
using testing::put;
using testing::putPictures;
using testing::TempDir;
namespace fs = std::filesystem;

TEST(CaptureReader, ReadsADatasetIntoTheHousesWorld) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPictures(dir.path());
  const ImportedCapture c = openCapture(dir.path());
  EXPECT_EQ(c.layout, "dataset.json");
  ASSERT_EQ(c.set.views.size(), 3u);
  EXPECT_EQ(c.set.views[2].split, Split::Test);
  EXPECT_EQ(c.set.frames, (std::vector<std::string>{"000003", "000004"}));
  EXPECT_NE(c.set.masks, MaskKind::None);
  // A point 1 m above the capture's origin (its +Z) is 1 m along the world's +Y.
  const dvec3 expected = dvec3(0.1, 0.9 - 1, 3);
  const dvec3 got = c.set.views[0].camera.camera_from_world * dvec3(0, 1, 0);
  EXPECT_NEAR(glm::length(got - expected), 0, 1e-9);
  EXPECT_EQ(c.set.source->photo(ViewIndex{1}, FrameIndex{1})(0, 0), u8vec3(10, 20, 30));
  EXPECT_FALSE(c.set.source->has(ViewIndex{2}, FrameIndex{0}));
}

TEST(CaptureReader, GivesTheSameCamerasFromTransformsAndColmap) {
  const TempDir dir;
  put(dir / "d/dataset.json", kDataset);
  putPictures(dir / "d");
  putPictures(dir / "t");
  putPictures(dir / "c");
  const ImportedCapture d = openCapture(dir / "d");
  // world_from_camera of "a" with an OpenGL camera, and COLMAP's camera_from_world quaternion of the same R.
  put(dir / "t/transforms.json", R"({"w": 20, "h": 12, "fl_x": 30, "fl_y": 31, "cx": 9.5, "cy": 6, "frames": [
    {"file_path": "images/a/000003.png", "transform_matrix": [[1,0,0,-0.1],[0,0,-1,-3],[0,1,0,0.9],[0,0,0,1]]},
    {"file_path": "images/b/000003.png", "transform_matrix": [[0,0,1,3],[1,0,0,0],[0,1,0,0.9],[0,0,0,1]]}]})");
  put(dir / "c/sparse/0/cameras.txt", "# c\n1 PINHOLE 20 12 30 31 9.5 6\n");
  const double h = std::sqrt(0.5);
  put(dir / "c/sparse/0/images.txt", "1 " + std::to_string(h) + " " + std::to_string(h) +
                                         " 0 0 0.1 0.9 3 1 a\n\n"
                                         "2 0.5 0.5 0.5 -0.5 0 0.9 3 1 b\n\n");
  put(dir / "c/sparse/0/points3D.txt", "");
  for (const char* other : {"t", "c"}) {
    const ImportedCapture o = openCapture(dir / other);
    EXPECT_EQ(o.set.up, UpAxis::PlusZ) << other;
    ASSERT_EQ(o.set.views.size(), 2u) << other;
    for (int v = 0; v < 2; ++v) {
      const Camera &x = d.set.views[v].camera, &y = o.set.views[v].camera;
      for (const dvec3& p : {dvec3(0), dvec3(0.3, 1.1, -0.2)}) {
        EXPECT_NEAR(glm::length(x.camera_from_world * p - y.camera_from_world * p), 0, 2e-6) << other << v;
      }
      EXPECT_DOUBLE_EQ(x.intrinsics.cx, y.intrinsics.cx);
    }
  }
}

TEST(CaptureReader, HoldsOutNamedAndEveryNthCameras) {
  const TempDir dir;
  std::string three = kDataset;
  put(dir / "dataset.json", three.replace(three.find("\"test\""), 6, "\"train\""));
  putPictures(dir.path());
  for (const char* f : {"000003", "000004"}) {
    fs::create_directories(dir / "images/c");
    writePng(dir / ("images/c/" + std::string(f) + ".png"), Image<u8vec3>(20, 12));
  }
  const ImportedCapture c = openCapture(dir.path(), {.hold_out = {"b"}});
  EXPECT_EQ(c.set.views[1].split, Split::Test);
  EXPECT_EQ(c.set.views[0].split, Split::Train);
  EXPECT_THROW(openCapture(dir.path(), {.hold_out = {"nobody"}}), Error);
}

TEST(CaptureReader, AnEmptyFolderSaysWhatWasLookedFor) {
  const TempDir dir;
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("transforms.json"));
  EXPECT_THAT(errorOf(dir / "nowhere"), HasSubstr("nowhere"));
}

TEST(CaptureReader, ACalibrationWithNaNIsRefusedByName) {
  const TempDir dir;
  std::string bad = kDataset;
  bad.replace(bad.find("\"fx\": 30"), 8, "\"fx\": NaN");
  put(dir / "dataset.json", bad);
  putPictures(dir.path());
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("NaN"));
  std::string zero = kDataset;
  zero.replace(zero.find("\"fx\": 30"), 8, "\"fx\":   0");
  put(dir / "dataset.json", zero);
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("\"a\""));
}

TEST(CaptureReader, AMissingCameraFolderLeavesThatCameraOut) {
  const TempDir dir;
  std::string three = kDataset;
  put(dir / "dataset.json", three.replace(three.find("\"test\""), 6, "\"train\""));
  putPictures(dir.path());
  const ImportedCapture c = openCapture(dir.path());
  EXPECT_EQ(c.set.views.size(), 2u);
  ASSERT_FALSE(c.warnings.empty());
  EXPECT_THAT(c.warnings[0], HasSubstr("camera c"));
}

TEST(CaptureReader, PicturesAndMasksOfAnotherSizeAreRefusedWithBothSizes) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPictures(dir.path(), 22);
  const ImportedCapture c = openCapture(dir.path());
  try {
    c.set.source->photo(ViewIndex{0}, FrameIndex{0});
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("20 x 12"));
    EXPECT_THAT(e.what(), HasSubstr("22 x 12"));
  }
  putPictures(dir.path());
  writePng(dir / "masks/a/000003.png", Image<std::uint8_t>(10, 6, 255));
  EXPECT_THROW(openCapture(dir.path()).set.source->mask(ViewIndex{0}, FrameIndex{0}), Error);
}

TEST(CaptureReader, ColmapCountsAreHeldAgainstTheBytesBeforeMemoryIsTaken) {
  const TempDir dir;
  const std::uint64_t absurd = std::uint64_t{1} << 60;
  std::string count(8, '\0');
  std::memcpy(count.data(), &absurd, 8);
  put(dir / "sparse/0/cameras.bin", count + std::string(64, '\0'));
  put(dir / "sparse/0/images.bin", count);
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("cameras.bin"));
}

TEST(CaptureReader, OtherColmapModelsAreRefusedByName) {
  const TempDir dir;
  put(dir / "sparse/0/cameras.txt", "1 SIMPLE_RADIAL 20 12 30 10 6 0.1\n");
  put(dir / "sparse/0/images.txt", "1 1 0 0 0 0 0 3 1 a\n\n");
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("SIMPLE_RADIAL"));
}

TEST(CaptureReader, DomeTinyIsTheSameThroughAllThreeDescriptions) {
  const auto shared = testing::sharedFolder();
  if (!shared) GTEST_SKIP() << "the shared data is not there; set BEAM_SHARED";
  const fs::path data = *shared / "data/dome-tiny";
  const ImportedCapture whole = openCapture(data);
  EXPECT_EQ(std::count_if(whole.set.views.begin(), whole.set.views.end(),
                          [](const View& v) { return v.split == Split::Test; }),
            2);
  EXPECT_TRUE(whole.set.environment_file);
  EXPECT_GT(whole.set.seed_points.position_m.size(), 1000u);
  const TempDir dir;
  for (const char* keep : {"transforms.json", "sparse"}) {
    const fs::path copy = dir / (std::string(keep) + ".d");
    fs::create_directories(copy);
    for (const char* entry : {"images", "masks", keep})
      fs::create_symlink(fs::absolute(data / entry), copy / entry);
    const ImportedCapture other = openCapture(copy);
    ASSERT_EQ(other.set.views.size(), 10u) << keep;
    EXPECT_EQ(other.set.frames, whole.set.frames);
    for (const View& v : other.set.views) {
      const auto same = std::find_if(whole.set.views.begin(), whole.set.views.end(),
                                     [&](const View& w) { return w.name == v.name; });
      ASSERT_NE(same, whole.set.views.end());
      for (const dvec3& p : {dvec3(0), dvec3(0.3, 1.1, -0.2)}) {
        EXPECT_NEAR(glm::length(same->camera.camera_from_world * p - v.camera.camera_from_world * p), 0, 1e-6)
            << v.name;
      }
    }
  }
}

}  // namespace
}  // namespace beam
