// SPDX-License-Identifier: Apache-2.0
// Laws of the reference renderer where there are meshes or the ground: closed forms of shading and shadows,
// Gaussians and meshes that stand for each other, and what hides what.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/render/pixel_rays.h"
#include "core/render/reference_scene_renderer.h"
#include "tests/support/mesh_shapes.h"
#include "tests/support/message_of.h"
#include "tests/support/reference_scene.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<const char*> kUnlit = {kRgbChannel,      kAlphaChannel,     kDepthChannel,
                                         kNormalChannel,   kBaseColorChannel, kOcclusionChannel,
                                         kRoughnessChannel};

Light sun(double azimuth_deg, double elevation_deg, double irradiance = 3) {
  Light light = newLight("sun", "directional");
  auto& kind = std::get<DirectionalLight>(light.kind);
  kind.azimuth_deg = azimuth_deg;
  kind.elevation_deg = elevation_deg;
  kind.intensity = irradiance;
  return light;
}
vec3 toSun(const Light& light) { return vec3(directionTo(std::get<DirectionalLight>(light.kind))); }

// Where a ray enters a sphere; infinite: nowhere.
float sphereAt(vec3 o, vec3 d, vec3 center, float radius_m) {
  const vec3 from = o - center;
  const float b = glm::dot(from, d), c = glm::dot(from, from) - radius_m * radius_m;
  return b * b < c ? PathSurfaces::kFar_m : -b - std::sqrt(b * b - c);
}
float lineDistance(vec3 x, vec3 d, vec3 point) { return glm::length(glm::cross(point - x, d)); }

// body(pixel, eye, unit direction through its middle).
template <class Body>
void forPixels(const Camera& camera, Body&& body) {
  const PixelRays rays(camera);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x)
      body(static_cast<std::size_t>(y * camera.width + x), vec3(rays.eye()), -rays.toEye(x, y));
  }
}

Camera ofTheMiddle() { return cameraLookingAt({0, 0.4, 2}, {0, 0, 0}, 48, 90); }
Camera finer() { return cameraLookingAt({0, 0.4, 2}, {0, 0, 0}, 144, 270); }

RenderScene sphereAlone(vec3 albedo) {
  RenderScene scene;
  scene.meshes = {meshOf(icosphere(vec3(0), 0.4f, 4), albedo)};
  return scene;
}

TEST(MeshReference, ASphereInALampsLightIsAsBrightAsTheCosineSays) {
  const vec3 albedo(0.7f, 0.4f, 0.1f);
  RenderScene scene = sphereAlone(albedo);
  scene.lighting.lights = {sun(50, 30)};
  const vec3 light = toSun(scene.lighting.lights[0]);
  const RenderedPicture p = pictureOf(scene, finer(), {kRelightChannel},
                                      {.samples = 16, .bounces = 0, .denoise = false, .specular = false});
  int lit = 0, dark = 0;
  forPixels(finer(), [&](std::size_t i, vec3 eye, vec3 d) {
    const float t = sphereAt(eye, d, vec3(0), 0.4f);
    if (t == PathSurfaces::kFar_m) return;
    const vec3 n = glm::normalize(eye + t * d);
    const float cosine = glm::dot(n, light), found = pixelOf(p, kRelightChannel, i).x;
    if (glm::dot(n, -d) < 0.3f) return;  // edges
    if (cosine > 0.2f) {
      EXPECT_NEAR(found / (albedo.x * 3 * cosine / kPi), 1, 0.01) << cosine;
      ++lit;
    } else if (cosine < -0.05f) {
      EXPECT_EQ(found, 0);
      ++dark;
    } else {
      EXPECT_NEAR(found, albedo.x * 3 * std::max(cosine, 0.0f) / kPi, 0.01f) << cosine;
    }
  });
  EXPECT_GT(lit, 2000);
  EXPECT_GT(dark, 500);
}

