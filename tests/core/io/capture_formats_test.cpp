// SPDX-License-Identifier: Apache-2.0
// Descriptions, masks, axes and light of captures: what each format may say, and what is refused by name.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/io/capture_reader.h"
#include "core/io/file.h"
#include "core/io/mesh_ply.h"
#include "core/scene/environment.h"
#include "tests/core/io/tiny_capture.h"
#include "tests/support/temp_dir.h"

namespace beam {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::errorOf;
using ::testing::HasSubstr;
using testing::kDataset;
using testing::put;
using testing::putPictures;
using testing::replaced;
using testing::TempDir;
namespace fs = std::filesystem;

constexpr const char* kTransforms =
    R"({"w": 20.0, "h": 12, "fl_x": 30, "fl_y": 31, "cx": 9.5, "cy": 6, "frames": [
  {"file_path": "images/a/000003.png", "transform_matrix": [[1,0,0,-0.1],[0,0,-1,-3],[0,1,0,0.9],[0,0,0,1]]},
  {"file_path": "images/b/000003.png", "transform_matrix": [[0,0,1,3],[1,0,0,0],[0,1,0,0.9],[0,0,0,1]]}]})";
constexpr const char* kColmapCameras = "1 PINHOLE 20 12 30 31 9.5 6\n";
constexpr const char* kPoseA = "0.707106781187 0.707106781187 0 0 0.1 0.9 3 1 ";
constexpr const char* kPoseB = "0.5 0.5 0.5 -0.5 0 0.9 3 1 ";

void putColmap(const fs::path& folder, const std::string& a, const std::string& b,
               const std::string& cameras = kColmapCameras) {
  put(folder / "sparse/0/cameras.txt", cameras);
  put(folder / "sparse/0/images.txt", "1 " + (kPoseA + a) + "\n\n2 " + kPoseB + b + "\n1.5 2.5 -1\n");
}

template <class... T>
std::string raw(T... values) {
  std::string s;
  const auto add = [&](const auto& v) { s.append(reinterpret_cast<const char*>(&v), sizeof(v)); };
  (add(values), ...);
  return s;
}
using u32 = std::uint32_t;
using u64 = std::uint64_t;

std::string binaryCameras(double fx = 30) {
  return raw(u64{1}, u32{1}, 1, u64{20}, u64{12}, fx, 31.0, 9.5, 6.0);
}
std::string binaryImages() {
  const double h = std::sqrt(0.5);
  return raw(u64{2}) + raw(u32{1}, h, h, 0.0, 0.0, 0.1, 0.9, 3.0, u32{1}) + std::string("a\0", 2) +
         raw(u64{0}) + raw(u32{2}, 0.5, 0.5, 0.5, -0.5, 0.0, 0.9, 3.0, u32{1}) + std::string("b\0", 2) +
         raw(u64{0});
}

TEST(CaptureFormats, DatasetComesBeforeTransformsAndTheseBeforeColmapBinaryBeforeText) {
  const TempDir dir;
  putPictures(dir.path());
  put(dir / "dataset.json", kDataset);
  put(dir / "transforms.json", kTransforms);
  put(dir / "sparse/0/cameras.bin", binaryCameras());
  put(dir / "sparse/0/images.bin", binaryImages());
  putColmap(dir.path(), "a", "b");
  for (const char* layout : {"dataset.json", "transforms.json", "COLMAP binary", "COLMAP text"}) {
    const ImportedCapture c = openCapture(dir.path());
    EXPECT_EQ(c.layout, layout);
    const dvec3 got = c.set.views[0].camera.camera_from_world * dvec3(0.3, 1.1, -0.2);
    // World (0.3, 1.1, -0.2) is (-0.2, 0.3, 1.1) in the capture's axes.
    EXPECT_NEAR(glm::length(got - dvec3(-0.2 + 0.1, -1.1 + 0.9, 0.3 + 3)), 0, 1e-6) << layout;
    const fs::path first = dir / layout;
    fs::remove(fs::exists(first) ? first : dir / "sparse/0/cameras.bin");
  }
}

