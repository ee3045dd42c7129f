// SPDX-License-Identifier: Apache-2.0
// The unit and origin of a capture: what its description names, what its subject's height tells.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/io/capture_check.h"
#include "core/io/mesh_ply.h"
#include "tests/core/io/tiny_capture.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(CaptureUnit, SeedPointsFarFromTheOriginKeepTheirDetail) {
  const TempDir folder;
  std::string rows;
  for (int i = 0; i < 10; ++i) rows += fmt::format("500000.{0} 5000000.{0} 1.{0}\n", i);
  put(folder / "far.ply",
      "ply\nformat ascii 1.0\nelement vertex 10\nproperty double x\nproperty double y\n"
      "property double z\nend_header\n" +
          rows);
  const PointCloud points = readPointsPly(folder / "far.ply");
  ASSERT_EQ(points.position_m.size(), 10u);
  for (int i = 0; i < 10; ++i)
    EXPECT_LT(
        glm::distance(points.position(static_cast<std::size_t>(i)), dvec3(500000, 5000000, 1) + 0.1 * i),
        1e-6);
}

TEST(CaptureUnit, HowFarACameraMayMoveGoesByTheDistanceToTheSubjectInEveryUnit) {
  const TempDir dir;
  putPictures(dir.path());
  // Cameras at (0, -3, 0) and (-3, 0, 0) that look at the origin; 4e-4 of 3 is 0.0012.
  const auto movedBy = [&](double moved, double unit) {
    const auto pose = [&](const char* file, const char* turn, double x, double y) {
      return fmt::format(R"({{"file_path": "images/{}.png", "transform_matrix": [{}[0,0,0,1]]}})", file,
                         fmt::format(fmt::runtime(turn), unit * x, unit * y));
    };
    const char *a = "[1,0,0,{}],[0,0,-1,{}],[0,1,0,0],", *b = "[0,0,-1,{}],[-1,0,0,{}],[0,1,0,0],";
    put(dir / "transforms.json",
        fmt::format(R"({{"w": 20, "h": 12, "fl_x": 30, "cx": 9.5, "cy": 6, "frames": [{}, {}, {}]}})",
                    pose("a/000003", a, 0, -3), pose("a/000004", a, moved, -3), pose("b/000003", b, -3, 0)));
  };
  for (const double unit : {0.02, 1.0, 1000.0}) {
    movedBy(0.001, unit);
    EXPECT_NO_THROW(openCapture(dir.path())) << unit;
    movedBy(0.0014, unit);
    EXPECT_THAT(errorOf(dir.path()), AllOf(HasSubstr("\"a\""), HasSubstr("moves"))) << unit;
  }
}

TEST(CaptureUnit, TheUnitThatADescriptionNamesHoldsAndAWordThatIsNoneIsSaid) {
  const TempDir dir;
  putPictures(dir.path());
  put(dir / "dataset.json", kDataset);
  const ImportedCapture metres = openCapture(dir.path());
  EXPECT_EQ(metres.placement.unit_m, 1);
  const auto said = [&](const std::string& unit) {
    put(dir / "dataset.json", replaced(kDataset, "\"up\": \"+Z\"", "\"up\": \"+Z\", \"unit\": " + unit));
    return openCapture(dir.path());
  };
  for (const char* millimetres : {"\"mm\"", "\"millimetre\"", "0.001"}) {
    const ImportedCapture c = said(millimetres);
    EXPECT_EQ(c.placement.unit_m, 0.001);
    EXPECT_EQ(c.placement.from, UnitFrom::Description);
    EXPECT_LT(glm::length(centerOf(c.set.views[0].camera) - 0.001 * centerOf(metres.set.views[0].camera)),
              1e-12);
    EXPECT_EQ(c.set.capture_from_world.scale, 1000);
  }
  EXPECT_EQ(openCapture(dir.path(), {.unit_m = 1}).placement.unit_m, 1) << "what is given goes before";
  EXPECT_EQ(openCapture(dir.path(), {.placement = CapturePlacement{}}).placement, CapturePlacement{});
  EXPECT_THAT(said("\"parsec\"").warnings,
              ::testing::Contains(AllOf(HasSubstr("dataset.json"), HasSubstr("parsec"))));
}

TEST(CaptureUnit, ACaptureInMetresNearItsOriginIsOnlyTurned) {
  const TempDir dir;
  putPictures(dir.path());
  put(dir / "dataset.json", kDataset);
  for (const char* word : {"", ", \"unit\": \"metre\""}) {
    put(dir / "dataset.json", replaced(kDataset, "\"up\": \"+Z\"", std::string("\"up\": \"+Z\"") + word));
    const CaptureSet set = openCapture(dir.path()).set;
    EXPECT_EQ(set.capture_from_world, Similarity3{glm::transpose(worldFromCapture(UpAxis::PlusZ))});
    EXPECT_EQ(set.views[0].camera.camera_from_world.translation_m, dvec3(0.1, 0.9, 3));
  }
}

