// SPDX-License-Identifier: Apache-2.0
#include "core/sample/motion.h"

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

using namespace bone;

constexpr double kTau = 2 * 3.14159265358979;

// Of the left arm, in the chest's rest frame; the right arm is its mirror.
struct ArmKey {
  double frame;
  dvec3 wrist;
  dvec3 elbow_towards;
};
constexpr int kKeys = 5;  // a half; the next half's first key is at its end
const ArmKey kInner[kKeys] = {{0, {0.44, -0.10, 1.06}, {0.45, 0.9, 0.1}},
                              {1, {0.44, -0.10, 1.06}, {0.45, 0.9, 0.1}},
                              {11, {0.0, -0.195, 1.29}, {0.9, 0.1, -0.6}},
                              {14, {-0.015, -0.195, 1.295}, {0.9, 0.1, -0.6}},
                              {26, {0.42, -0.20, 1.18}, {0.7, 0.55, -0.3}}};
const ArmKey kOuter[kKeys] = {{0, {0.44, -0.10, 1.06}, {0.45, 0.9, 0.1}},
                              {1, {0.44, -0.10, 1.06}, {0.45, 0.9, 0.1}},
                              {11, {0.02, -0.257, 1.215}, {0.85, 0.1, -0.5}},
                              {14, {0.01, -0.26, 1.212}, {0.85, 0.1, -0.5}},
                              {26, {0.43, -0.19, 1.21}, {0.7, 0.55, -0.3}}};

// The key with this running number; arms change roles with each half.
ArmKey keyOf(int arm, int number) {
  const int half = static_cast<int>(std::floor(static_cast<double>(number) / kKeys)),
            index = number - half * kKeys;
  const bool inner = ((half + arm) % 2 + 2) % 2 == 0;
  ArmKey k = (inner ? kInner : kOuter)[index];
  k.frame += half * kDanceHalf_frames;
  if (index == kKeys - 1 && half >= 2) k.wrist.z += 0.10 * std::sin(1.9 * half);  // later rounds differ
  return k;
}

// Slope of the monotone cubic (Fritsch and Carlson 1980, harmonic mean): no overshoot between keys.
double slope(double before, double after) {
  return before * after <= 0 ? 0 : 2 * before * after / (before + after);
}

double between(double t, const double (&at)[4], const double (&value)[4]) {
  double secant[3];
  for (int i = 0; i < 3; ++i) secant[i] = (value[i + 1] - value[i]) / (at[i + 1] - at[i]);
  const double h = at[2] - at[1], u = (t - at[1]) / h, m0 = slope(secant[0], secant[1]) * h,
               m1 = slope(secant[1], secant[2]) * h;
  return value[1] + u * (m0 + u * (-2 * m0 - m1 - 3 * (value[1] - value[2]) +
                                   u * (m0 + m1 + 2 * (value[1] - value[2]))));
}

ArmKey armAt(int arm, double frame) {
  const int half = static_cast<int>(std::floor(frame / kDanceHalf_frames));
  int number = half * kKeys;
  while (keyOf(arm, number + 1).frame <= frame) ++number;
  ArmKey k[4];
  double at[4];
  for (int i = 0; i < 4; ++i) k[i] = keyOf(arm, number - 1 + i), at[i] = k[i].frame;
  ArmKey out{frame, {}, {}};
  for (int c = 0; c < 3; ++c) {
    out.wrist[c] = between(frame, at, {k[0].wrist[c], k[1].wrist[c], k[2].wrist[c], k[3].wrist[c]});
    out.elbow_towards[c] =
        between(frame, at,
                {k[0].elbow_towards[c], k[1].elbow_towards[c], k[2].elbow_towards[c], k[3].elbow_towards[c]});
  }
  return out;
}

// Columns: along the bone, the hinge, their cross product.
dmat3 hingeFrame(dvec3 along, dvec3 hinge) {
  const dvec3 h = glm::normalize(hinge - along * glm::dot(along, hinge));
  return dmat3(along, h, glm::cross(along, h));
}