TEST(CaptureFormats, ColmapNamesMayBeFoldersFramesOfACameraOrPlainFiles) {
  const TempDir dir;
  putPictures(dir / "frames");
  putColmap(dir / "frames", "a/000003.png", "b/000003.png");
  const ImportedCapture frames = openCapture(dir / "frames");
  EXPECT_EQ(frames.set.views[1].name, "b");
  EXPECT_THAT(frames.set.frames, ElementsAre("000003"));
  for (const char* name : {"wide (0).png", "other.png"}) {
    fs::create_directories(dir / "plain/images");
    writePng(dir / "plain/images" / name, Image<u8vec3>(20, 12, u8vec3(1, 2, 3)));
  }
  putColmap(dir / "plain", "wide (0).png", "other.png");
  const ImportedCapture plain = openCapture(dir / "plain");
  ASSERT_EQ(plain.set.views.size(), 2u);
  EXPECT_EQ(plain.set.views[0].name, "other");
  EXPECT_EQ(plain.set.views[1].name, "wide (0)");
  EXPECT_EQ(plain.set.frames.size(), 1u);
  EXPECT_EQ(plain.set.masks, MaskKind::None);
}

TEST(CaptureFormats, CalibrationsThatAreNotFiniteNameFileCameraAndField) {
  const TempDir dir;
  putPictures(dir.path());
  put(dir / "dataset.json", replaced(kDataset, "\"fy\": 31", "\"fy\": NaN"));
  EXPECT_THAT(errorOf(dir.path()), AllOf(HasSubstr("dataset.json"), HasSubstr("\"a\""), HasSubstr("\"fy\"")));
  put(dir / "dataset.json", replaced(kDataset, "[0.1, 0.9, 3]", "[0.1, -Infinity, 3]"));
  EXPECT_THAT(errorOf(dir.path()), AllOf(HasSubstr("\"a\""), HasSubstr("-Infinity")));
  fs::remove(dir / "dataset.json");
  put(dir / "transforms.json", replaced(kTransforms, "-0.1]", "nan]"));
  EXPECT_THAT(errorOf(dir.path()), AllOf(HasSubstr("transforms.json"), HasSubstr("\"a\"")));
  fs::remove(dir / "transforms.json");
  putColmap(dir.path(), "a", "b", "1 PINHOLE 20 12 30 nan 9.5 6\n");
  EXPECT_THAT(errorOf(dir.path()), AllOf(HasSubstr("cameras.txt"), HasSubstr("camera 1")));
  put(dir / "sparse/0/cameras.bin", binaryCameras(std::nan("")));
  put(dir / "sparse/0/images.bin", binaryImages());
  EXPECT_THAT(errorOf(dir.path()), AllOf(HasSubstr("cameras.bin"), HasSubstr("camera 1")));
  std::string images = binaryImages();
  put(dir / "sparse/0/cameras.bin", binaryCameras());
  put(dir / "sparse/0/images.bin", images.replace(8 + 4, 8, raw(std::nan(""))));
  EXPECT_THAT(errorOf(dir.path()), AllOf(HasSubstr("images.bin"), HasSubstr("\"a\"")));
}

TEST(CaptureFormats, ARateThatNothingPlaysAtIsToldAndNotTaken) {
  const TempDir dir;
  putPictures(dir.path());
  for (const char* rate : {"0", "-5", "1e308", "1e-300"}) {
    put(dir / "dataset.json", replaced(kDataset, "\"fps\": 25", std::string("\"fps\": ") + rate));
    const ImportedCapture c = openCapture(dir.path());
    EXPECT_EQ(c.set.frames_per_second, 30);
    EXPECT_THAT(c.warnings, ::testing::Contains(HasSubstr("\"fps\" from 0.01 to 10000")));
  }
}

