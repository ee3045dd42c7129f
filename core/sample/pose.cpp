// SPDX-License-Identifier: Apache-2.0
#include "core/sample/pose.h"

#include <cmath>

namespace beam {
namespace {

using namespace bone;

struct BoneRest {
  int parent;
  vec3 pivot;
};
const std::array<BoneRest, Count> kSkeleton = {{{-1, {0, 0, 0.95f}},
                                                {Root, {0, 0, 1.08f}},
                                                {Chest, {0, 0.01f, 1.49f}},
                                                {Chest, {0.185f, 0, 1.41f}},
                                                {LUpper, {0.36f, 0, 1.20f}},
                                                {LFore, {0.51f, -0.02f, 1.01f}},
                                                {Chest, {-0.185f, 0, 1.41f}},
                                                {RUpper, {-0.36f, 0, 1.20f}},
                                                {RFore, {-0.51f, -0.02f, 1.01f}},
                                                {Root, {0.095f, 0, 0.91f}},
                                                {LThigh, {0.115f, 0, 0.50f}},
                                                {LShin, {0.125f, 0.01f, 0.09f}},
                                                {Root, {-0.095f, 0, 0.91f}},
                                                {RThigh, {-0.115f, 0, 0.50f}},
                                                {RShin, {-0.125f, 0.01f, 0.09f}}}};

}  // namespace

vec3 bonePivot(int bone) { return kSkeleton[bone].pivot; }

mat3 turnAbout(vec3 axis, double degrees) {
  return mat3(
      glm::mat3_cast(glm::angleAxis(static_cast<float>(glm::radians(degrees)), glm::normalize(axis))));
}

PosedBones placeBones(const BodyPose& pose) {
  PosedBones out;
  for (int i = 0; i < Count; ++i) {
    const BoneRest& b = kSkeleton[i];
    const mat3 parent = b.parent < 0 ? mat3(1.0f) : out.rotation[b.parent];
    const vec3 shift = b.parent < 0 ? pose.root_shift : out.translation[b.parent];
    out.rotation[i] = parent * pose.local[i];
    out.translation[i] = parent * b.pivot + shift - out.rotation[i] * b.pivot;
  }
  return out;
}

BodyPose portraitPose() {
  BodyPose p;
  const double arms = 0.5 - 0.5 * std::cos(2 * 3.14159265358979 * 0.16);
  const vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  p.root_shift = vec3(0, 0, -0.03f);
  p.local[Chest] = turnAbout(z, 10 * std::sin(0.6)) * turnAbout(x, 4);
  p.local[Head] = turnAbout(x, 5);
  p.local[LUpper] =
      turnAbout(z, -25 - 45 * arms) * turnAbout(x, -40 - 15 * arms) * turnAbout(y, -6 + 10 * (1 - arms));
  p.local[LFore] = turnAbout(z, -30 - 25 * arms) * turnAbout(x, -45 - 25 * arms);
  p.local[RUpper] =
      turnAbout(z, 35 + 30 * (1 - arms)) * turnAbout(x, -25 - 30 * (1 - arms)) * turnAbout(y, 8);
  p.local[RFore] = turnAbout(z, 25 + 20 * (1 - arms)) * turnAbout(x, -50);
  p.local[LThigh] = turnAbout(x, -12) * turnAbout(y, -9);
  p.local[LShin] = turnAbout(x, 16);
  p.local[LFoot] = turnAbout(x, -6);
  p.local[RThigh] = turnAbout(x, 6) * turnAbout(y, 9);
  p.local[RShin] = turnAbout(x, 10);
  p.local[RFoot] = turnAbout(x, -10);
  return p;
}

}  // namespace beam
