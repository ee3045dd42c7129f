// SPDX-License-Identifier: Apache-2.0
#include "core/method/bake_materials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/brdf.h"
#include "core/math/color.h"
#include "core/method/fit_materials.h"
#include "core/method/light_integrals.h"
#include "core/render/deferred.h"
#include "tests/core/method/function_tracer.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam {
namespace {

constexpr int kPixels = 48;

FrameView blankView(const Camera& camera, std::uint8_t code = 128) {
  return {"cam", camera, Image<u8vec3>(camera.width, camera.height, u8vec3(code), Encoding::Srgb),
          Image<std::uint8_t>(camera.width, camera.height, 255)};
}

Environment uniformLight() { return makeEnvironment(Image<vec3>(64, 32, vec3(1))); }

MaterialMaps bakeOne(const FrameView& view, const GaussianCloud& cloud, const BakeMaterialsOptions& options,
                     const Environment& light = uniformLight()) {
  const auto device = makeCpuDevice();
  Progress progress;
  return bakeMaterials({&view, 1}, cloud, light, options, *device, progress)[0];
}

// Mean over the middle of the picture.
float middleOf(const Planes& p, int channel = 0) {
  double sum = 0;
  int count = 0;
  for (int y = p.height / 2 - 4; y < p.height / 2 + 4; ++y) {
    for (int x = p.width / 2 - 4; x < p.width / 2 + 4; ++x) {
      sum += p.plane(channel)[y * p.width + x];
      ++count;
    }
  }
  return static_cast<float>(sum / count);
}

GaussianCloud floor() {
  GaussianCloud cloud;
  testing::addRectangle(cloud, vec3(0), vec3(0, 0, 1), vec3(1, 0, 0), 0.02f);
  return cloud;
}

Camera above() { return testing::cameraLookingAt({0, 1.5, 0.01}, {0, 0, 0}, kPixels, 3 * kPixels); }

TEST(BakeMaterials, SeesTheWholeSkyFromAnOpenPlane) {
  const MaterialMaps m = bakeOne(blankView(above()), floor(), {.offset_m = 0.005});
  EXPECT_NEAR(middleOf(m.ambient_occlusion), 1, 0.01);
  EXPECT_GT(middleOf(m.ao_weight), 0.99f);
}

// (1 + d / sqrt(d^2 + h^2)) / 2 for an infinitely long wall of height h at distance d (methods 11.2).
TEST(BakeMaterials, SeesAWallAsTheClosedFormSays) {
  const float h = 0.3f, d = 0.2f;
  GaussianCloud cloud = floor();
  testing::addRectangle(cloud, vec3(d, h / 2, 0), vec3(0, h / 2, 0), vec3(0, 0, 4), 0.02f);
  const MaterialMaps m = bakeOne(blankView(above()), cloud, {.ao_samples = 100, .offset_m = 0.005});
  const float taller = h + 0.03f;  // the wall ends softly: about 2 sigma of silhouette
  const float low = (1 + d / std::hypot(d, taller)) / 2, high = (1 + d / std::hypot(d, h)) / 2;
  EXPECT_GT(middleOf(m.ambient_occlusion), low - 0.015f);
  EXPECT_LT(middleOf(m.ambient_occlusion), high + 0.015f);
}

TEST(BakeMaterials, SeesASphereOverheadAsTheClosedFormSays) {
  GaussianCloud cloud = floor();
  testing::addSphere(cloud, vec3(0, 1.2f, 0), 0.5f, 6000);
  const Camera low = testing::cameraLookingAt({1.2, 0.5, 0.0}, {0, 0, 0}, kPixels, 5 * kPixels);
  const MaterialMaps m = bakeOne(blankView(low), cloud, {.ao_samples = 100, .offset_m = 0.005});
  const float grown = 0.5f + 0.03f;
  EXPECT_GT(middleOf(m.ambient_occlusion), 1 - grown * grown / 1.44f - 0.02f);
  EXPECT_LT(middleOf(m.ambient_occlusion), 1 - 0.25f / 1.44f + 0.02f);
}

TEST(BakeMaterials, IsOneOnAConvexBodyUnderAnOpenSky) {
  GaussianCloud cloud;
  testing::addSphere(cloud, vec3(0), 0.5f, 4000);
  const Camera camera = testing::cameraLookingAt({0, 0, 2}, {0, 0, 0}, kPixels, 1.5 * kPixels);
  const MaterialMaps m = bakeOne(blankView(camera), cloud, {.offset_m = 0.02});
  for (std::size_t i = 0; i < m.ao_weight.values.size(); ++i) {
    if (m.ao_weight.values[i] > 0.5f) {
      EXPECT_NEAR(m.ambient_occlusion.values[i], 1, 0.03);
    }
  }
}

// rho = (0.5 - 0.0330) / 0.9599 for a picture of radiance 0.5 head-on at roughness 0.6 (methods 11.1).
TEST(BakeMaterials, DividesTheClosedCase) {
  const auto code = static_cast<std::uint8_t>(std::lround(255 * srgbFromLinear(0.5f)));
  const MaterialMaps m = bakeOne(blankView(above(), code), floor(), {.offset_m = 0.005, .roughness = 0.6});
  const float observed = linearFromSrgb(code / 255.0f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(middleOf(m.base_color, c), (observed - 0.0330f) / 0.9599f, 0.004);
}

TEST(BakeMaterials, InvertsOneBounceByTheClosedForm) {
  GaussianCloud cloud = floor();
  testing::addRectangle(cloud, vec3(0.2f, 0.2f, 0), vec3(0, 0.2f, 0), vec3(0, 0, 2), 0.02f);
  const MaterialMaps plain = bakeOne(blankView(above()), cloud, {.offset_m = 0.005});
  const MaterialMaps corrected = bakeOne(blankView(above()), cloud, {.offset_m = 0.005, .multibounce = true});
  const float rho = middleOf(plain.base_color), a = middleOf(plain.ambient_occlusion);
  EXPECT_LT(a, 0.9f);
  EXPECT_NEAR(middleOf(corrected.base_color), rho / (1 + rho * (1 - a)), 2e-3);
}

TEST(BakeMaterials, GivesNoWeightToClippedDarkAndMaskedPixels) {
  FrameView view = blankView(above());
  for (int y = 0; y < kPixels; ++y) {
    view.photo(20, y) = u8vec3(255, 100, 100);
    view.photo(21, y) = u8vec3(1, 100, 100);
    view.photo(22, y) = u8vec3(3, 3, 3);  // below L_S: the numerator is negative
    view.mask(23, y) = 0;
    view.mask(24, y) = 200;
  }
  const MaterialMaps m = bakeOne(view, floor(), {.offset_m = 0.005, .roughness = 0.4});
  const auto weight = [&](const Planes& p, int x) { return p.values[24 * kPixels + x]; };
  for (const int x : {20, 21, 22, 23, 24}) EXPECT_EQ(weight(m.base_color_weight, x), 0) << x;
  for (const int x : {20, 21, 22, 24}) EXPECT_GT(weight(m.ao_weight, x), 0.9f) << x;
  EXPECT_EQ(weight(m.ao_weight, 23), 0);
  EXPECT_GT(weight(m.base_color_weight, 30), 0.9f);
}

TEST(BakeMaterials, IsTheSameForAnyNumberOfThreads) {
  GaussianCloud cloud = floor();
  testing::addSphere(cloud, vec3(0.2f, 0.2f, 0), 0.15f, 500);
  setThreadCount(1);
  const MaterialMaps one = bakeOne(blankView(above()), cloud, {.offset_m = 0.005});
  setThreadCount(2);
  const MaterialMaps two = bakeOne(blankView(above()), cloud, {.offset_m = 0.005});
  setThreadCount(0);
  EXPECT_EQ(one.ambient_occlusion.values, two.ambient_occlusion.values);
  EXPECT_EQ(one.base_color.values, two.base_color.values);
  EXPECT_EQ(one.base_color_weight.values, two.base_color_weight.values);
}

TEST(BakeMaterials, GivesEachViewAwayBeforeTheNext) {
  const std::vector<FrameView> views = {
      blankView(above()), blankView(testing::cameraLookingAt({0.3, 1.5, 0}, {0, 0, 0}, kPixels, 150))};
  const auto device = makeCpuDevice();
  Progress progress;
  const auto all = bakeMaterials(views, floor(), uniformLight(), {}, *device, progress);
  std::vector<std::size_t> order;
  bakeMaterials(views, floor(), uniformLight(), {}, *device, progress,
                [&](std::size_t view, const MaterialMaps& maps) {
                  order.push_back(view);
                  EXPECT_EQ(maps.base_color_weight.empty(), order.size() <= 2);
                  if (order.size() <= 2) {
                    EXPECT_EQ(maps.base_color.values, all[view].base_color.values);
                  } else {
                    EXPECT_EQ(maps.base_color_weight.values, all[view].base_color_weight.values);
                  }
                });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 0, 1}));
}