// Two bones to a wrist: the elbow lies in the half plane that `key` names.
void reach(BodyPose& p, bool right, const ArmKey& key) {
  const dvec3 mirror(right ? -1 : 1, 1, 1);
  const int upper = right ? RUpper : LUpper, fore = right ? RFore : LFore, hand = right ? RHand : LHand;
  const dvec3 shoulder(bonePivot(upper)), elbow0(bonePivot(fore)), wrist0(bonePivot(hand));
  const double a = glm::length(elbow0 - shoulder), b = glm::length(wrist0 - elbow0);
  const dvec3 d = key.wrist * mirror - shoulder;
  const double far = std::min(glm::length(d), 0.985 * (a + b)),
               cosine = (a * a + far * far - b * b) / (2 * a * far);
  const dvec3 n = glm::normalize(d), towards = key.elbow_towards * mirror,
              side = glm::normalize(towards - n * glm::dot(n, towards));
  const dvec3 elbow = a * (cosine * n + std::sqrt(1 - cosine * cosine) * side), wrist = far * n;
  const dvec3 along0 = (elbow0 - shoulder) / a, fore0 = (wrist0 - elbow0) / b, along = elbow / a,
              forearm = (wrist - elbow) / b, hinge = glm::cross(along, forearm),
              hinge0 = glm::cross(along0, dvec3(0, -1, 0));
  const dmat3 of_upper = hingeFrame(along, hinge) * glm::transpose(hingeFrame(along0, hinge0)),
              of_fore = hingeFrame(forearm, hinge) * glm::transpose(hingeFrame(fore0, hinge0));
  p.local[upper] = mat3(of_upper);
  p.local[fore] = mat3(glm::transpose(of_upper) * of_fore);
}

// A leg on the ground, or lifted by up to 1.
void stand(BodyPose& p, bool right, double lift) {
  const int thigh = right ? RThigh : LThigh, shin = right ? RShin : LShin, foot = right ? RFoot : LFoot;
  const vec3 x(1, 0, 0), y(0, 1, 0);
  const double hip = -7 - 20 * lift, knee = 12 + 34 * lift, apart = right ? 7 : -7;
  p.local[thigh] = turnAbout(y, apart) * turnAbout(x, hip);
  p.local[shin] = turnAbout(x, knee);
  p.local[foot] = turnAbout(x, -hip - knee + 8 * lift) * turnAbout(y, -apart);
}

constexpr double kTurnStart = 5, kTurnEnd = 29, kRamp = 0.3;  // of a half; the ramp's share of the turn

// Integral of the smooth step from 0, for u in [0, 1].
double smoothStepArea(double u) { return u * u * u * (1 - 0.5 * u); }

// Rises from 0 to 1 with the speed of a trapezoid whose flanks are smooth steps.
double turnShare(double u) {
  u = std::clamp(u, 0.0, 1.0);
  if (u > 0.5) return 1 - turnShare(1 - u);
  const double area = u < kRamp ? kRamp * smoothStepArea(u / kRamp) : 0.5 * kRamp + (u - kRamp);
  return area / (1 - kRamp);
}

}  // namespace

double danceYaw_deg(double frame) {
  const double half = std::floor(frame / kDanceHalf_frames), t = frame - half * kDanceHalf_frames;
  return 180 * (half + turnShare((t - kTurnStart) / (kTurnEnd - kTurnStart)));
}

BodyPose danceAt(double frame) {
  BodyPose p;
  const vec3 x(1, 0, 0), z(0, 0, 1);
  const double yaw = danceYaw_deg(frame), speed = danceYaw_deg(frame + 0.5) - danceYaw_deg(frame - 0.5);
  const auto slow = [&](double period) { return std::sin(kTau * frame / period); };
  const double step = std::sin(kTau * yaw / 120);  // a step every 60 degrees, left and right in turn
  stand(p, false, std::max(0.0, step) * std::max(0.0, step));
  stand(p, true, std::min(0.0, step) * std::min(0.0, step));
  p.local[Root] = turnAbout(z, yaw);
  p.local[Chest] = turnAbout(z, 1.1 * speed + 3 * slow(127)) * turnAbout(x, 2 + 0.4 * speed + 2 * slow(173));
  p.local[Head] = turnAbout(z, 1.3 * speed + 9 * slow(91)) * turnAbout(x, 3 + 3 * slow(67));
  reach(p, false, armAt(0, frame));
  reach(p, true, armAt(1, frame));
  // The lower ankle stands on the ground; the other foot is lifted only while it does.
  const PosedBones placed = placeBones(p);
  const auto ankle = [&](int foot) {
    return (placed.rotation[foot] * bonePivot(foot) + placed.translation[foot]).z - bonePivot(foot).z;
  };
  p.root_shift.z = -std::min(ankle(LFoot), ankle(RFoot));
  return p;
}

}  // namespace beam