TEST(MeshReference, InAFurnaceASphereReturnsItsAlbedo) {
  const vec3 albedo(0.7f, 0.4f, 0.1f);
  RenderScene scene = sphereAlone(albedo);
  scene.environment = uniform();
  for (const LightDraws draws : {LightDraws::Both, LightDraws::OfSurface}) {
    const RenderedPicture p =
        pictureOf(scene, ofTheMiddle(), {kRelightChannel, kAlphaChannel},
                  {.samples = 64, .bounces = 2, .denoise = false, .specular = false, .draws = draws});
    double sum = 0, alpha = 0;
    for (std::size_t i = 0; i < 48 * 48; ++i) {
      const float a = pixelOf(p, kAlphaChannel, i).x;
      sum += pixelOf(p, kRelightChannel, i).y, alpha += a;
      // Drawn by the surface each path gives the albedo itself, unless a triangle is in another one's way.
      if (draws == LightDraws::OfSurface && a > 0) {
        EXPECT_NEAR(pixelOf(p, kRelightChannel, i).x / a / albedo.x, 1, 0.01) << i;
      }
    }
    EXPECT_NEAR(sum / alpha / albedo.y, 1, 0.01 / 3);
    EXPECT_GT(alpha, 500);
  }
}

// Three staggered layers, so flat that the eye sees none of them tilted.
GaussianCloud wall() {
  GaussianCloud cloud;
  for (int layer = 0; layer < 3; ++layer) {
    addRectangle(cloud, vec3(0.001f * layer, -0.003f * layer, 0.0005f * layer), vec3(0, 0, 0.15f),
                 vec3(0.15f, 0, 0), 0.003f);
  }
  cloud.opacity.assign(cloud.size(), 0.99f);
  for (vec3& s : cloud.scale_m) s.z = 0.0002f;
  return cloud;
}

TEST(MeshReference, AWallOfGaussiansIsAsBrightAsTheSameWallOfTriangles) {
  const vec3 albedo(0.6f, 0.5f, 0.3f);
  Image<vec3> sky(64, 32, vec3(0.2f), Encoding::Linear);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 64; ++x) sky(x, y) = vec3(0.1f + 0.04f * static_cast<float>(x), 0.5f, 0.6f);
  RenderScene gaussians, triangles;
  gaussians.instances = {gaussiansOf(wall(), albedo, 0.5f)};
  triangles.meshes = {meshOf(rectangle(vec3(0), vec3(0, 0, 0.15f), vec3(0.15f, 0, 0)), albedo, 0.5f)};
  const Camera camera = cameraLookingAt({0, 0.5, 0.2}, {0, 0, 0}, 24, 150);
  for (const bool panorama : {true, false}) {
    for (RenderScene* scene : {&gaussians, &triangles}) {
      scene->environment = panorama ? std::make_shared<const Environment>(makeEnvironment(sky)) : nullptr;
      scene->lighting.lights.clear();
      if (!panorama) scene->lighting.lights = {sun(70, 40)};
    }
    const ReferenceOptions options{.samples = 256, .denoise = false};
    const auto mean = [&](const RenderScene& scene) {
      return meanOf(
          *channelIn(pictureOf(scene, camera, {kRelightChannel}, options), kRelightChannel)->values);
    };
    const vec3 a = mean(gaussians), b = mean(triangles);
    ASSERT_GT(b.z, 0.05f);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], 1, 0.01) << panorama;
  }
}

// A ball over the ground, seen from above; `distance`: of the line from a point of the ground to the lamp
// from the ball's centre.
constexpr float kBall_m = 0.2f;
const vec3 kBallAt(0.1f, 0.5f, 0);

RenderScene ballOverGround(bool of_gaussians) {
  RenderScene scene;
  scene.ground = {.enabled = true, .height_m = 0.1, .base_color = dvec3(0.6), .roughness = 0.9};
  if (of_gaussians) {
    GaussianCloud ball;
    addSphere(ball, kBallAt, kBall_m, 4000);
    scene.instances = {gaussiansOf(std::move(ball), vec3(0.5f), 0.6f)};
  } else {
    scene.meshes = {meshOf(icosphere(kBallAt, kBall_m, 4), vec3(0.5f))};
  }
  scene.lighting.lights = {sun(60, 40)};
  return scene;
}