TEST(CaptureFormats, DeepListsAreRefusedAndLongOnesNotRepeated) {
  const TempDir dir;
  putPictures(dir.path());
  const auto with = [&](const std::string& fx) {
    put(dir / "dataset.json", replaced(kDataset, "\"fx\": 30", "\"fx\": " + fx));
    return errorOf(dir.path());
  };
  EXPECT_THAT(with(std::string(300000, '[') + std::string(300000, ']')),
              AllOf(HasSubstr("dataset.json"), HasSubstr("levels")));
  EXPECT_LT(with("\"" + std::string(5000, 'x') + "\"").size(), 300u);
}

TEST(CaptureFormats, ValuesOfAnotherTypeOrSizeAreBadInputAndNoCrash) {
  const TempDir dir;
  putPictures(dir.path());
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"\"t\", \"fps\"", "7, \"fps\""},
                                                        {"{\"up\": \"+Z\"}", "\"up\""},
                                                        {"\"fps\": 25", "\"fps\": \"25\""},
                                                        {"\"width\": 20", "\"width\": 1e30"},
                                                        {"[[1,0,0],", "[[1,0],"},
                                                        {"\"a\":", "\"../gt\":"}}) {
    put(dir / "dataset.json", replaced(kDataset, from, to));
    EXPECT_THAT(errorOf(dir.path()), HasSubstr("dataset.json")) << to;
  }
  fs::remove(dir / "dataset.json");
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"\"frames\": [", "\"frames\": [5,"},
                                                        {"\"w\": 20.0", "\"w\": -4"},
                                                        {"\"fl_x\": 30", "\"fl_x\": 0"}}) {
    put(dir / "transforms.json", replaced(kTransforms, from, to));
    EXPECT_THAT(errorOf(dir.path()), HasSubstr("transforms.json")) << to;
  }
  fs::remove(dir / "transforms.json");
  putColmap(dir.path(), "../../etc/x.png", "b");
  EXPECT_THAT(errorOf(dir.path()), HasSubstr(".."));
}

TEST(CaptureFormats, LensesWithDistortionAreRefusedByNameAndThoseWithoutAreTaken) {
  const TempDir dir;
  putPictures(dir.path());
  putColmap(dir.path(), "a", "b", "1 OPENCV 20 12 30 31 9.5 6 0 0 0 0\n");
  EXPECT_EQ(openCapture(dir.path()).set.views[0].camera.intrinsics.fy, 31);
  putColmap(dir.path(), "a", "b", "1 OPENCV 20 12 30 31 9.5 6 0 0.1 0 0\n");
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("OPENCV"));
  putColmap(dir.path(), "a", "b", "1 OPENCV_FISHEYE 20 12 30 31 9.5 6 0 0 0 0\n");
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("OPENCV_FISHEYE"));
  put(dir / "transforms.json", replaced(kTransforms, "\"w\"", "\"k1\": 0.1, \"w\""));
  EXPECT_THAT(errorOf(dir.path()), AllOf(HasSubstr("k1"), HasSubstr("\"a\"")));
}

TEST(CaptureFormats, ACameraThatMovesBetweenItsPicturesIsRefused) {
  const TempDir dir;
  putPictures(dir.path());
  const std::string again =
      R"({"file_path": "images/a/000004.png", "transform_matrix": [[1,0,0,-0.2],[0,0,-1,-3],[0,1,0,0.9],[0,0,0,1]]},)";
  put(dir / "transforms.json", replaced(kTransforms, "\"frames\": [", "\"frames\": [" + again));
  EXPECT_THAT(errorOf(dir.path()), AllOf(HasSubstr("\"a\""), HasSubstr("moves")));
}

