// SPDX-License-Identifier: Apache-2.0
// Meshes and the ground as rays meet them: places, normals, textures, and what is refused.
#include "core/render/mesh_surfaces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/math/brdf.h"
#include "core/math/sampling.h"
#include "core/render/scene_surfaces.h"
#include "tests/support/mesh_shapes.h"
#include "tests/support/message_of.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;

constexpr float kFar = PathSurfaces::kFar_m;
const vec3 kDown(0, -1, 0);

void expectNear(vec3 found, vec3 expected, float most) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], most) << c;
}

Mesh level(float height_m, float half = 1) {
  return rectangle(vec3(0, height_m, 0), vec3(0, 0, half), vec3(half, 0, 0));
}

TEST(TriangleTracer, MeetsTheNearestTriangleOfAllMeshes) {
  const std::vector<Mesh> meshes = {level(0), {}, level(1, 0.5f)};
  const TriangleTracer tracer(meshes);
  const auto hit = tracer.nearest(vec3(0.2f, 3, 0.1f), kDown, kFar);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->mesh, 2u);
  EXPECT_FLOAT_EQ(hit->distance_m, 2);
  expectNear(hit->normal, vec3(0, 1, 0), 1e-6f);
  EXPECT_EQ(tracer.nearest(vec3(0.8f, 3, 0), kDown, kFar)->mesh, 0u);
  EXPECT_FALSE(tracer.nearest(vec3(0, 3, 0), kDown, 1.9f)) << "out of reach";
  EXPECT_FALSE(tracer.occluded(vec3(0, 3, 0), kDown, 1.9f));
  EXPECT_TRUE(tracer.occluded(vec3(0, 3, 0), kDown, 2.1f));
  EXPECT_FALSE(tracer.occluded(vec3(2, 3, 0), kDown, kFar));
  EXPECT_GT(tracer.memoryBytes(), 0u);
}

TEST(TriangleTracer, OfNothingMeetsNothing) {
  EXPECT_FALSE(TriangleTracer({}).nearest(vec3(0), kDown, kFar));
  const Mesh empty;
  EXPECT_FALSE(TriangleTracer({&empty, 1}).occluded(vec3(0), kDown, kFar));
}

TEST(TriangleTracer, MeetsAMovedMeshWhereItIs) {
  const std::vector<Mesh> meshes = {level(0), level(1)};
  TriangleTracer tracer(meshes);
  tracer.move(1, level(2, 0.5f).vertices);
  EXPECT_FLOAT_EQ(tracer.nearest(vec3(0.2f, 3, 0.1f), kDown, kFar)->distance_m, 1);
  EXPECT_FLOAT_EQ(tracer.nearest(vec3(0.8f, 3, 0.1f), kDown, kFar)->distance_m, 3);
}

TEST(TriangleTracer, RefusesBrokenTriangles) {
  std::vector<Mesh> meshes = {level(0), level(1)};
  meshes[1].triangles[1][2] = 4;
  EXPECT_THAT(dataErrorOf([&] { TriangleTracer t(meshes); }),
              HasSubstr("mesh 1: triangle 1 has the corner 4, expected less than its 4 vertices"));
  meshes[1] = level(1);
  meshes[1].vertices[3].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(dataErrorOf([&] { TriangleTracer t(meshes); }), HasSubstr("mesh 1: vertex 3 is not finite"));
}

TEST(MeshSurfaces, RefuseNormalsAndUvThatAreNotOfTheirVertices) {
  Mesh mesh = level(0);
  mesh.normals.assign(3, vec3(0, 1, 0));
  EXPECT_THAT(dataErrorOf([&] { MeshSurfaces({meshOf(mesh, vec3(0.5f))}, {}); }),
              HasSubstr("mesh 0: 3 normals of 4 vertices"));
  mesh.normals.clear();
  mesh.uv[2].x = std::numeric_limits<float>::infinity();
  EXPECT_THAT(dataErrorOf([&] { MeshSurfaces({meshOf(mesh, vec3(0.5f))}, {}); }),
              HasSubstr("mesh 0: uv of vertex 2 are not finite"));
}

