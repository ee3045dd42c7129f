// SPDX-License-Identifier: Apache-2.0
// How large a mesh may become: bounds of a scene, limits of voxels and rows, slabs, threads, stops.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/method/extract_mesh.h"
#include "core/method/mesh_bounds.h"
#include "core/method/voxel_blocks.h"
#include "tests/core/method/reference_fusion.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam {
namespace {

using testing::SphereCapture;

const SphereCapture kSphere{.cameras = 16, .size_px = 96};

std::vector<Camera> camerasAround() {
  std::vector<Camera> cameras;
  for (int i = 0; i < kSphere.cameras; ++i) cameras.push_back(testing::viewOf(kSphere, i).camera);
  return cameras;
}

GaussianCloud sphereCloud() {
  GaussianCloud cloud;
  testing::addSphere(cloud, kSphere.center, kSphere.radius_m, 4000);
  return cloud;
}

// The sphere, walls of a hall of 60 m around it, and crumbs behind the cameras.
GaussianCloud sphereInAHall() {
  GaussianCloud cloud = sphereCloud();
  const vec3 up(0, 30, 0), along(30, 0, 0), across(0, 0, 30);
  for (const float side : {-1.0f, 1.0f}) {
    testing::addRectangle(cloud, side * along, up, across, 1.5f);
    testing::addRectangle(cloud, side * across, along, up, 1.5f);
    testing::addRectangle(cloud, side * up, across, along, 1.5f);
    testing::addSphere(cloud, side * vec3(300, 40, -90), 20, 200);
    testing::addSphere(cloud, side * vec3(3.5f, 1, 3), 0.1f, 100);
  }
  return cloud;
}

ExtractedMesh meshOf(const GaussianCloud& cloud, const ExtractMeshOptions& options, const MeshScope& scope,
                     Progress::Listener listener = {}, std::stop_token stop = {}) {
  const auto device = makeCpuDevice();
  Progress progress(std::move(stop), std::move(listener));
  return extractMesh(cloud, camerasAround(), options, scope, *device, progress);
}

double farthestFromTheSphere(const Mesh& m) {
  double worst = 0;
  for (const vec3& v : m.vertices)
    worst = std::max(worst, std::abs(double(glm::distance(v, kSphere.center)) - kSphere.radius_m));
  return worst;
}

// Depth of the sphere in closed form, with a weight that differs from pixel to pixel.
std::vector<DepthView> depthOfTheSphere() {
  std::vector<DepthView> views;
  for (const Camera& camera : camerasAround()) {
    DepthView d{camera, Planes(camera.width, camera.height, 1), Planes(camera.width, camera.height, 1)};
    const Rigid3 world_from_camera = inverse(camera.camera_from_world);
    const dvec3 o = world_from_camera.translation_m - dvec3(kSphere.center);
    for (int p = 0; p < camera.width * camera.height; ++p) {
      const dvec3 ray = rayOf(camera.intrinsics, {p % camera.width + 0.5, p / camera.width + 0.5});
      const dvec3 r = world_from_camera.rotation * ray;
      const double a = glm::dot(r, r), b = glm::dot(o, r),
                   c = glm::dot(o, o) - kSphere.radius_m * kSphere.radius_m;
      if (b * b < a * c) continue;
      d.depth.values[p] = static_cast<float>((-b - std::sqrt(b * b - a * c)) / a);
      d.weight.values[p] = 0.25f + static_cast<float>(p % 7);
    }
    views.push_back(std::move(d));
  }
  return views;
}

Mesh fused(std::span<const DepthView> views, const TsdfOptions& o) {
  Progress progress;
  const auto blocks = touchedBlocks(views, o, 1u << 20, 1, progress);
  return keepLargeComponents(*fuseDepth(views, o, *blocks, 1u << 24, progress), 0.01, progress);
}

TEST(Fusion, IsToTheBitWhatEveryVoxelAskingEveryViewGives) {
  std::vector<DepthView> views = depthOfTheSphere();
  views.resize(8);
  const TsdfOptions o{.voxel_m = 0.0041f, .truncation_m = 0.0164f};
  Progress progress;
  const auto blocks = touchedBlocks(views, o, 1u << 20, 1, progress);
  ASSERT_GT(blocks->size(), 2500u) << "one slab holds them all: nothing is said about their joints";
  const Mesh mesh = fused(views, o);
  const Mesh simple = keepLargeComponents(testing::ReferenceFusion(views, o).mesh(), 0.01, progress);
  ASSERT_GT(mesh.triangles.size(), 50000u);
  EXPECT_TRUE(mesh.vertices == simple.vertices);
  EXPECT_TRUE(mesh.triangles == simple.triangles);
}

TEST(Fusion, IsTheSameForAnyNumberOfThreads) {
  const ExtractMeshOptions options{.voxel_m = 0.01, .most_voxels = 1 << 20};
  std::vector<ExtractedMesh> made;
  for (const int threads : {1, 3}) {
    setThreadCount(threads);
    made.push_back(meshOf(sphereInAHall(), options, {.scene = true}));
  }
  setThreadCount(0);
  EXPECT_EQ(made[0].voxel_m, made[1].voxel_m);
  EXPECT_TRUE(made[0].mesh.vertices == made[1].mesh.vertices);
  EXPECT_TRUE(made[0].mesh.triangles == made[1].mesh.triangles);
}

TEST(Fusion, TouchesNoMoreBlocksThanItMay) {
  const std::vector<DepthView> views = depthOfTheSphere();
  const TsdfOptions o{.voxel_m = 0.02f, .truncation_m = 0.08f};
  Progress progress;
  const std::size_t count = touchedBlocks(views, o, 1u << 20, 1, progress)->size();
  EXPECT_EQ(touchedBlocks(views, o, count, 1, progress)->size(), count);
  EXPECT_FALSE(touchedBlocks(views, o, count - 1, 1, progress));
  const std::size_t glance = touchedBlocks(views, o, 1u << 20, 4, progress)->size();
  EXPECT_LE(glance, count);
  EXPECT_GT(glance, count / 2);
}

TEST(Fusion, LeavesOutDepthsThatNoBlockLiesAt) {
  Progress progress;
  for (const float depth : {3e30f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    std::vector<DepthView> far = {depthOfTheSphere().front()};
    std::fill(far[0].depth.values.begin(), far[0].depth.values.end(), depth);
    EXPECT_TRUE(touchedBlocks(far, {}, 1u << 20, 1, progress)->empty()) << depth;
  }
}

TEST(MeshOfAScene, IsBoundedByWhatTheCamerasLookAt) {
  const ExtractedMesh hall = meshOf(sphereInAHall(), {.voxel_m = 0.04}, {.scene = true}),
                      alone = meshOf(sphereCloud(), {.voxel_m = hall.voxel_m}, {});
  EXPECT_FALSE(hall.reached);
  EXPECT_LT(farthestFromTheSphere(hall.mesh), 0.05);
  EXPECT_NEAR(static_cast<double>(hall.mesh.triangles.size()),
              static_cast<double>(alone.mesh.triangles.size()), 0.02 * alone.mesh.triangles.size());
}

TEST(MeshOfAScene, HasBoundsThatHoldTheSubjectWithLittleAround) {
  const std::vector<DepthView> views = depthOfTheSphere();
  const FusionBounds bounds = boundsFromCameras(views, Progress());
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(bounds.low[axis], kSphere.center[axis] - kSphere.radius_m);
    EXPECT_GT(bounds.high[axis], kSphere.center[axis] + kSphere.radius_m);
    EXPECT_LT(bounds.high[axis] - bounds.low[axis], 2.5 * kSphere.radius_m);
  }
}

TEST(MeshOfAScene, HasBoundsWhereNoPointTellsWhatIsLookedAtOrNothingIsThere) {
  DepthView one = depthOfTheSphere().front();
  const std::vector<DepthView> parallel(3, one);
  const FusionBounds bounds = boundsFromCameras(parallel, Progress());
  EXPECT_LT(glm::distance(0.5 * (bounds.low + bounds.high), dvec3(kSphere.center)), kSphere.radius_m);
  EXPECT_TRUE(boundsFromCameras({}, Progress()).contains(dvec3(1e9)));
  EXPECT_TRUE(meshOf({}, {}, {.scene = true}).mesh.triangles.empty());
}

TEST(MeshOfAScene, IsTheSameInAnyUnit) {
  const ExtractedMesh metres = meshOf(sphereCloud(), {.voxel_m = 0.03}, {.scene = true});
  GaussianCloud cloud = sphereCloud();
  std::vector<Camera> cameras = camerasAround();
  for (vec3& x : cloud.position_m) x *= 1024.0f;
  for (vec3& s : cloud.scale_m) s *= 1024.0f;
  for (Camera& c : cameras) c.camera_from_world.translation_m *= 1024;
  const auto device = makeCpuDevice();
  Progress progress;
  const ExtractedMesh made =
      extractMesh(cloud, cameras, {.voxel_m = 0.03}, {.scene = true}, *device, progress);
  EXPECT_NEAR(made.voxel_m, 1024 * metres.voxel_m, 1e-3 * made.voxel_m);
  EXPECT_NEAR(static_cast<double>(made.mesh.triangles.size()),
              static_cast<double>(metres.mesh.triangles.size()), 0.01 * metres.mesh.triangles.size());
  for (const vec3& v : made.mesh.vertices)
    ASSERT_NEAR(glm::distance(v / 1024.0f, kSphere.center), kSphere.radius_m, metres.voxel_m);
}

TEST(MeshOfAScene, HasVoxelsInProportionToWhatTheCamerasLookAt) {
  // 0.6 m of sphere and a margin, where the setting speaks of a person's 1.75 m.
  const ExtractedMesh made = meshOf(sphereInAHall(), {.voxel_m = 0.03}, {.scene = true});
  EXPECT_EQ(made.voxel_m, made.asked_m);
  EXPECT_GT(made.voxel_m, 0.03 * 0.6 / 1.75);
  EXPECT_LT(made.voxel_m, 0.03 * 0.75 / 1.75);
}

TEST(MeshLimits, CoarsenVoxelsAndSayWhichLimitItWas) {
  const ExtractMeshOptions asked{.voxel_m = 0.002, .most_voxels = kLeastVoxels};
  const ExtractedMesh made = meshOf(sphereCloud(), asked, {});
  EXPECT_EQ(made.reached, MeshLimit::Voxels);
  EXPECT_GT(made.voxel_m, asked.voxel_m);
  EXPECT_LT(farthestFromTheSphere(made.mesh), made.voxel_m);
  // What is used is what may be asked for.
  const ExtractedMesh again =
      meshOf(sphereCloud(), {.voxel_m = made.voxel_m, .most_voxels = kLeastVoxels}, {});
  EXPECT_FALSE(again.reached);
  EXPECT_TRUE(again.mesh.vertices == made.mesh.vertices);
}

TEST(MeshLimits, HoldTheRowsOfAFile) {
  const ExtractedMesh free = meshOf(sphereCloud(), {.voxel_m = 0.01}, {});
  EXPECT_FALSE(free.reached);
  const std::size_t rows = std::max(free.mesh.triangles.size(), free.mesh.vertices.size());
  const ExtractedMesh just = meshOf(sphereCloud(), {.voxel_m = 0.01}, {.most_rows = rows}),
                      made = meshOf(sphereCloud(), {.voxel_m = 0.01}, {.most_rows = rows - 1});
  EXPECT_FALSE(just.reached);
  EXPECT_TRUE(just.mesh.triangles == free.mesh.triangles);
  EXPECT_EQ(made.reached, MeshLimit::Rows);
  EXPECT_LT(made.mesh.triangles.size(), rows);
  EXPECT_GT(made.mesh.triangles.size(), rows / 3);
}

TEST(MeshLimits, LeaveASubjectOfMasksAloneUnlessTheyAreAskedFor) {
  EXPECT_EQ(mostVoxels({}, {}), kMostVoxels);
  EXPECT_EQ(mostVoxels({}, {.scene = true}), kSceneVoxels);
  EXPECT_EQ(mostVoxels({.most_voxels = 1 << 20}, {}), 1 << 20);
  EXPECT_EQ(mostVoxels({.most_voxels = 1}, {.scene = true}), kLeastVoxels);
}

TEST(ExtractMeshProgress, StopsInEachOfItsParts) {
  std::vector<std::string> labels;
  meshOf(sphereCloud(), {.voxel_m = 0.004}, {}, [&](const ProgressReport& r) {
    if (labels.empty() || labels.back() != r.label) labels.push_back(r.label);
  });
  ASSERT_GE(labels.size(), 2u);
  for (const std::string& label : labels) {
    std::stop_source stop;
    const auto stopThere = [&](const ProgressReport& r) {
      if (r.label == label) stop.request_stop();
    };
    EXPECT_THROW(meshOf(sphereCloud(), {.voxel_m = 0.004}, {}, stopThere, stop.get_token()), Cancelled)
        << label;
  }
}

TEST(ExtractMeshProgress, RisesToTheEndAndCountsBlocks) {
  double last = 0;
  std::int64_t most = 0;
  meshOf(sphereCloud(), {.voxel_m = 0.004}, {}, [&](const ProgressReport& r) {
    EXPECT_GE(r.fraction, last);
    last = r.fraction;
    most = std::max(most, r.total);
  });
  EXPECT_DOUBLE_EQ(last, 1);
  EXPECT_GT(most, 2048) << "blocks of several slabs";
}

}  // namespace
}  // namespace beam