TEST(MeshReference, AMeshAndABodyOfGaussiansShadowTheGroundWhereTheyStandInTheLampsWay) {
  const Camera camera = cameraLookingAt({0.4, 2.2, 1.0}, {0, 0.1, 0}, 64, 75);
  for (const bool of_gaussians : {false, true}) {
    const RenderScene scene = ballOverGround(of_gaussians);
    const vec3 light = toSun(scene.lighting.lights[0]);
    const float open = 0.6f * 3 * light.y / kPi;
    const RenderedPicture p = pictureOf(scene, camera, {kRelightChannel},
                                        {.samples = 16, .bounces = 0, .denoise = false, .specular = false});
    const float inside = of_gaussians ? 0.93f : 0.98f, outside = of_gaussians ? 1.1f : 1.02f;
    int shadow = 0, lit = 0;
    forPixels(camera, [&](std::size_t i, vec3 eye, vec3 d) {
      const vec3 x = eye + (0.1f - eye.y) / d.y * d;
      if (lineDistance(eye, d, kBallAt) < 1.2f * kBall_m) return;
      const float margin = 0.015f;  // half a pixel there
      const float apart = lineDistance(x, light, kBallAt), found = pixelOf(p, kRelightChannel, i).x;
      if (apart < inside * kBall_m - margin) {
        EXPECT_LT(found, 0.01f * open) << apart;
        ++shadow;
      } else if (apart > outside * kBall_m + margin) {
        EXPECT_NEAR(found / open, 1, 0.01) << apart;
        ++lit;
      }
    });
    EXPECT_GT(shadow, 30) << of_gaussians;
    EXPECT_GT(lit, 2000) << of_gaussians;
  }
}

GaussianCloud sheet(float height_m) {
  GaussianCloud cloud;
  for (int layer = 0; layer < 3; ++layer) {
    addRectangle(cloud, vec3(0.007f * layer, height_m - 0.002f * layer, 0.004f * layer), vec3(0, 0, 0.6f),
                 vec3(0.6f, 0, 0), 0.02f);
  }
  cloud.opacity.assign(cloud.size(), 0.99f);
  return cloud;
}

TEST(MeshReference, AMeshShadowsGaussiansAndTheirOwnSideOfTheWallIsDarkToItsFoot) {
  RenderScene scene;
  scene.instances = {gaussiansOf(sheet(0), vec3(0.5f), 0.9f)};
  // A wall across the sheet, in the light of a lamp from +X, 45 degrees up.
  scene.meshes = {meshOf(rectangle(vec3(0, 0.1f, 0), vec3(0, 0, 0.5f), vec3(0, 0.15f, 0)), vec3(0.2f))};
  scene.lighting.lights = {sun(90, 45)};
  const Camera camera = cameraLookingAt({0, 2, 0.001}, {0, 0, 0}, 64, 150);
  const RenderedPicture p = pictureOf(scene, camera, {kRelightChannel},
                                      {.samples = 16, .bounces = 0, .denoise = false, .specular = false});
  const float open = 0.5f * 3 * std::sqrt(0.5f) / kPi;
  forPixels(camera, [&](std::size_t i, vec3 eye, vec3 d) {
    const vec3 x = eye - eye.y / d.y * d;
    const float found = pixelOf(p, kRelightChannel, i).x;
    if (std::abs(x.z) > 0.4f || std::abs(x.x) > 0.5f) return;
    if (x.x < -0.02f && x.x > -0.2f) {
      EXPECT_EQ(found, 0) << x.x;
    } else if (x.x < -0.28f || x.x > 0.04f) {
      EXPECT_NEAR(found / open, 1, 0.02) << x.x;
    }
  });
}

TEST(MeshReference, WhatTouchesTheGroundIsDarkUnderneathAndUnlitFromBelow) {
  RenderScene scene;
  scene.ground = {.enabled = true, .height_m = 0, .base_color = dvec3(0.5)};
  // A lid 1 mm over the ground, and light from everywhere: seen from the side of the camera far off its edge.
  scene.meshes = {meshOf(rectangle(vec3(0, 0.001f, 0), vec3(0, 0, 1), vec3(1, 0, 0)), vec3(0.5f))};
  scene.environment = uniform();
  const Camera under = cameraLookingAt({0.5, 0.0005, 0}, {-0.5, 0.0004, 0}, 8, 100);
  const RenderedPicture p = pictureOf(scene, under, {kRelightChannel}, {.samples = 16, .denoise = false});
  EXPECT_LT(meanOf(*channelIn(p, kRelightChannel)->values).x, 0.02f);
  scene.meshes.clear();
  GaussianCloud cloud = sheet(0.01f);  // less than the offset over the ground
  scene.instances = {gaussiansOf(std::move(cloud), vec3(0.5f), 0.5f)};
  const RenderedPicture below = pictureOf(scene, cameraLookingAt({0.3, 0.004, 0}, {-0.3, 0.012, 0}, 8, 100),
                                          {kRelightChannel}, {.samples = 16});
  EXPECT_LT(meanOf(*channelIn(below, kRelightChannel)->values).x, 0.04f);
}

