// SPDX-License-Identifier: Apache-2.0
// Drift is zero for exact tracks and the slip of a Gaussian otherwise; flicker is zero for what is constant.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/rng.h"
#include "core/method/evaluate_motion.h"

namespace beam::testing {
namespace {

// A sphere of points with their normals.
TrueSkin sphere() {
  TrueSkin t;
  for (int i = 0; i < 500; ++i) {
    const float z = 1 - (2 * static_cast<float>(i) + 1) / 500, r = std::sqrt(1 - z * z);
    const float phi = 2.39996323f * static_cast<float>(i);
    t.normal.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
    t.position_m.push_back(0.2f * t.normal.back());
  }
  return t;
}

TrueSkin moved(const TrueSkin& t, const quat& turn, const vec3& shift) {
  TrueSkin m;
  for (const vec3& p : t.position_m) m.position_m.push_back(turn * p + shift);
  for (const vec3& n : t.normal) m.normal.push_back(turn * n);
  return m;
}

// Gaussians 4 mm above the points, every one with colours of its own.
GaussianCloud skinOn(const TrueSkin& t) {
  GaussianCloud c;
  const RandomStream random(3);
  for (std::size_t i = 0; i < t.position_m.size(); ++i) {
    c.position_m.push_back(t.position_m[i] + 0.004f * t.normal[i]);
    c.rotation.emplace_back(1, 0, 0, 0);
    c.scale_m.emplace_back(0.005f);
    c.opacity.push_back(0.5f);
  }
  c.color = ShBlock(c.size(), 3);
  for (std::size_t i = 0; i < c.color.coefficients.size(); ++i) c.color.coefficients[i] = random.uniform(i);
  return c;
}

const quat kTurn = glm::angleAxis(0.7f, glm::normalize(vec3(1, 2, 3)));
const vec3 kShift(0.03f, -0.01f, 0.02f);

TEST(Drift, IsZeroForExactTracks) {
  const TrueSkin first = sphere(), now = moved(first, kTurn, kShift);
  const Spread s = drift_mm(skinOn(first), skinOn(now), first, now, nearestPoints(skinOn(first), first));
  EXPECT_NEAR(s.median, 0, 1e-3);
  EXPECT_NEAR(s.p95, 0, 1e-3);
}

TEST(Drift, FollowsATwistThatNormalsDoNotShow) {
  const TrueSkin first = sphere(), now = moved(first, glm::angleAxis(3.0f, vec3(0, 0, 1)), vec3(0));
  GaussianCloud cloud = skinOn(first), later = skinOn(now);
  const quat turn = glm::angleAxis(3.0f, vec3(0, 0, 1));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const vec3 aside = 0.006f * glm::normalize(glm::cross(first.normal[i], vec3(0.3f, 0.5f, 0.8f)));
    cloud.position_m[i] += aside;
    later.position_m[i] += turn * aside;
  }
  std::vector<std::uint32_t> own(cloud.size());
  for (std::uint32_t i = 0; i < own.size(); ++i) own[i] = i;
  EXPECT_NEAR(drift_mm(cloud, later, first, now, own).p95, 0, 0.02);
}

TEST(Drift, IsTheWayThatASlippedGaussianIsOff) {
  const TrueSkin first = sphere(), now = moved(first, kTurn, kShift);
  GaussianCloud slipped = skinOn(now);
  for (std::size_t i = 0; i < slipped.size(); i += 10) slipped.position_m[i] += vec3(0.006f, 0, 0);
  const Spread s = drift_mm(skinOn(first), slipped, first, now, nearestPoints(skinOn(first), first));
  EXPECT_NEAR(s.median, 0, 1e-3);
  EXPECT_NEAR(s.p95, 6, 1e-3);
}

TEST(Drift, LeavesOutGaussiansThatAreNotOfTheSkin) {
  const TrueSkin first = sphere();
  GaussianCloud cloud = skinOn(first), later = cloud;
  cloud.position_m[7] = vec3(0.5f), later.position_m[7] = vec3(-0.5f);
  const std::vector<std::uint32_t> nearest = nearestPoints(cloud, first);
  EXPECT_EQ(nearest[7], kNoPoint);
  EXPECT_EQ(nearest[8], 8u);
  EXPECT_NEAR(drift_mm(cloud, later, first, first, nearest).p95, 0, 1e-3);
}

TEST(Tracked, MeansTheSameOrderNotTheSameCount) {
  const GaussianCloud cloud = skinOn(sphere());
  const GaussianCloud on = skinOn(moved(sphere(), glm::angleAxis(0.05f, vec3(0, 1, 0)), kShift));
  EXPECT_TRUE(isTracked(cloud, on));
  GaussianCloud shuffled = on;
  std::rotate(shuffled.position_m.begin(), shuffled.position_m.begin() + 250, shuffled.position_m.end());
  EXPECT_FALSE(isTracked(cloud, shuffled));
  GaussianCloud fewer = on;
  fewer.position_m.pop_back();
  EXPECT_FALSE(isTracked(cloud, fewer));
}

TEST(Flicker, IsZeroForConstantColoursAndTheChangeOtherwise) {
  const GaussianCloud before = skinOn(sphere());
  GaussianCloud now = skinOn(moved(sphere(), kTurn, kShift));
  EXPECT_EQ(radianceFlicker(before, now), 0);
  for (std::size_t i = 0; i < now.size(); ++i) {
    for (int c = 0; c < 3; ++c) now.color.of(i)[c] += 0.1f;
  }
  EXPECT_NEAR(radianceFlicker(before, now), 0.1 * 0.2820948, 1e-6);
}

// A wall at 2 m that fills the picture, and true points on it.
struct Wall {
  Camera camera;
  GBuffer g;
  TrueSkin points;
  Wall() {
    camera.width = camera.height = 32;
    camera.intrinsics = {32, 32, 16, 16};
    g.alpha = Image<float>(32, 32, 0.8f);
    g.depth_m = Image<float>(32, 32, 2.0f);
    g.radiance = Image<vec3>(32, 32, 0.8f * vec3(0.5f));
    g.base_color = Image<vec3>(32, 32, 0.8f * vec3(0.25f));
    for (int y = 0; y < 10; ++y) {
      for (int x = 0; x < 10; ++x) {
        points.position_m.emplace_back(0.1f * static_cast<float>(x) - 0.45f,
                                       0.1f * static_cast<float>(y) - 0.45f, 2.0f);
        points.normal.emplace_back(0, 0, -1);
      }
    }
  }
  SeenPoints shown() const { return seenPoints(g, camera, points); }
};

TEST(Flicker, OfAViewFollowsTheVisiblePointsAndForgivesCoverage) {
  const Wall before;
  Wall now;
  for (float& a : now.g.alpha.pixels) a = 0.9f;
  for (vec3& c : now.g.radiance.pixels) c = 0.9f * vec3(0.5f);
  for (vec3& c : now.g.base_color.pixels) c = 0.9f * vec3(0.28f);
  const auto f = viewFlicker(before.shown(), now.shown());
  ASSERT_TRUE(f);
  EXPECT_EQ(f->points, 100u);
  EXPECT_NEAR(f->radiance, 0, 1e-6);
  EXPECT_NEAR(f->base_color, 0.03, 1e-6);
}

TEST(Flicker, OfAViewSeesNoneWhereATextureMovesByPartsOfAPixel) {
  Wall before, now;
  const auto paint = [](Wall& w, float shift) {
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x)
        w.g.radiance(x, y) = 0.8f * vec3(0.01f * (static_cast<float>(x) + 0.5f - shift));
    }
  };
  paint(before, 0);
  paint(now, 0.4f);
  for (vec3& p : now.points.position_m) p.x += 0.4f * 2.0f / 32;
  const auto f = viewFlicker(before.shown(), now.shown());
  ASSERT_TRUE(f);
  EXPECT_NEAR(f->radiance, 0, 1e-5);
}

TEST(Flicker, OfAViewLeavesOutWhatIsHiddenOrTurnedAway) {
  const Wall before;
  Wall now;
  for (float& d : now.g.depth_m.pixels) d = 1.5f;
  EXPECT_FALSE(viewFlicker(before.shown(), now.shown()));
  Wall away;
  for (vec3& n : away.points.normal) n = -n;
  EXPECT_FALSE(viewFlicker(before.shown(), away.shown()));
}

}  // namespace
}  // namespace beam::testing
