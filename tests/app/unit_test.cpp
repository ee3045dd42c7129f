// SPDX-License-Identifier: Apache-2.0
// The sample in millimetres: results do not depend on the unit, what goes out is in it again.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/io/file.h"
#include "core/io/image_file.h"
#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

// The sample with every length times 1,000 and no word of its unit.
void putMillimetres(const fs::path& folder) {
  const fs::path& sample = SampleHouse::capture();
  fs::create_directories(folder);
  for (const char* same : {"images", "masks", "environment.exr"})
    fs::create_symlink(sample / same, folder / same);
  nlohmann::json description = nlohmann::json::parse(readTextFile(sample / "dataset.json"));
  description["world"].erase("unit");
  for (auto& [name, camera] : description["cameras"].items()) {
    for (auto& t : camera["t"]) t = 1000 * t.get<double>();
  }
  writeFileAtomically(folder / "dataset.json", description.dump());
  PointCloud seeds = readPointsPly(sample / "points3D.ply");
  for (vec3& p : seeds.position_m) p *= 1000.0f;
  writePointsPly(folder / "points3D.ply", seeds);
}

struct Bounds {
  vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
};
Bounds boundsOf(const std::vector<vec3>& points) {
  Bounds b;
  for (const vec3& p : points) b.low = glm::min(b.low, p), b.high = glm::max(b.high, p);
  return b;
}

// To one in a hundred of the extent.
void expectTimes1000(const Bounds& millimetres, const Bounds& metres) {
  const float near = 0.01f * 1000 * glm::length(metres.high - metres.low);
  EXPECT_LT(glm::length(millimetres.low - 1000.0f * metres.low), near);
  EXPECT_LT(glm::length(millimetres.high - 1000.0f * metres.high), near);
}

float medianDepth(const fs::path& file) {
  std::vector<float> depths = readExr(file, {"Y"}).values;
  std::erase(depths, 0.0f);
  std::nth_element(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2),
                   depths.end());
  return depths.at(depths.size() / 2);
}

double scoreOf(const fs::path& project, const char* map, const char* score = "psnr") {
  const nlohmann::json j = nlohmann::json::parse(readTextFile(project / "evaluation.json"));
  return j.at(map).at(score).get<double>();
}

Said beam(const TempDir& dir, const Words& words) { return Running(dir.path(), words).wait(); }

TEST(Unit, TheSampleInMillimetresGivesTheSameResultsAndGoesOutInMillimetres) {
  const TempDir dir;
  putMillimetres(dir / "mm");
  const std::string truth = SampleHouse::capture().string();
  for (const auto& [name, capture] :
       std::vector<std::pair<std::string, std::string>>{{"m", truth}, {"mm", (dir / "mm").string()}}) {
    const std::string project = (dir / (name + ".beam")).string();
    const Said made = beam(dir, Words{"process", capture, "--out", project, "--frames", "1"} + tinyTake());
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(made.err.find("taken as millimetres (--unit says otherwise)") != std::string::npos,
              name == "mm")
        << made.err;
    const auto out = [&, &n = name](const char* what) { return (dir / ("of_" + n) / what).string(); };
    for (const Words& command :
         {Words{"export", project, "--format", "ply", "--out", out("ply")},
          Words{"render", project, "--channels", "depth,mesh", "--cameras", "cam00", "--out", out("shapes")},
          Words{"render", project, "--channels", "rgb,ao,base_color", "--out", out("pictures")},
          Words{"evaluate", project, "--ground-truth", truth}}) {
      const Said said = beam(dir, command);
      ASSERT_EQ(said.code, 0) << said.err;
    }
  }
  const auto cloud = [&](const char* name) {
    return boundsOf(
        readSplatPly(dir / (std::string("of_") + name) / "ply" / "frame.000001.ply").cloud.position_m);
  };
  expectTimes1000(cloud("mm"), cloud("m"));
  const auto mesh = [&](const char* name) {
    return boundsOf(readMeshPly(dir / (std::string("of_") + name) / "shapes/mesh/000001.ply").vertices);
  };
  expectTimes1000(mesh("mm"), mesh("m"));
  const float metres = medianDepth(dir / "of_m/shapes/depth/cam00/000001.exr");
  EXPECT_NEAR(medianDepth(dir / "of_mm/shapes/depth/cam00/000001.exr") / (1000 * metres), 1, 0.01);
  for (const char* map : {"rgb", "ao", "base_color"})
    EXPECT_NEAR(scoreOf(dir / "mm.beam", map), scoreOf(dir / "m.beam", map), 0.2) << map;
  for (const auto& [map, score] : {std::pair{"mesh", "chamfer_mm"}, std::pair{"depth", "mae_mm"}}) {
    const double metres_say = scoreOf(dir / "m.beam", map, score);
    EXPECT_NEAR(scoreOf(dir / "mm.beam", map, score) / metres_say, 1, 0.05) << map << " " << metres_say;
  }
  EXPECT_THAT(readTextFile(dir / "mm.beam/project.json"), HasSubstr("\"unit_m\": 0.001"));
}

TEST(Unit, CheckSaysHowTallTheSubjectIsAndAWrongUnitIsRefusedBeforeItFillsTheMemory) {
  const TempDir dir;
  putMillimetres(dir / "mm");
  EXPECT_THAT(beam(dir, {"check", (dir / "mm").string()}).out, HasSubstr("units tall: taken as millimetres"));
  EXPECT_THAT(beam(dir, {"check", (dir / "mm").string(), "--unit", "parsec"}).err,
              HasSubstr("--unit expects"));
  const Said said =
      beam(dir, Words{"process", (dir / "mm").string(), "--out", (dir / "P.beam").string(), "--unit", "m"} +
                    tiny());
  EXPECT_EQ(said.code, 10) << said.err;
  EXPECT_THAT(said.err, AllOf(HasSubstr("warning: "), HasSubstr("as --unit says"), HasSubstr("visual hull"),
                              HasSubstr("another unit")));
}

}  // namespace
}  // namespace beam::testing