TEST(MeshReference, AMeshHidesTheGaussiansBehindItAndNotThoseBeforeIt) {
  const vec3 red(0.7f, 0.2f, 0.1f), blue(0.1f, 0.2f, 0.8f);
  const Camera camera = cameraLookingAt({0, 2, 0.001}, {0, 0, 0}, 32, 60);
  RenderScene alone;
  alone.instances = {gaussiansOf(sheet(0), red, 0.3f)};
  alone.environment = uniform();
  const ReferenceOptions options{
      .samples = 32, .bounces = 0, .denoise = false, .specular = false, .draws = LightDraws::OfSurface};
  auto asked = kUnlit;
  asked.push_back(kRelightChannel);
  const RenderedPicture sheet_alone = pictureOf(alone, camera, asked, options);
  for (const float height_m : {0.3f, -0.3f}) {
    RenderScene scene = alone;
    scene.meshes = {meshOf(rectangle(vec3(0, height_m, 0), vec3(0, 0, 5), vec3(5, 0, 0)), blue, 0.9f)};
    const RenderedPicture p = pictureOf(scene, camera, asked, options);
    forPixels(camera, [&](std::size_t i, vec3 eye, vec3 d) {
      const vec3 x = eye - eye.y / d.y * d;
      const bool of_sheet = std::max(std::abs(x.x), std::abs(x.z)) < 0.5f;
      EXPECT_FLOAT_EQ(pixelOf(p, kAlphaChannel, i).x, 1);
      if (height_m < 0 && of_sheet) {
        for (const char* id : {kDepthChannel, kNormalChannel, kRgbChannel})
          EXPECT_LT(glm::distance(pixelOf(p, id, i), pixelOf(sheet_alone, id, i)), 1e-3f) << id;
        EXPECT_LT(glm::distance(pixelOf(p, kBaseColorChannel, i), red), 2e-3f);
        EXPECT_NEAR(pixelOf(p, kRoughnessChannel, i).x, 0.3f, 2e-3f);
        EXPECT_NEAR(pixelOf(p, kRelightChannel, i).x, 0.7f, 0.03f);
      } else if (height_m > 0 || std::max(std::abs(x.x), std::abs(x.z)) > 0.7f) {
        EXPECT_LT(glm::distance(pixelOf(p, kBaseColorChannel, i), blue), 1e-5f);
        EXPECT_LT(glm::distance(pixelOf(p, kRgbChannel, i), srgbFromLinear(blue)), 1e-5f);
        EXPECT_LT(glm::distance(pixelOf(p, kNormalChannel, i), vec3(0, 1, 0)), 1e-5f);
        EXPECT_FLOAT_EQ(pixelOf(p, kOcclusionChannel, i).x, 1);
        EXPECT_NEAR(pixelOf(p, kRoughnessChannel, i).x, 0.9f, 1e-5f);
        EXPECT_NEAR(pixelOf(p, kDepthChannel, i).x, 2 - height_m, 2e-3f);
        if (height_m > 0) {
          EXPECT_NEAR(pixelOf(p, kRelightChannel, i).z, 0.8f, 0.03f);
        }
      }
    });
  }
}