TEST(MeshSurfaces, TheGroundIsMetFromBothSidesAndBehindWhatStandsOnIt) {
  const MeshSurfaces surfaces({meshOf(level(0.5f), vec3(0.2f))},
                              {.enabled = true, .height_m = 0.25, .base_color = dvec3(0.7)});
  const auto above = surfaces.nearest(vec3(3, 2.25f, 0), kDown, kFar);
  ASSERT_TRUE(above);
  EXPECT_EQ(above->position_m.y, 0.25f);
  EXPECT_EQ(above->distance_m, 2);
  EXPECT_EQ(above->normal, vec3(0, 1, 0));
  EXPECT_FLOAT_EQ(above->base_color.x, 0.7f);
  EXPECT_FLOAT_EQ(above->roughness, 0.8f);
  EXPECT_GT(above->step_m.y, 0);
  const auto below = surfaces.nearest(vec3(3, -1, 0), -kDown, kFar);
  EXPECT_EQ(below->normal, vec3(0, -1, 0));
  EXPECT_LT(below->step_m.y, 0);
  EXPECT_FLOAT_EQ(surfaces.nearest(vec3(0, 2, 0), kDown, kFar)->base_color.x, 0.2f);
  EXPECT_FLOAT_EQ(surfaces.nearest(vec3(0, 0.4f, 0), kDown, kFar)->base_color.x, 0.7f);
  EXPECT_FALSE(surfaces.nearest(vec3(0, 2, 0), vec3(1, 0, 0), kFar)) << "level rays never meet it";
  EXPECT_FALSE(surfaces.nearest(vec3(3, 2.25f, 0), kDown, 1.9f));
  EXPECT_EQ(surfaces.distance(vec3(3, 2.25f, 0), kDown, 1.9f), 1.9f);
  EXPECT_EQ(surfaces.distance(vec3(3, 2.25f, 0), kDown, kFar), 2);
  EXPECT_TRUE(surfaces.occluded(vec3(3, 2.25f, 0), kDown, kFar));
}

TEST(MeshSurfaces, FromNoPlaceOfATriangleAPathMeetsItAgain) {
  for (const float scale : {0.02f, 1.0f, 300.0f}) {
    Mesh mesh = icosphere(vec3(scale * 3), scale, 2);
    mesh.normals.clear();
    const MeshSurfaces surfaces({meshOf(mesh, vec3(0.5f))}, {});
    int met = 0;
    for (std::uint64_t i = 0; i < 4000; ++i) {
      const RandomStream random(7, i);
      const vec3 d = Frame3(vec3(0, 1, 0)).toWorld(cosineDirection({random.uniform(0), random.uniform(1)})) *
                     (i % 2 ? 1.0f : -1.0f);
      const vec3 from = vec3(scale * 3) +
                        0.3f * scale * (2.0f * vec3(random.uniform(2), random.uniform(3), 0) - 1.0f) -
                        2 * scale * d;
      const auto hit = surfaces.nearest(from, d, kFar);
      if (!hit) continue;
      ++met;
      // Against the light that grazes it most: it is convex, and nothing is in the way.
      const Frame3 frame(hit->normal);
      const vec3 grazing = glm::normalize(frame.tangent + 1e-3f * hit->normal);
      EXPECT_FALSE(surfaces.occluded(hit->position_m + hit->step_m, grazing, kFar)) << scale;
      EXPECT_TRUE(surfaces.occluded(hit->position_m + hit->step_m, d, kFar)) << "and never through it";
      EXPECT_LT(glm::length(hit->step_m), 1e-4f * std::max(scale, 0.1f));
    }
    EXPECT_GT(met, 3000);
  }
}

TEST(MeshSurfaces, NormalsLieBetweenThoseOfTheCornersAndAreNeverSeenFromBehind) {
  Mesh mesh = level(0);
  mesh.normals = {glm::normalize(vec3(0, 1, -1)), glm::normalize(vec3(0, 1, 1)),
                  glm::normalize(vec3(0, 1, 1)), glm::normalize(vec3(0, 1, -1))};
  const MeshSurfaces surfaces({meshOf(mesh, vec3(0.5f))}, {});
  expectNear(surfaces.nearest(vec3(0, 1, 0), kDown, kFar)->normal, vec3(0, 1, 0), 1e-5f);
  expectNear(surfaces.nearest(vec3(0, 1, 0.5f), kDown, kFar)->normal, glm::normalize(vec3(0, 2, 1)), 1e-5f);
  expectNear(surfaces.nearest(vec3(0, -1, 0.5f), -kDown, kFar)->normal, -glm::normalize(vec3(0, 2, 1)),
             1e-5f);
  const vec3 flat = glm::normalize(vec3(0, -0.1f, 1));  // sees the far corners' normals from behind
  const auto hit = surfaces.nearest(vec3(0, 0.1f, -0.1f), flat, kFar);
  ASSERT_TRUE(hit);
  EXPECT_GT(glm::dot(hit->normal, -flat), 0);
  EXPECT_NEAR(glm::length(hit->normal), 1, 1e-5f);
}