TEST(CaptureFormats, TransformsMayLackSizesUseBackSlashesAndNameTestPictures) {
  const TempDir dir;
  putPictures(dir.path());
  std::string text =
      replaced(kTransforms, R"("w": 20.0, "h": 12, "fl_x": 30, "fl_y": 31, "cx": 9.5, "cy": 6,)",
               R"("camera_angle_x": 0.6435011087932844, "ply_file_path": "seed.ply",)");
  text = replaced(text, "images/a/000003.png", R"(.\\images\\a\\000003)");
  put(dir / "transforms.json", "\xef\xbb\xbf" + text);
  writePointsPly(dir / "seed.ply", {{{1, 2, 3}}, {}});
  const ImportedCapture c = openCapture(dir.path());
  EXPECT_NEAR(c.set.views[0].camera.intrinsics.fx, 30, 1e-9);  // 2 atan(10 / 30)
  EXPECT_EQ(c.set.views[0].camera.intrinsics.cy, 6);
  ASSERT_EQ(c.set.seed_points.position_m.size(), 1u);
  EXPECT_EQ(c.set.seed_points.position_m[0], vec3(2, 3, 1));  // x_world = y, y_world = z, z_world = x
  put(dir / "transforms.json",
      replaced(kTransforms, "\"w\"", "\"test_filenames\": [\"images/b/000003.png\"], \"w\""));
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("at least 2 training cameras"));
}

TEST(CaptureFormats, ColmapPointsThatOneCameraSeesAreDropped) {
  const TempDir dir;
  putPictures(dir.path());
  putColmap(dir.path(), "a", "b");
  put(dir / "sparse/0/points3D.txt",
      "9 1 2 3 10 20 30 0.5 1 0 2 5\n4 4 5 6 10 20 30 0.5 1 0 1 3\n5 7 8 9 1 2 3 0.5 2 0 77 1\n");
  const ImportedCapture text = openCapture(dir.path());
  ASSERT_EQ(text.set.seed_points.position_m.size(), 1u);
  EXPECT_EQ(text.set.seed_points.position_m[0], vec3(2, 3, 1));
  EXPECT_EQ(text.set.seed_points.color[0], u8vec3(10, 20, 30));
  put(dir / "sparse/0/cameras.bin", binaryCameras());
  put(dir / "sparse/0/images.bin", binaryImages());
  const auto point = [](u64 id, double x, std::vector<u32> images) {
    std::string s =
        raw(id, x, 2.0, 3.0, std::uint8_t{10}, std::uint8_t{20}, std::uint8_t{30}, 0.5, u64{images.size()});
    for (const u32 i : images) s += raw(i, u32{0});
    return s;
  };
  put(dir / "sparse/0/points3D.bin", raw(u64{2}) + point(9, 1, {1, 2}) + point(4, 4, {2, 2, 77}));
  const ImportedCapture binary = openCapture(dir.path());
  EXPECT_EQ(binary.layout, "COLMAP binary");
  EXPECT_EQ(binary.set.seed_points.position_m, text.set.seed_points.position_m);
}

TEST(CaptureFormats, AbsurdCountsAnywhereInAColmapModelAreRefused) {
  const TempDir dir;
  putPictures(dir.path());
  const u64 absurd = u64{1} << 61;
  put(dir / "sparse/0/cameras.bin", binaryCameras());
  std::string images = binaryImages();
  put(dir / "sparse/0/images.bin", images.replace(images.find(std::string("a\0", 2)) + 2, 8, raw(absurd)));
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("images.bin"));
  put(dir / "sparse/0/images.bin", binaryImages());
  put(dir / "sparse/0/points3D.bin", raw(absurd));
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("points3D.bin"));
  put(dir / "sparse/0/points3D.bin", raw(u64{0}));
  put(dir / "sparse/0/images.bin", binaryImages().substr(0, 100));
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("images.bin"));
}

