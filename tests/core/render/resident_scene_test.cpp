// SPDX-License-Identifier: Apache-2.0
// Gaussians that stay on the device: the same pictures as from buffers packed for each, whatever was there
// before, and nothing packed twice.
#include "core/render/resident_scene.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/rng.h"
#include "core/render/device.h"
#include "tests/support/splat_shapes.h"

namespace beam::testing {
namespace {

Camera cameraAt(dvec3 position, int width = 60, int height = 50) {
  Camera c{{60, 60, width / 2.0, height / 2.0}, width, height, {}};
  c.camera_from_world.translation_m = -position;
  return c;
}
const Camera kCamera = cameraAt(dvec3(0.1, 0.05, -2));

RenderInstance ball(vec3 center, int count, std::uint64_t stream) {
  auto cloud = std::make_shared<GaussianCloud>();
  addSphere(*cloud, center, 0.4f, count);
  fillRandom(cloud->color.coefficients, stream, 0.1f);
  return {.cloud = cloud,
          .materials = randomMaterials(cloud->size(), stream + 1, 0.1f, 0.3f),
          .attributes = nullptr};
}

const std::vector<std::string> kMaterials = {kBaseColorName, kOcclusionName, kRoughnessName};

class Resident : public ::testing::Test {
 protected:
  RasterImages draw(const ResidentScene& scene, const Camera& camera,
                    const std::vector<std::string>& extra = kMaterials, int channels = 5) {
    RasterImages images;
    device
        ->newRasterizer(
            {.width = camera.width, .height = camera.height, .geometry = true, .extra_channels = channels})
        ->forward(scene, extra, camera, vec3(0.2f), images);
    return images;
  }
  RasterImages drawAnew(const std::vector<RenderInstance>& instances, const Camera& camera = kCamera) {
    const auto scene = device->newResidentScene();
    scene->load(instances);
    return draw(*scene, camera);
  }
  static void expectSame(const RasterImages& a, const RasterImages& b) {
    EXPECT_TRUE(a.color.values == b.color.values);
    EXPECT_TRUE(a.alpha.values == b.alpha.values);
    EXPECT_TRUE(a.median_depth.values == b.median_depth.values);
    EXPECT_TRUE(a.normal.values == b.normal.values);
    EXPECT_TRUE(a.extra.values == b.extra.values);
  }
  std::unique_ptr<ComputeDevice> device = makeCpuDevice();
};

TEST_F(Resident, GaussiansAreDrawnAsThoseOfBuffersAreToTheBit) {
  const RenderInstance instance = ball(vec3(0), 300, 1);
  const GaussianCloud& cloud = *instance.cloud;
  GaussianBuffers buffers = toBuffers(cloud, 5);
  const vec3 eye(centerOf(kCamera));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto basis = shBasis(glm::normalize(cloud.position_m[i] - eye));
    for (int c = 0; c < 5; ++c) {
      float value = c == 4 ? instance.materials->roughness[i] : 0.5f;
      for (int k = 0; k < kShCount && c < 4; ++k) {
        value += basis[k] * (c < 3 ? instance.materials->base_color.of(i)[k * 3 + c]
                                   : instance.materials->ambient_occlusion.of(i)[k]);
      }
      buffers.plane(PlaneLayout::kExtra + c)[i] = value;
    }
  }
  RasterImages expected;
  device
      ->newRasterizer(
          {.width = kCamera.width, .height = kCamera.height, .geometry = true, .extra_channels = 5})
      ->forward(buffers, kCamera, 3, vec3(0.2f), expected);
  const RasterImages found = drawAnew({instance});
  EXPECT_TRUE(found.color.values == expected.color.values);
  EXPECT_TRUE(found.normal.values == expected.normal.values);
  for (std::size_t i = 0; i < expected.extra.values.size(); ++i)
    ASSERT_NEAR(found.extra.values[i], expected.extra.values[i], 2e-6f) << "normalised by another division";
}

TEST_F(Resident, WhatStaysIsNotPackedAgainAndLooksAsPackedAnew) {
  const RenderInstance a = ball(vec3(-0.3f, 0, 0), 100, 1), b = ball(vec3(0.3f, 0, 0), 150, 4),
                       c = ball(vec3(0, 0.3f, 0.2f), 100, 7), d = ball(vec3(0, -0.3f, 0.2f), 40, 9);
  const auto scene = device->newResidentScene();
  struct Step {
    std::vector<RenderInstance> instances;
    std::size_t packed;
  };
  const std::vector<Step> steps = {{{a, b}, 250},       {{a, b}, 0},     {{c, b}, 100},
                                   {{b, c}, 0},         {{b, c, d}, 40}, {{d, b}, 0},
                                   {{a, d, b, b}, 250}, {{}, 0},         {{b}, 150}};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    scene->load(steps[i].instances);
    EXPECT_EQ(scene->packed(), steps[i].packed) << i;
    if (!steps[i].instances.empty()) expectSame(draw(*scene, kCamera), drawAnew(steps[i].instances));
  }
}

