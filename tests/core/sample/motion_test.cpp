// SPDX-License-Identifier: Apache-2.0
// The dance of the sample: fast and smooth, a half turn, arms that cross and do not meet; its skin and
// tracks.
#include "core/sample/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/io/ply_file.h"
#include "core/sample/skin.h"
#include "core/sample/tracks.h"
#include "tests/support/temp_dir.h"

namespace beam {
namespace {

constexpr vec3 kPalm(0.535f, -0.026f, 0.97f), kFingertip(0.59f, -0.03f, 0.875f);  // left, at rest

vec3 placed(const PosedBones& bones, int bone, vec3 rest) {
  return bones.rotation[bone] * rest + bones.translation[bone];
}

vec3 onHand(double frame, bool right, vec3 rest) {
  const vec3 mirror(right ? -1 : 1, 1, 1);
  return placed(placeBones(danceAt(frame)), right ? bone::RHand : bone::LHand, mirror * rest);
}

const Skin& coarseSkin() {
  static const Skin skin(danceAt(0), 0.014f);
  return skin;
}

TEST(SampleMotion, TurnsTheBodyByHalfATurnInThirtyFrames) {
  const PosedBones first = placeBones(danceAt(0)), last = placeBones(danceAt(29));
  const vec3 left(1, 0, 0);
  EXPECT_LT(glm::dot(first.rotation[bone::Root] * left, last.rotation[bone::Root] * left), -0.999f);
  for (double t = 0; t < 200; t += 0.25) {
    EXPECT_GE(danceYaw_deg(t + 0.25), danceYaw_deg(t)) << t;
    EXPECT_LT(danceYaw_deg(t + 1) - danceYaw_deg(t), 13) << t;
  }
}

TEST(SampleMotion, HandsAreFastButNotBeyondTwelveCentimetresAFrame) {
  for (const int begin : {0, 30, 60, 170}) {
    float fastest = 0;
    for (int f = begin; f < begin + 30; ++f) {
      for (const bool right : {false, true})
        fastest = std::max(fastest, glm::length(onHand(f + 1, right, kPalm) - onHand(f, right, kPalm)));
    }
    EXPECT_GT(fastest, 0.08f) << begin;
    EXPECT_LT(fastest, 0.12f) << begin;
  }
}

TEST(SampleMotion, IsContinuousWithItsFirstDerivative) {
  constexpr double h = 0.02;
  const auto velocity = [&](double t, int bone) {
    const PosedBones a = placeBones(danceAt(t - h / 2)), b = placeBones(danceAt(t + h / 2));
    const vec3 end = bonePivot(bone) + vec3(0, 0, -0.1f);
    return (placed(b, bone, end) - placed(a, bone, end)) / static_cast<float>(h);
  };
  for (const int b : {bone::Head, bone::LHand, bone::RHand, bone::LFoot, bone::RFoot, bone::LFore}) {
    for (double t = 0; t < 95; t += h)
      ASSERT_LT(glm::length(velocity(t + h, b) - velocity(t, b)), 0.004f) << b << " at " << t;
  }
}

TEST(SampleMotion, HandsCrossTheMidline) {
  for (const double t : {13.0, 43.0, 73.0}) {
    const PosedBones bones = placeBones(danceAt(t));
    const auto inChest = [&](vec3 x) {
      return glm::transpose(bones.rotation[bone::Chest]) * (x - bones.translation[bone::Chest]);
    };
    EXPECT_LT(inChest(onHand(t, false, kFingertip)).x, -0.08f) << t;
    EXPECT_GT(inChest(onHand(t, true, kFingertip)).x, 0.08f) << t;
  }
}

// Bones by what may not meet; joined ones share a group or are left out.
bool isForearm(int b, bool right) {
  return right ? b == bone::RFore || b == bone::RHand : b == bone::LFore || b == bone::LHand;
}

struct Meeting {
  float deepest = std::numeric_limits<float>::max();
  std::string where;
};

Meeting deepest(double frame) {
  const Skin& skin = coarseSkin();
  const Mesh s = skin.posed(danceAt(frame));
  const Figure figure(danceAt(frame));
  Meeting m;
  for (std::size_t i = 0; i < s.vertices.size(); ++i) {
    const auto at_first = skin.figure().boneDistances(skin.first().vertices[i]);
    const int own = static_cast<int>(std::min_element(at_first.begin(), at_first.end()) - at_first.begin());
    const bool left = isForearm(own, false), right = isForearm(own, true);
    if (!left && !right) continue;
    const auto d = figure.boneDistances(s.vertices[i]);
    for (int b = 0; b < bone::Count; ++b) {
      const bool own_arm = isForearm(b, right) || b == (right ? bone::RUpper : bone::LUpper);
      if (own_arm || d[b] >= m.deepest) continue;
      m = {d[b], "bone " + std::to_string(own) + " in " + std::to_string(b)};
    }
  }
  return m;
}

TEST(SampleMotion, ArmsComeCloseAndDoNotPassThroughTheBody) {
  EXPECT_GT(deepest(0).deepest, 0.05f);  // a good first frame
  float closest = 1;
  for (int f = 0; f < 240; f += 5) {
    const Meeting m = deepest(f);
    closest = std::min(closest, m.deepest);
    EXPECT_GT(m.deepest, -0.003f) << m.where << ", frame " << f;
  }
  EXPECT_LT(closest, 0.015f);
}

TEST(SampleMotion, FeetStayOnTheGround) {
  for (int f = 0; f < 60; ++f) {
    const Mesh s = coarseSkin().posed(danceAt(f));
    float lowest = 1;
    for (const vec3& v : s.vertices) lowest = std::min(lowest, v.z);
    EXPECT_NEAR(lowest, 0.0f, 0.02f) << f;
  }
}

TEST(SampleSkin, TheFirstPoseIsTheFigureItself) {
  const Skin& skin = coarseSkin();
  const Mesh s = skin.posed(danceAt(0));
  for (std::size_t i = 0; i < s.normals.size(); ++i) {
    ASSERT_LT(glm::length(s.vertices[i] - skin.first().vertices[i]), 1e-5f);
    ASSERT_GT(glm::dot(s.normals[i], skin.first().normals[i]), 0.9999f);
  }
}

TEST(SampleSkin, StaysNearThePosedFigure) {
  const Mesh s = coarseSkin().posed(danceAt(13));
  const Figure figure(danceAt(13));
  double sum = 0;
  for (const vec3& v : s.vertices) sum += std::abs(figure.distance(v));
  EXPECT_LT(sum / static_cast<double>(s.vertices.size()), 0.004);
}

float distanceTo(vec3 x, vec3 a, vec3 b, vec3 c) {
  const vec3 n = glm::normalize(glm::cross(b - a, c - a));
  const vec3 p = x - n * glm::dot(n, x - a);
  const bool inside = glm::dot(glm::cross(b - a, p - a), n) >= 0 &&
                      glm::dot(glm::cross(c - b, p - b), n) >= 0 &&
                      glm::dot(glm::cross(a - c, p - c), n) >= 0;
  if (inside) return std::abs(glm::dot(n, x - a));
  float least = std::numeric_limits<float>::max();
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const float t = glm::clamp(glm::dot(x - from, to - from) / glm::dot(to - from, to - from), 0.0f, 1.0f);
    least = std::min(least, glm::length(x - from - t * (to - from)));
  }
  return least;
}

TEST(SampleTracks, LieOnTheMeshOfEachFrameWithItsNormals) {
  const testing::TempDir dir;
  const Skin& skin = coarseSkin();
  const TrackPoints tracks(skin.first(), 400, 1);
  for (const double frame : {0.0, 12.0, 20.0}) {
    const Mesh s = skin.posed(danceAt(frame));
    tracks.write(dir / "t.ply", s);
    const std::vector<PlyElement> file = readPly(dir / "t.ply");
    const PlyElement& points = file.at(0);
    ASSERT_EQ(points.count, 400u);
    ASSERT_EQ(points.columns, 6u);
    double agreement = 0;
    for (std::size_t i = 0; i < points.count; ++i) {
      const float* row = points.row(i);
      const vec3 x(row[0], row[1], row[2]), n(row[3], row[4], row[5]);
      float least = 1;
      vec3 normal(0);
      for (const auto& t : s.triangles) {
        const vec3 a = s.vertices[t[0]], b = s.vertices[t[1]], c = s.vertices[t[2]];
        if (glm::length(a - x) > 0.06f) continue;
        const float d = distanceTo(x, a, b, c);
        if (d < least) least = d, normal = glm::normalize(glm::cross(b - a, c - a));
      }
      ASSERT_LT(least, 0.001f) << i;
      EXPECT_NEAR(glm::length(n), 1, 1e-4);
      agreement += glm::dot(n, normal);
    }
    EXPECT_GT(agreement / static_cast<double>(points.count), 0.97) << frame;
  }
}

TEST(SampleTracks, AreEvenOverTheSurfaceAndMoveAsFastAsLimbsDo) {
  const Skin& skin = coarseSkin();
  const TrackPoints tracks(skin.first(), 4000, 1);
  const auto first = tracks.on(skin.first());
  double head = 0;
  for (const auto& p : first) head += p.position_m.z > 1.5f;
  double area = 0, head_area = 0;
  for (const auto& t : skin.first().triangles) {
    const auto& v = skin.first().vertices;
    const double a = glm::length(glm::cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]));
    area += a;
    if ((v[t[0]].z + v[t[1]].z + v[t[2]].z) / 3 > 1.5f) head_area += a;
  }
  EXPECT_NEAR(head / 4000, head_area / area, 0.01);
  auto before = first;
  for (int f = 1; f < 30; ++f) {
    const auto now = tracks.on(skin.posed(danceAt(f)));
    for (std::size_t i = 0; i < now.size(); ++i)
      ASSERT_LT(glm::length(now[i].position_m - before[i].position_m), 0.15f) << f;
    before = now;
  }
}

}  // namespace
}  // namespace beam