TEST(CaptureFormats, EveryNthCameraIsTheSameInEveryDescription) {
  const TempDir dir;
  putPictures(dir.path());
  for (const char* camera : {"c", "d"}) {
    fs::create_directories(dir / "images" / camera);
    writePng(dir / "images" / camera / "000003.png", Image<u8vec3>(20, 12));
  }
  const std::string pose = kPoseA;
  put(dir / "sparse/0/cameras.txt", kColmapCameras);
  put(dir / "sparse/0/images.txt",
      "1 " + pose + "d\n\n2 " + pose + "b\n\n3 " + pose + "a\n\n4 " + pose + "c\n\n");
  const ImportedCapture c = openCapture(dir.path(), {.hold_out = {"3"}});
  std::string held;
  for (const View& v : c.set.views) {
    if (v.split == Split::Test) held += v.name;
  }
  EXPECT_EQ(held, "ad");
  EXPECT_THAT(errorOf(dir.path(), {.hold_out = {"1"}}, Error::Kind::Usage), HasSubstr("--hold-out"));
}

TEST(CaptureFormats, FramesThatNoCameraHasAreNamed) {
  const TempDir dir;
  for (const char* camera : {"a", "b"}) fs::create_directories(dir / "images" / camera);
  const Image<u8vec3> picture(20, 12, u8vec3(9));
  for (const char* frame : {"000010", "000012", "000014", "000020"}) {
    for (const char* camera : {"a", "b"})
      writePng(dir / "images" / camera / (std::string(frame) + ".png"), picture);
  }
  std::string frames;
  for (const char* camera : {"a", "b"}) {
    for (const char* frame : {"000010", "000012", "000014", "000020"})
      frames += fmt::format(
          R"({{"file_path": "images/{}/{}.png", "transform_matrix": [[1,0,0,{}],[0,0,-1,-3],[0,1,0,0.9],[0,0,0,1]]}},)",
          camera, frame, *camera == 'a' ? -0.1 : 0.1);
  }
  frames.pop_back();
  put(dir / "transforms.json",
      R"({"fl_x": 24, "fl_y": 24, "cx": 10, "cy": 6, "w": 20, "h": 12, "frames": [)" + frames + "]}");
  const std::vector<std::string> warnings = openCapture(dir.path()).warnings;
  EXPECT_THAT(warnings,
              ::testing::Contains(HasSubstr("no camera has a picture between frames 000014 and 000020;")));
}

TEST(CaptureFormats, MasksAreFoundByNameElseInAlphaElseByAKeyWithAConstantBorder) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPictures(dir.path());
  fs::remove_all(dir / "masks");
  EXPECT_EQ(openCapture(dir.path()).set.masks, MaskKind::None);
  const auto coverage = [&](const char* what) {
    const ImportedCapture c = openCapture(dir.path());
    EXPECT_NE(c.set.masks, MaskKind::None) << what;
    const Image<std::uint8_t> m = c.set.source->mask(ViewIndex{0}, FrameIndex{0});
    EXPECT_EQ(m.width, 20) << what;
    return m.empty() ? std::make_pair(0, 0) : std::make_pair(int{m(0, 0)}, int{m(10, 6)});
  };
  // A subject on black: the border is constant, so black is the key.
  Image<u8vec3> keyed(20, 12);
  for (int y = 4; y < 8; ++y) {
    for (int x = 5; x < 15; ++x) keyed(x, y) = u8vec3(90, 80, 70);
  }
  for (const char* camera : {"a", "b"}) {
    for (const char* frame : {"000003.png", "000004.png"}) writePng(dir / "images" / camera / frame, keyed);
  }
  EXPECT_EQ(coverage("key"), std::make_pair(0, 255));
  keyed(0, 5) = u8vec3(1);
  writePng(dir / "images/a/000003.png", keyed);
  EXPECT_EQ(openCapture(dir.path()).set.masks, MaskKind::None);
  // Files win, under each of their names.
  Image<std::uint8_t> mask(20, 12, 40);
  for (const char* name : {"masks/a/000003.png.png", "mask/a/000003.png", "mattes/a/000003.png",
                           "alpha/a/000003.png", "images/a/000003_alpha.png", "images/a/000003_mask.png"}) {
    fs::create_directories((dir / name).parent_path());
    writePng(dir / name, mask);
    EXPECT_EQ(coverage(name), std::make_pair(40, 40));
    const std::vector<std::string> warnings = openCapture(dir.path()).warnings;
    EXPECT_THAT(warnings, ::testing::Contains(HasSubstr("camera b has no mask"))) << name;
    fs::remove(dir / name);
  }
}