// A ball of 1.65 m in masks seen from around, in metres times `unit`.
void putBall(const fs::path& folder, double unit, double seeds_unit) {
  std::string cameras;
  PointCloud seeds;
  for (int i = 0; i < 6; ++i) {
    const double phi = i * 1.0471975512, z = 0.5 * (i % 2);
    const dvec3 at(3 * std::cos(phi), 3 * std::sin(phi), 1 + z),
        forward = glm::normalize(dvec3(0, 0, 1) - at);
    const dvec3 right = glm::normalize(glm::cross(forward, dvec3(0, 0, 1))),
                down = glm::cross(forward, right);
    const dvec3 t = -unit * dvec3(glm::dot(right, at), glm::dot(down, at), glm::dot(forward, at));
    cameras += fmt::format(
        R"({}"c{}": {{"width": 60, "height": 60, "fx": 80, "fy": 80, "cx": 30, "cy": 30, "R": [[{},{},{}],[{},{},{}],[{},{},{}]], "t": [{},{},{}]}})",
        i > 0 ? "," : "", i, right.x, right.y, right.z, down.x, down.y, down.z, forward.x, forward.y,
        forward.z, t.x, t.y, t.z);
    Image<std::uint8_t> mask(60, 60);
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) mask(x, y) = std::hypot(x - 29.5, y - 29.5) < 22 ? 255 : 0;
    }
    const std::string place = fmt::format("c{}/0.png", i);
    for (const char* kind : {"images", "masks"})
      fs::create_directories(folder / kind / fmt::format("c{}", i));
    writePng(folder / "images" / place, Image<u8vec3>(60, 60, u8vec3(10, 20, 30)));
    writePng(folder / "masks" / place, mask);
  }
  for (int i = 0; i < 200; ++i) {
    const float z = 1 - (2 * i + 1.0f) / 200, r = std::sqrt(1 - z * z), phi = 2.39996323f * i;
    seeds.position_m.push_back(static_cast<float>(seeds_unit) *
                               (vec3(0, 0, 1) + 0.7f * vec3(r * std::cos(phi), r * std::sin(phi), z)));
  }
  put(folder / "dataset.json", R"({"world": {"up": "+Z"}, "cameras": {)" + cameras + "}}");
  writePointsPly(folder / "points3D.ply", seeds);
}

TEST(CaptureUnit, SaysHowTallTheSubjectIsAndWhatItWasTakenFor) {
  const TempDir dir;
  putBall(dir / "mm", 1000, 1000);
  const CheckReport r = checkPath(dir / "mm");
  EXPECT_NEAR(r.placement.height, 1650, 165);
  EXPECT_EQ(r.placement.unit_m, 0.001);
  EXPECT_THAT(toText(r),
              AllOf(HasSubstr("units tall: taken as millimetres"), HasSubstr("unit: the subject is 1,")));
  EXPECT_THAT(toJson(r), AllOf(HasSubstr("\"unit_m\": 0.001"), HasSubstr("\"from\": \"height\""),
                               HasSubstr("\"height\": 1")));
  EXPECT_THAT(toText(checkPath(dir / "mm", {.unit_m = 0.01})), HasSubstr("centimetres, as --unit says"));
  EXPECT_THAT(r.warnings, ::testing::Not(::testing::Contains(HasSubstr("seed points"))));
  putBall(dir / "m", 1, 1);
  EXPECT_THAT(toText(checkPath(dir / "m")), HasSubstr("taken as metres"));
}

TEST(CaptureUnit, NamesTheFactorAfterWhichSeedPointsFitTheMasks) {
  const TempDir dir;
  putBall(dir / "inches", 1, 1 / 0.0254);
  EXPECT_THAT(checkPath(dir / "inches").warnings,
              ::testing::Contains(AllOf(HasSubstr("200 seed points"), HasSubstr("factor of 0.0254"))));
  putBall(dir / "metres", 1000, 1);
  EXPECT_THAT(checkPath(dir / "metres").warnings, ::testing::Contains(HasSubstr("factor of 1000")));
  putBall(dir / "odd", 1, -1);
  EXPECT_THAT(checkPath(dir / "odd").warnings,
              ::testing::Contains(AllOf(HasSubstr("0 % of 200"), HasSubstr("differ"))));
}

}  // namespace
}  // namespace beam::testing