TEST_F(Resident, AnInstanceSomewhereElseIsSeenAsByACameraThatWentTheOtherWay) {
  RenderInstance moved = ball(vec3(0), 400, 2);
  const RasterImages still = drawAnew({moved});
  const dmat3 turn = glm::mat3_cast(glm::normalize(dquat(0.8, 0.1, 0.5, -0.2)));
  moved.world_from_cloud = {turn, 1, dvec3(3, -2, 1)};
  Camera camera = kCamera;
  camera.camera_from_world =
      kCamera.camera_from_world * inverse(Rigid3{glm::quat_cast(turn), moved.world_from_cloud.translation});
  const RasterImages there = drawAnew({moved}, camera);
  double worst = 0;
  for (std::size_t i = 0; i < still.color.values.size(); ++i)
    worst = std::max(worst, std::abs(double(still.color.values[i]) - there.color.values[i]));
  for (std::size_t i = 0; i < still.extra.values.size(); ++i)
    worst = std::max(worst, std::abs(double(still.extra.values[i]) - there.extra.values[i]));
  EXPECT_LT(worst, 2e-3) << "single precision far from the origin";
}

TEST_F(Resident, DrawsUpTo32ExtraChannelsEachAsIfAlone) {
  RenderInstance instance = ball(vec3(0), 200, 3);
  auto attributes = std::make_shared<std::vector<Attribute>>();
  std::vector<std::string> names;
  for (int i = 0; i < 32; ++i) {
    Attribute a;
    a.info.name = "channel_" + std::to_string(i);
    a.values.resize(200);
    fillRandom(a.values, static_cast<std::uint64_t>(i), 1);
    names.push_back(a.info.name);
    attributes->push_back(std::move(a));
  }
  instance.attributes = attributes;
  const auto scene = device->newResidentScene();
  scene->load({instance});
  const RasterImages all = draw(*scene, kCamera, names, 32);
  const RasterImages visibility = draw(*scene, kCamera, {names.begin(), names.begin() + 21}, 21);
  for (const int i : {0, 7, 8, 20, 31}) {
    const RasterImages alone = draw(*scene, kCamera, {names[static_cast<std::size_t>(i)]}, 1);
    const auto same = [&](const Planes& p) {
      return std::equal(alone.extra.values.begin(), alone.extra.values.end(), p.plane(i));
    };
    EXPECT_TRUE(same(all.extra)) << i;
    EXPECT_TRUE(i >= 21 || same(visibility.extra)) << i;
  }
  EXPECT_THROW(device->newRasterizer({.width = 8, .height = 8, .extra_channels = 33}), Error);
  EXPECT_THROW(device->newRasterizer({.width = 8, .height = 8, .extra_channels = 17, .gradients = true}),
               Error);
}

TEST_F(Resident, HoldsWhatEveryInstanceHas) {
  const RenderInstance whole = ball(vec3(0), 50, 1);
  RenderInstance bare = ball(vec3(1, 0, 0), 50, 2);
  bare.materials = nullptr;
  const auto scene = device->newResidentScene();
  scene->load({whole, whole});
  EXPECT_TRUE(scene->has(kBaseColorName));
  scene->load({whole, bare});
  EXPECT_FALSE(scene->has(kBaseColorName));
  EXPECT_EQ(scene->count(), 100u);
  EXPECT_THROW(draw(*scene, kCamera), Error) << "base colour of one alone cannot be drawn";
  EXPECT_NO_THROW(draw(*scene, kCamera, {}, 0));
}

TEST_F(Resident, RefusesValuesOfAnotherLengthAndSaysWhich) {
  RenderInstance broken = ball(vec3(0), 50, 1);
  auto materials = std::make_shared<Materials>(*broken.materials);
  materials->roughness.pop_back();
  broken.materials = materials;
  const auto scene = device->newResidentScene();
  try {
    scene->load({broken});
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("\"roughness\" has 49 values"), std::string::npos) << e.what();
  }
  EXPECT_THROW(scene->load({RenderInstance{}}), Error);
}

}  // namespace
}  // namespace beam::testing