TEST(BakeMaterials, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  Progress progress(stop.get_token());
  const auto device = makeCpuDevice();
  const FrameView view = blankView(above());
  EXPECT_THROW(bakeMaterials({&view, 1}, floor(), uniformLight(), {}, *device, progress), Cancelled);
}

// Methods 11.6: photographs by eq. 12 of a ball of known colour, baked, fitted, and relit under another
// light.
class RoundTrip : public ::testing::Test {
 protected:
  static constexpr float kRoughness = 0.6f, kRadius = 0.4f;

  static Environment skyLight() {
    Image<vec3> map(64, 32);
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 64; ++x) {
        const vec3 d = directionFromLatLong({(x + 0.5f) / 64, (y + 0.5f) / 32});
        map(x, y) = vec3(0.9f, 1.0f, 1.1f) * (0.6f + 0.4f * d.y) +
                    3.0f * std::exp(6 * (d.z - 1)) * vec3(1, 0.8f, 0.6f);
      }
    }
    return makeEnvironment(std::move(map));
  }
  static Environment eveningLight() {
    Environment e = skyLight();
    e.yaw_rad = 2;
    e.gain = 0.7f;
    return e;
  }

  static vec3 rhoAt(vec3 n) {
    return 0.35f + 0.2f * vec3(std::sin(4 * n.x), std::sin(3 * n.y + 1), std::cos(4 * n.z));
  }

  static std::vector<Camera> cameras(int count, double turn) {
    std::vector<Camera> out;
    for (int i = 0; i < count; ++i) {
      const double y = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - y * y), phi = 2.39996323 * i + turn;
      out.push_back(testing::cameraLookingAt(2.0 * dvec3(r * std::cos(phi), 0.8 * y, r * std::sin(phi)),
                                             dvec3(0), 64, 100));
    }
    return out;
  }

  struct Picture {
    Image<vec3> radiance;  // linear
    Image<std::uint8_t> mask;
    Image<vec3> rho;
  };

  // Eq. 12 without bounces, by many rays at every pixel of the analytic ball.
  static Picture photograph(const Camera& camera, const Environment& light) {
    Picture p{Image<vec3>(64, 64), Image<std::uint8_t>(64, 64), Image<vec3>(64, 64)};
    const Rigid3 world_from_camera = inverse(camera.camera_from_world);
    std::vector<SurfacePoint> points;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        const dvec3 o = world_from_camera.translation_m;
        const dvec3 d =
            glm::normalize(world_from_camera.rotation * rayOf(camera.intrinsics, {x + 0.5, y + 0.5}));
        const double b = glm::dot(o, d), c = glm::dot(o, o) - kRadius * kRadius;
        if (b * b < c) continue;
        const vec3 n(glm::normalize(o + (-b - std::sqrt(b * b - c)) * d));
        points.push_back({x, y, kRadius * n, n, vec3(-d)});
      }
    }
    const FunctionTracer open([](const Ray&) { return false; });
    Progress progress;
    const auto lit =
        integrateLight(points, {.cosine = 100, .environment = 100, .specular = 50, .roughness = kRoughness},
                       EnvironmentSampler(light), open, progress);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const SurfacePoint& s = points[i];
      p.mask(s.x, s.y) = 255;
      p.rho(s.x, s.y) = rhoAt(s.normal);
      p.radiance(s.x, s.y) = rhoAt(s.normal) * lit[i].diffuse + lit[i].specular;
    }
    return p;
  }

  static FrameView asView(const Camera& camera, const Picture& p) {
    FrameView v{"cam", camera, Image<u8vec3>(64, 64, u8vec3(0), Encoding::Srgb), p.mask};
    for (std::size_t i = 0; i < p.radiance.pixels.size(); ++i) {
      v.photo.pixels[i] =
          u8vec3(glm::clamp(srgbFromLinear(p.radiance.pixels[i]), 0.0f, 1.0f) * 255.0f + 0.5f);
    }
    return v;
  }
};

