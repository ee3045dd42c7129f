// SPDX-License-Identifier: Apache-2.0
// The sample capture: readable by the importer, true to its own ground truth, the same for any number of
// threads.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/io/capture_reader.h"
#include "core/io/file.h"
#include "core/io/image_file.h"
#include "core/io/mesh_ply.h"
#include "core/sample/look.h"
#include "core/sample/make_sample.h"
#include "core/sample/path_tracer.h"
#include "core/sample/sample_descriptions.h"
#include "tests/support/temp_dir.h"

namespace beam {
namespace {

SampleOptions tiny() {
  SampleOptions o;
  o.cameras = 3;
  o.test_cameras = 1;
  o.width = 36;
  o.height = 48;
  o.samples = 4;
  return o;
}

TEST(Sample, OpensWithMasksThatTheTrueMeshProjectsInto) {
  const testing::TempDir dir;
  Progress progress;
  makeSample(dir / "s", tiny(), progress);
  const ImportedCapture c = openCapture(dir / "s");
  EXPECT_EQ(c.layout, "dataset.json");
  ASSERT_EQ(c.set.views.size(), 4u);
  EXPECT_EQ(c.set.up, UpAxis::PlusZ);
  EXPECT_TRUE(c.warnings.empty());
  const Mesh mesh = readMeshPly(dir / "s/gt/mesh/000000.ply");
  const dmat3 world_from_capture = worldFromCapture(UpAxis::PlusZ);
  for (int v = 0; v < 3; ++v) {
    const Camera& camera = c.set.views[v].camera;
    const Image<std::uint8_t> mask = c.set.source->mask(ViewIndex{v}, FrameIndex{0});
    std::size_t in = 0, all = 0;
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 50) {
      const dvec2 p = project(camera.intrinsics,
                              camera.camera_from_world * (world_from_capture * dvec3(mesh.vertices[i])));
      if (p.x < 0 || p.y < 0 || p.x >= camera.width || p.y >= camera.height) continue;
      ++all;
      in += mask(static_cast<int>(p.x), static_cast<int>(p.y)) > 0;
    }
    EXPECT_GT(static_cast<double>(in), 0.97 * static_cast<double>(all)) << v;
  }
  EXPECT_THROW(makeSample(dir / "s", tiny(), progress), Error);
  const Planes ao = readExr(dir / "s/gt/ao/test00/000000.exr", {"Y"});
  float most = 0;
  for (const float v : ao.values) {
    EXPECT_GE(v, 0);
    EXPECT_LE(v, 1);
    most = std::max(most, v);
  }
  EXPECT_GT(most, 0.7f);
}

TEST(Sample, IsTheSameForAnyNumberOfThreads) {
  const testing::TempDir dir;
  Progress a, b;
  SampleOptions moving = tiny();
  moving.frames = 2;
  moving.samples = 2;
  setThreadCount(1);
  makeSample(dir / "1", moving, a);
  setThreadCount(2);
  makeSample(dir / "2", moving, b);
  setThreadCount(0);
  for (const char* file : {"images/cam01/000000.png", "images/cam01/000001.png", "gt/ao/test00/000001.exr",
                           "gt/tracks/000001.ply", "dataset.json", "points3D.ply"}) {
    EXPECT_EQ(readFile(dir / "1" / file, 1 << 24), readFile(dir / "2" / file, 1 << 24)) << file;
  }
}

TEST(Sample, DefectsDoWhatTheySay) {
  const testing::TempDir dir;
  SampleOptions o = tiny();
  o.cameras = 5;
  o.test_cameras = 0;
  o.frames = 7;
  o.samples = 1;
  for (const char* d : {"dropped:cam01", "late:cam02", "blurred:cam03", "black:cam04"})
    o.defects.push_back(parseDefect(d));
  SampleOptions sound = o;
  sound.defects.clear();
  Progress a, b;
  makeSample(dir / "bad", o, a);
  makeSample(dir / "sound", sound, b);
  const auto file = [&](const char* take, int camera, int frame) {
    return dir / take / "images" / ("cam0" + std::to_string(camera)) / (frameName(frame) + ".png");
  };
  const auto bytes = [&](const char* take, int camera, int frame) {
    return readFile(file(take, camera, frame), 1 << 24);
  };
  for (int f = 0; f < o.frames; ++f) {
    EXPECT_EQ(bytes("bad", 0, f), bytes("sound", 0, f)) << f;
    EXPECT_EQ(std::filesystem::exists(file("bad", 1, f)), f % 4 != 2) << f;
    EXPECT_EQ(bytes("bad", 2, f), bytes("sound", 2, std::max(0, f - 3))) << f;
    EXPECT_NE(bytes("bad", 3, f), bytes("sound", 3, f)) << f;
    EXPECT_EQ(bytes("bad", 4, f) == bytes("sound", 4, f), f != 3) << f;
    EXPECT_TRUE(std::filesystem::exists(dir / "bad/gt/tracks" / (frameName(f) + ".ply")));
  }
  for (const u8vec3& p : readPhoto(file("bad", 4, 3)).pixels) EXPECT_EQ(p, u8vec3(0));
  EXPECT_THROW(parseDefect("early"), Error);
  o.defects = {parseDefect("late:cam05")};
  EXPECT_THROW(makeSample(dir / "none", o, a), Error);
}

TEST(SampleDefects, OutOfFocusKeepsLightAndSpreadsIt) {
  Image<vec3> dot(64, 160, vec3(0), Encoding::Linear);
  dot(32, 80) = vec3(1);
  const Image<vec3> blurred = outOfFocus(dot);
  float sum = 0;
  for (const vec3& p : blurred.pixels) sum += p.x;
  EXPECT_NEAR(sum, 1, 1e-4);
  EXPECT_NEAR(blurred(32, 80).x, 1 / (2 * kPi * 4), 2e-3);  // deviation 2 pixels
}

TEST(SamplePathTracer, TheTopOfTheHeadSeesTheWholeUpperSky) {
  const Figure figure(portraitPose());
  const Mesh surface = figure.surface(0.012f);
  const SampleScene scene(figure, surface, dmat3(1.0));
  vec3 top(0);
  for (const vec3& v : surface.vertices) {
    if (v.z > top.z) top = v;
  }
  EXPECT_GT(scene.skyVisibility(top, vec3(0, 0, 1), 256, 1), 0.99f);
}

TEST(SamplePathTracer, AWhiteFurnaceGivesNoEnergyAway) {
  const Figure figure(portraitPose());
  const Mesh surface = figure.surface(0.02f);
  const SampleScene scene(figure, surface, dmat3(1.0));
  const EnvironmentSampler white(makeEnvironment(Image<vec3>(16, 8, vec3(1))));
  Camera c;
  c.width = 24;
  c.height = 32;
  c.intrinsics = {40, 40, 12, 16};
  const dmat3 capture_from_camera(dvec3(1, 0, 0), dvec3(0, 0, -1), dvec3(0, 1, 0));
  c.camera_from_world.rotation = glm::quat_cast(glm::transpose(capture_from_camera));
  c.camera_from_world.translation_m = -(c.camera_from_world.rotation * dvec3(0, -2.6, 0.9));
  TraceSettings s;
  s.samples = 64;
  const SampleScene::Picture p = scene.photograph(c, white, s, Progress());
  double sum = 0, covered = 0;
  for (std::size_t i = 0; i < p.coverage.pixels.size(); ++i)
    sum += p.radiance.pixels[i].x, covered += p.coverage.pixels[i];
  ASSERT_GT(covered, 20);
  EXPECT_LT(sum / covered, 1.0);
  EXPECT_GT(sum / covered, 0.02);
}

}  // namespace
}  // namespace beam