TEST(MeshReference, PastThinGaussiansAMeshIsSeenAsMuchAsTheyLetThrough) {
  const vec3 red(0.8f, 0.2f, 0.1f), blue(0.1f, 0.2f, 0.8f);
  GaussianCloud thin;
  addRectangle(thin, vec3(0), vec3(0, 0, 0.6f), vec3(0.6f, 0, 0), 0.02f);
  thin.opacity.assign(thin.size(), 0.1f);
  RenderScene scene;
  scene.instances = {gaussiansOf(std::move(thin), red, 0.3f)};
  scene.lighting.lights = {sun(0, 90, kPi)};
  std::get<DirectionalLight>(scene.lighting.lights[0].kind).shadows = false;
  const Camera camera = cameraLookingAt({0, 2, 0.001}, {0, 0, 0}, 8, 100);
  const ReferenceOptions options{.samples = 1024, .bounces = 0, .denoise = false, .specular = false};
  auto asked = kUnlit;
  asked.push_back(kRelightChannel);
  const RenderedPicture alone = pictureOf(scene, camera, asked, options);
  scene.meshes = {meshOf(rectangle(vec3(0, -0.2f, 0), vec3(0, 0, 5), vec3(5, 0, 0)), blue)};
  const RenderedPicture p = pictureOf(scene, camera, asked, options);
  double a = 0, lit = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    const float alpha = pixelOf(alone, kAlphaChannel, i).x;
    ASSERT_GT(alpha, 0.2f);
    ASSERT_LT(alpha, 0.8f);
    EXPECT_FLOAT_EQ(pixelOf(p, kAlphaChannel, i).x, 1);
    const vec3 expected = pixelOf(alone, kBaseColorChannel, i) + (1 - alpha) * blue;
    EXPECT_LT(glm::distance(pixelOf(p, kBaseColorChannel, i), expected), 1e-4f);
    a += expected.x, lit += pixelOf(p, kRelightChannel, i).x;
  }
  EXPECT_NEAR(lit / a, 1, 0.01);
}

TEST(MeshReference, EdgesOfMeshesAreSmooth) {
  RenderScene scene;
  const vec3 across = glm::normalize(vec3(0.3f, 0, 1));
  scene.meshes = {meshOf(rectangle(vec3(0), 0.4f * across, 0.3f * vec3(across.z, 0, -across.x)), vec3(0.5f))};
  scene.environment = uniform();
  const Camera camera = cameraLookingAt({0, 2, 0.001}, {0, 0, 0}, 48, 80);
  const RenderedPicture p = pictureOf(scene, camera, {kAlphaChannel, kRelightChannel},
                                      {.samples = 64, .denoise = false, .specular = false});
  double area = 0;
  int partly = 0;
  for (std::size_t i = 0; i < 48 * 48; ++i) {
    const float alpha = pixelOf(p, kAlphaChannel, i).x;
    area += alpha;
    partly += alpha > 0 && alpha < 1;
    EXPECT_NEAR(pixelOf(p, kRelightChannel, i).x, 0.5f * alpha, 0.05f);
  }
  EXPECT_NEAR(area / (0.8 * 0.6 * 40 * 40), 1, 0.01);
  EXPECT_GT(partly, 80);
}

RenderScene ofEverything() {
  RenderScene scene = ballOverGround(true);
  scene.meshes = {meshOf(icosphere(vec3(-0.3f, 0.3f, 0.1f), 0.2f, 3), vec3(0.2f, 0.6f, 0.3f), 0.3f)};
  Mesh cut = icosphere(kBallAt + vec3(0.1f, 0, 0), 0.18f, 1);  // through the ball
  cut.normals.clear();
  scene.meshes.push_back(meshOf(std::move(cut), vec3(0.7f, 0.5f, 0.2f)));
  scene.environment = uniform();
  return scene;
}

TEST(MeshReference, IsTheSameForAnyNumberOfThreads) {
  auto asked = kUnlit;
  asked.push_back(kRelightChannel);
  const auto values = [&](int threads) {
    setThreadCount(threads);
    const RenderedPicture p = pictureOf(ofEverything(), cameraLookingAt({0.3, 0.9, 1.4}, {0, 0.3, 0}, 48, 60),
                                        asked, {.samples = 6});
    std::vector<std::vector<float>> all;
    for (const RenderedChannel& c : p.channels) all.push_back(c.values->values);
    return all;
  };
  const auto one = values(1);
  EXPECT_EQ(values(2), one);
  setThreadCount(0);
  for (const float v : one.back()) EXPECT_TRUE(std::isfinite(v) && v >= 0);
}

TEST(MeshReference, SeenFromWhereMeshesAreAwayTheyChangeNothing) {
  RenderScene scene;
  scene.instances = {gaussiansOf(sheet(0), vec3(0.5f, 0.4f, 0.2f), 0.5f)};
  scene.environment = uniform();
  const Camera camera = cameraLookingAt({0, 2, 0.001}, {0, 0, 0}, 24, 100);
  const RenderedPicture without = pictureOf(scene, camera, kUnlit, {});
  scene.meshes = {meshOf(icosphere(vec3(0, 3, 0), 0.2f, 2), vec3(0.5f))};
  const RenderedPicture with = pictureOf(scene, camera, kUnlit, {});
  for (std::size_t c = 0; c < kUnlit.size(); ++c)
    EXPECT_EQ(with.channels[c].values->values, without.channels[c].values->values) << kUnlit[c];
}

