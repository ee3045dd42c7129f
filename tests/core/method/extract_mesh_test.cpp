// SPDX-License-Identifier: Apache-2.0
// The mesh of a cloud of known shape: a sphere of flat Gaussians, seen from all sides.
#include "core/method/extract_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/error.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam {
namespace {

using testing::SphereCapture;

const SphereCapture kSphere{.cameras = 16, .size_px = 96};

GaussianCloud sphereCloud() {
  GaussianCloud cloud;
  testing::addSphere(cloud, kSphere.center, kSphere.radius_m, 4000);
  return cloud;
}

std::vector<Camera> camerasAround() {
  std::vector<Camera> cameras;
  for (const FrameView& v : testing::photographs(kSphere)) cameras.push_back(v.camera);
  return cameras;
}

Mesh meshOf(const GaussianCloud& cloud, const std::vector<Camera>& cameras, double voxel_m = 0.02) {
  const auto device = makeCpuDevice();
  Progress progress;
  return extractMesh(cloud, cameras, {.voxel_m = voxel_m}, {}, *device, progress).mesh;
}

const Mesh& sphereMesh() {
  static const Mesh mesh = meshOf(sphereCloud(), camerasAround());
  return mesh;
}

vec3 normalOf(const Mesh& m, const std::array<std::uint32_t, 3>& t) {
  return glm::cross(m.vertices[t[1]] - m.vertices[t[0]], m.vertices[t[2]] - m.vertices[t[0]]);
}

// How often an edge is walked, by its ends in the order of the walk.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> walksOf(const Mesh& m) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> walks;
  for (const auto& t : m.triangles) {
    for (int k = 0; k < 3; ++k) ++walks[{t[k], t[(k + 1) % 3]}];
  }
  return walks;
}

TEST(ExtractMesh, LiesOnTheSphereWithinAVoxel) {
  const Mesh& m = sphereMesh();
  ASSERT_GT(m.vertices.size(), 1000u);
  double mean = 0, worst = 0;
  for (const vec3& v : m.vertices) {
    const double off = std::abs(glm::length(v - kSphere.center) - kSphere.radius_m);
    mean += off / static_cast<double>(m.vertices.size());
    worst = std::max(worst, off);
  }
  EXPECT_LT(mean, 0.1 * 0.02);
  EXPECT_LT(worst, 0.02);
}

TEST(ExtractMesh, OfASphereIsOneClosedSurfaceWithoutAHandle) {
  const Mesh& m = sphereMesh();
  const auto walks = walksOf(m);
  for (const auto& [edge, count] : walks) {
    ASSERT_EQ(count, 1) << "two triangles are wound against each other at " << edge.first;
    ASSERT_TRUE(walks.contains({edge.second, edge.first})) << "a hole at vertex " << edge.first;
  }
  const auto vertices = static_cast<std::int64_t>(m.vertices.size()),
             edges = static_cast<std::int64_t>(walks.size()) / 2,
             triangles = static_cast<std::int64_t>(m.triangles.size());
  EXPECT_EQ(vertices - edges + triangles, 2) << "Euler's number of a sphere";
}

TEST(ExtractMesh, FacesOutwardEverywhere) {
  const Mesh& m = sphereMesh();
  double volume = 0;
  for (const auto& t : m.triangles) {
    const vec3 a = m.vertices[t[0]] - kSphere.center;
    volume += glm::dot(normalOf(m, t), a) / 6.0;
    // A sliver has no direction to speak of.
    if (glm::length(normalOf(m, t)) > 1e-6f) {
      EXPECT_GT(glm::dot(glm::normalize(normalOf(m, t)), glm::normalize(a)), 0);
    }
  }
  EXPECT_NEAR(volume, 4.0 / 3 * kPi * std::pow(kSphere.radius_m, 3), 0.03 * volume);
}

TEST(ExtractMesh, HasFourTimesAsManyTrianglesOfHalfTheVoxel) {
  const Mesh fine = meshOf(sphereCloud(), camerasAround(), 0.01);
  const double ratio =
      static_cast<double>(fine.triangles.size()) / static_cast<double>(sphereMesh().triangles.size());
  EXPECT_NEAR(ratio, 4, 0.5);
}

TEST(ExtractMesh, LeavesOutWhatIsLessThanAHundredthOfTheSubject) {
  GaussianCloud cloud = sphereCloud();
  const vec3 aside = kSphere.center + vec3(0.45f, 0, 0);
  testing::addSphere(cloud, aside, 0.02f, 100);
  for (const vec3& v : meshOf(cloud, camerasAround()).vertices) EXPECT_GT(glm::distance(v, aside), 0.1f);
}

TEST(ExtractMesh, OfNothingOrSeenByNobodyIsEmpty) {
  EXPECT_TRUE(meshOf({}, camerasAround()).triangles.empty());
  EXPECT_TRUE(meshOf({}, camerasAround()).vertices.empty());
  EXPECT_TRUE(meshOf(sphereCloud(), {}).triangles.empty());
}

TEST(ExtractMesh, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  Progress progress(stop.get_token());
  const auto device = makeCpuDevice();
  EXPECT_THROW(extractMesh(sphereCloud(), camerasAround(), {}, {}, *device, progress), Cancelled);
}

}  // namespace
}  // namespace beam