TEST(MeshSurfaces, ScaledAndTurnedMeshesKeepTheirNormalsUnitAndSquare) {
  Mesh mesh = level(0);
  mesh.normals.assign(4, vec3(0, 1, 0));
  RenderMesh there = meshOf(mesh, vec3(0.5f));
  there.world_from_mesh = {.rotation = dmat3(glm::mat3_cast(glm::angleAxis(kPi / 2, vec3(0, 0, 1)))),
                           .scale = 0.25,
                           .translation = dvec3(1, 2, 3)};
  const MeshSurfaces surfaces({there}, {});
  const auto hit = surfaces.nearest(vec3(5, 2.2f, 3.2f), vec3(-1, 0, 0), kFar);
  ASSERT_TRUE(hit);
  expectNear(hit->position_m, vec3(1, 2.2f, 3.2f), 1e-5f);
  expectNear(hit->normal, vec3(1, 0, 0), 1e-5f);
  EXPECT_FALSE(surfaces.nearest(vec3(5, 2.3f, 3), vec3(-1, 0, 0), kFar)) << "half of it is 0.25 m wide";
}

TEST(MeshSurfaces, TexturesAreBilinearAndRepeat) {
  MeshTextures textures{Image<vec3>(2, 1, vec3(0), Encoding::Linear), Image<float>(1, 2)};
  textures.base_color.pixels = {vec3(0.2f, 0, 0), vec3(0.6f, 2, 0)};
  textures.roughness.pixels = {0.01f, 0.5f};
  Mesh mesh = rectangle(vec3(0.5f, 0, 0.5f), vec3(0.5f, 0, 0), vec3(0, 0, 0.5f));  // u = x, v = z
  for (vec2& uv : mesh.uv) uv += vec2(3, -2);
  RenderMesh m = meshOf(mesh, vec3(0.9f));
  m.textures = std::make_shared<const MeshTextures>(textures);
  const MeshSurfaces surfaces({m}, {});
  const auto at = [&](float u, float v) { return *surfaces.nearest(vec3(u, 1, v), kDown, kFar); };
  expectNear(at(0.25f, 0.25f).base_color, vec3(0.2f, 0, 0), 1e-5f);
  expectNear(at(0.75f, 0.25f).base_color, vec3(0.6f, 1, 0), 1e-5f);
  expectNear(at(0.375f, 0.25f).base_color, vec3(0.3f, 0.5f, 0), 1e-5f);
  expectNear(at(0.125f, 0.75f).base_color, at(0.375f, 0.75f).base_color, 1e-5f);
  EXPECT_NEAR(at(0.3f, 0.75f).roughness, 0.5f, 1e-5f);
  EXPECT_EQ(at(0.3f, 0.25f).roughness, kLeastRoughness);
  RenderMesh plain = meshOf(level(0), vec3(0.9f), 0.3f);
  plain.textures = std::make_shared<const MeshTextures>();
  const auto hit = MeshSurfaces({plain}, {}).nearest(vec3(0, 1, 0), kDown, kFar);
  EXPECT_EQ(hit->base_color, vec3(0.9f));
  EXPECT_EQ(hit->roughness, 0.3f);
}

TEST(SceneSurfaces, APathThatLeavesGaussiansBeginsBeforeTheMeshTheyTouch) {
  const MeshSurfaces meshes({}, {.enabled = true, .height_m = 0});
  const SceneSurfaces surfaces(nullptr, meshes, 0.02f);
  PathHit hit{.position_m = vec3(0, 0.01f, 0), .normal = vec3(0, 1, 0)};
  EXPECT_EQ(surfaces.besideMeshes(hit, vec3(0, 1, 0)).step_m, vec3(0)) << "away from the ground";
  const vec3 step_m = surfaces.besideMeshes(hit, vec3(0, -1, 0)).step_m;
  EXPECT_LT(step_m.y, 0);
  EXPECT_GT(step_m.y, -0.01f);
  hit.position_m.y = 0.03f;
  EXPECT_EQ(surfaces.besideMeshes(hit, vec3(0, -1, 0)).step_m, vec3(0)) << "it is far enough";
}

}  // namespace
}  // namespace beam::testing