TEST(MeshReference, BesideGaussiansWithoutMaterialsWhatNeedsNoneIsDrawn) {
  RenderScene scene;
  scene.instances = {gaussiansOf(sheet(0), vec3(0.5f), 0.5f)};
  scene.instances[0].materials = nullptr;
  scene.meshes = {meshOf(icosphere(vec3(0, 0.3f, 0), 0.2f, 2), vec3(0.5f))};
  const Camera camera = cameraLookingAt({0, 2, 0.001}, {0, 0, 0}, 24, 30);
  const RenderedPicture p =
      pictureOf(scene, camera, {kRgbChannel, kAlphaChannel, kDepthChannel, kNormalChannel}, {});
  const std::size_t middle = 12 * 24 + 12, beside = 12 * 24 + 7;
  EXPECT_NEAR(pixelOf(p, kRgbChannel, middle).x, srgbFromLinear(0.5f), 1e-5f);
  EXPECT_NEAR(pixelOf(p, kDepthChannel, middle).x, 1.5f, 1e-2f);
  EXPECT_NEAR(pixelOf(p, kDepthChannel, beside).x, 2, 5e-3f);
  EXPECT_NEAR(pixelOf(p, kAlphaChannel, beside).x, 1, 1e-2f);
}

TEST(MeshReference, ItsLoadFollowsChangesAndRefusesBrokenMeshes) {
  const auto renderer = newReferenceSceneRenderer(makeCpuDevice(), {.samples = 1});
  RenderScene scene = sphereAlone(vec3(0.5f));
  scene.environment = uniform();
  const Camera camera = ofTheMiddle();
  const auto middle = [&](const char* id) {
    vec3 value(0);
    Progress progress;
    const std::vector<ChannelInfo> asked = {channelOf(id)};
    renderer->draw(camera, asked, progress,
                   [&](const RenderedPicture& p) { value = pixelOf(p, id, 24 * 48 + 24); });
    return value;
  };
  renderer->load(scene);
  EXPECT_NEAR(middle(kBaseColorChannel).x, 0.5f, 1e-5f);
  scene.meshes[0].base_color = vec3(0.25f);
  renderer->load(scene);
  EXPECT_NEAR(middle(kBaseColorChannel).x, 0.25f, 1e-5f);
  auto broken = std::make_shared<Mesh>(*scene.meshes[0].mesh);
  broken->triangles[5][1] = 1000000;
  RenderScene bad = scene;
  bad.meshes[0].mesh = broken;
  EXPECT_THAT(dataErrorOf([&] { renderer->load(bad); }), HasSubstr("mesh 0: triangle 5"));
  renderer->load(scene);
  EXPECT_NEAR(middle(kBaseColorChannel).x, 0.25f, 1e-5f);
  scene.ground.enabled = true;
  scene.meshes.clear();
  renderer->load(scene);
  EXPECT_FLOAT_EQ(middle(kAlphaChannel).x, 1);
  EXPECT_GT(middle(kRelightChannel).x, 0.3f);
}

TEST(MeshReference, InRealTimeASceneOfMeshesAloneIsEmptyAndSaysSo) {
  const auto renderer = newCpuSceneRenderer(makeCpuDevice());
  RenderScene scene = sphereAlone(vec3(0.5f));
  scene.environment = uniform();
  EXPECT_THAT(renderer->load(scene), ElementsAre("meshes are not drawn by the renderer cpu"));
  const std::vector<ChannelInfo> asked = {channelOf(kRelightChannel), channelOf(kAlphaChannel)};
  Progress progress;
  renderer->draw(ofTheMiddle(), asked, progress, [&](const RenderedPicture& p) {
    EXPECT_EQ(pixelOf(p, kRelightChannel, 24 * 48 + 24), vec3(0));
    EXPECT_EQ(pixelOf(p, kAlphaChannel, 24 * 48 + 24).x, 0);
  });
}

}  // namespace
}  // namespace beam::testing