TEST(CaptureFormats, AMaskOfAnotherSizeNamesItsFileAndBothSizes) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPictures(dir.path());
  writePng(dir / "masks/a/000003.png", Image<std::uint8_t>(10, 6, 255));
  try {
    openCapture(dir.path()).set.source->mask(ViewIndex{0}, FrameIndex{0});
    FAIL() << "expected an error";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Data);
    EXPECT_THAT(e.what(), AllOf(HasSubstr("masks/a/000003.png"), HasSubstr("20 x 12"), HasSubstr("10 x 6")));
  }
}

TEST(CaptureFormats, UpIsTakenFromTheCamerasWithin15DegreesElseAskedFor) {
  const TempDir dir;
  putPictures(dir.path());
  const auto withTilt = [&](double degrees, double sign) {
    const double a = degrees * M_PI / 180, c = std::cos(a) * sign, s = std::sin(a) * sign;
    const std::string m =
        fmt::format("[[{},0,0,0],[0,{},{},0],[0,{},{},3],[0,0,0,1]]", sign, c, -s, s * sign, c * sign);
    std::string text = R"({"w": 20, "h": 12, "fl_x": 30, "frames": [)";
    for (const char* camera : {"a", "b"}) {
      text += fmt::format(R"({{"file_path": "images/{}/000003.png", "transform_matrix": {}}}{})", camera, m,
                          *camera == 'a' ? "," : "]}");
    }
    put(dir / "transforms.json", text);
  };
  withTilt(14, 1);
  EXPECT_EQ(openCapture(dir.path()).set.up, UpAxis::PlusY);
  withTilt(16, 1);
  EXPECT_THAT(errorOf(dir.path()), HasSubstr("--up"));
  EXPECT_EQ(openCapture(dir.path(), {.up = UpAxis::PlusZ}).set.up, UpAxis::PlusZ);
  withTilt(0, -1);
  EXPECT_EQ(openCapture(dir.path()).set.up, UpAxis::MinusY);
}

TEST(CaptureFormats, FramesAreInTheOrderOfTheirNumbers) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  for (const char* camera : {"a", "b"}) {
    fs::create_directories(dir / "images" / camera);
    for (const char* frame : {"2.png", "10.png", "1.png"}) {
      writePng(dir / "images" / camera / frame, Image<u8vec3>(20, 12, u8vec3(5)));
    }
    put(dir / "images" / camera / "._1.png", "what macOS leaves behind");
  }
  EXPECT_THAT(openCapture(dir.path()).set.frames, ElementsAre("1", "2", "10"));
}

TEST(CaptureFormats, ThePanoramaOfAPlusZCaptureKeepsItsPixelsAndPointsWhereTheDatasetSays) {
  const TempDir dir;
  put(dir / "dataset.json", kDataset);
  putPictures(dir.path());
  for (const ivec2& bright : {ivec2(3, 2), ivec2(20, 12), ivec2(29, 7)}) {
    Planes p(32, 16, 3, 0.01f);
    for (int c = 0; c < 3; ++c) p.plane(c)[bright.y * 32 + bright.x] = 50;
    writeExr(dir / "environment.exr", p, {"R", "G", "B"}, ExrPrecision::Float);
    const ImportedCapture c = openCapture(dir.path());
    ASSERT_TRUE(c.set.environment_file);
    const Environment e = makeEnvironment(readRadiance(*c.set.environment_file));
    // dataset.json: az = pi - 2 pi u, el = pi / 2 - pi v, d = (cos el cos az, cos el sin az, sin el).
    const double az = M_PI - 2 * M_PI * (bright.x + 0.5) / 32, el = M_PI / 2 - M_PI * (bright.y + 0.5) / 16;
    const dvec3 d(std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el));
    EXPECT_NEAR(glm::length(dvec3(brightestDirection(e)) - worldFromCapture(c.set.up) * d), 0, 1e-5);
  }
}