TEST_F(RoundTrip, ReturnsTheColorAndTheRelitPicture) {
  GaussianCloud cloud;
  testing::addSphere(cloud, vec3(0), kRadius, 20000);
  std::vector<FrameView> views;
  for (const Camera& camera : cameras(12, 0)) views.push_back(asView(camera, photograph(camera, skyLight())));
  const auto device = makeCpuDevice();
  Progress progress;
  const auto maps = bakeMaterials(views, cloud, skyLight(), {.offset_m = 0.005, .roughness = kRoughness},
                                  *device, progress);
  const Materials materials = fitMaterials(sourceOf(maps), cloud, kRoughness,
                                           {.solver = "linear", .regularization = 0.01}, *device, progress);
  const PreparedLight evening = prepareLight(eveningLight());
  double rho_error = 0, lit_error = 0, lit = 0;
  int count = 0;
  GBufferRenderer renderer(*device);
  for (const Camera& camera : cameras(3, 0.5)) {
    const GBuffer g = renderer.render(*residentOf(*device, cloud, &materials), camera);
    const Picture truth = photograph(camera, eveningLight());
    const Image<vec3> relit = shade(g, camera, evening, {});
    for (std::size_t i = 0; i < relit.pixels.size(); ++i) {
      const vec3 to_eye = -vec3(glm::normalize(inverse(camera.camera_from_world).rotation *
                                               rayOf(camera.intrinsics, {i % 64 + 0.5, i / 64 + 0.5})));
      if (g.alpha.pixels[i] < 0.98f || glm::dot(g.normal_world.pixels[i], to_eye) < 0.3f) continue;
      rho_error += glm::dot(g.base_color.pixels[i] - truth.rho.pixels[i],
                            g.base_color.pixels[i] - truth.rho.pixels[i]);
      lit_error +=
          glm::dot(relit.pixels[i] - truth.radiance.pixels[i], relit.pixels[i] - truth.radiance.pixels[i]);
      lit += glm::dot(truth.radiance.pixels[i], truth.radiance.pixels[i]);
      ++count;
    }
  }
  ASSERT_GT(count, 1000);
  EXPECT_LT(std::sqrt(rho_error / (3 * count)), 0.02);
  EXPECT_LT(std::sqrt(lit_error / lit), 0.045);
}

}  // namespace
}  // namespace beam