// Of the points that fall into the picture of a view, the share that lies in its mask; and how many fall
// there.
struct InMask {
  double share = 0;
  std::size_t seen = 0;
};
InMask inMask(const std::vector<vec3>& points, const Camera& camera, const Image<std::uint8_t>& mask) {
  InMask r;
  std::size_t inside = 0;
  for (const vec3& p : points) {
    const dvec3 x = camera.camera_from_world * dvec3(p);
    const dvec2 pixel = project(camera.intrinsics, x);
    if (!(x.z > 0 && pixel.x >= 0 && pixel.y >= 0 && pixel.x < mask.width && pixel.y < mask.height)) continue;
    ++r.seen;
    inside += mask(static_cast<int>(pixel.x), static_cast<int>(pixel.y)) > 0;
  }
  r.share = static_cast<double>(inside) / static_cast<double>(std::max<std::size_t>(r.seen, 1));
  return r;
}

// The seed of the data is the hull of frame 0. It also holds space that a camera does not see (half of the
// points and more, in dome-tiny), where no mask could carve: only what falls into a picture is held against
// its mask.
TEST(CaptureFormats, SeedPointsOfDomeTinyLieInTheMasksOfFrameZeroAndTurnedOnesDoNot) {
  const auto shared = testing::sharedFolder();
  if (!shared) GTEST_SKIP() << "the shared data is not there; set BEAM_SHARED";
  const ImportedCapture c = openCapture(*shared / "data/dome-tiny");
  ASSERT_EQ(c.set.views.size(), 12u);
  const std::vector<vec3>& points = c.set.seed_points.position_m;
  std::vector<vec3> turned;  // by a quarter about the world's up axis
  for (const vec3& p : points) turned.emplace_back(p.z, p.y, -p.x);
  double worst_turned = 1;
  for (std::size_t v = 0; v < c.set.views.size(); ++v) {
    if (c.set.views[v].split == Split::Test) continue;
    const Camera& camera = c.set.views[v].camera;
    const Image<std::uint8_t> mask =
        c.set.source->mask(ViewIndex{static_cast<std::int32_t>(v)}, FrameIndex{0});
    const InMask right = inMask(points, camera, mask);
    EXPECT_GT(right.share, 0.97) << c.set.views[v].name;
    EXPECT_GT(right.seen, points.size() / 4) << c.set.views[v].name;
    worst_turned = std::min(worst_turned, inMask(turned, camera, mask).share);
  }
  EXPECT_LT(worst_turned, 0.9);
}

TEST(CaptureFormats, HalfOfAColmapModelIsNamedWithWhatIsMissing) {
  const TempDir dir;
  putPictures(dir.path());
  putColmap(dir.path(), "a", "b");
  for (const auto& [missing, there] :
       {std::pair{"images", "sparse/0/cameras.txt"}, std::pair{"cameras", "sparse/0/images.txt"}}) {
    const fs::path file = dir.path() / fmt::format("sparse/0/{}.txt", missing), aside = dir / "aside";
    fs::rename(file, aside);
    EXPECT_FALSE(isCapture(dir.path()));
    EXPECT_THAT(errorOf(dir.path()), AllOf(HasSubstr("half of a COLMAP model"), HasSubstr(there),
                                           HasSubstr(fmt::format("{}.bin or {}.txt", missing, missing))));
    fs::rename(aside, file);
  }
  fs::rename(dir / "sparse/0/images.txt", dir / "sparse/0/images.bin");
  EXPECT_THAT(errorOf(dir.path()),
              AllOf(HasSubstr("two COLMAP models"), HasSubstr("cameras.txt"), HasSubstr("images.bin")));
}

}  // namespace
}  // namespace beam
