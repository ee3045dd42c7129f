// SPDX-License-Identifier: Apache-2.0
#include "core/method/interpolate_skin.h"

#include <fmt/format.h>

#include <cmath>
#include <queue>
#include <span>
#include <tuple>

#include "core/base/error.h"
#include "core/method/joint_warp.h"

namespace beam {
namespace {

constexpr double kSureCosine = 0.5;  // of half the angle: shorter turns than 120 degrees need no neighbours
constexpr double kLeastSine = 1e-7;  // of half the angle: below it a screw is a shift
constexpr int kNeighbors = 8;
constexpr float kAnyReach_m = 1;  // weights of the graph are not used

void demandSame(std::size_t a, std::size_t b, const char* what) {
  if (a == b) return;
  throw Error(Error::Kind::Data,
              fmt::format("cannot interpolate between frames of {} and {} {}: expected the same in both", a,
                          b, what));
}

vec3 mixed(vec3 a, vec3 b, float share) { return (1 - share) * a + share * b; }
float mixed(float a, float b, float share) { return (1 - share) * a + share * b; }

template <class T>
std::vector<T> mixed(const std::vector<T>& a, const std::vector<T>& b, float share) {
  std::vector<T> out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = mixed(a[i], b[i], share);
  return out;
}

ShBlock mixed(const ShBlock& a, const ShBlock& b, float share) {
  demandSame(a.coefficients.size(), b.coefficients.size(), "coefficients");
  ShBlock out = a;
  out.coefficients = mixed(a.coefficients, b.coefficients, share);
  return out;
}

quat turned(quat a, quat b, float share) {
  return glm::normalize(glm::slerp(glm::normalize(a), glm::normalize(b), share));
}

Pose mixed(const Pose& a, const Pose& b, float share) {
  Pose out{mixed(a.position_m, b.position_m, share), std::vector<quat>(a.size())};
  for (std::size_t i = 0; i < out.size(); ++i) out.rotation[i] = turned(a.rotation[i], b.rotation[i], share);
  return out;
}

// Signs of the turns: the shorter way where that is clear, else the side of the neighbour that is nearest in
// turning, from the clear ones outwards.
void takeSides(std::vector<dquat>& turns, std::span<const vec3> at) {
  struct Link {
    double agreement;
    std::size_t from, to;
    // Ties by index: one order only.
    bool operator<(const Link& o) const {
      return std::tuple(agreement, o.from, o.to) < std::tuple(o.agreement, from, to);
    }
  };
  std::vector<bool> decided(turns.size());
  bool all = true;
  for (std::size_t k = 0; k < turns.size(); ++k) {
    if (turns[k].w < 0) turns[k] = -turns[k];
    decided[k] = turns[k].w >= kSureCosine;
    all = all && decided[k];
  }
  if (all || turns.size() < 2) return;
  const Anchors graph = neighborGraph(at, kNeighbors, kAnyReach_m);
  const AnchorLists lists = listsOf(graph, turns.size());
  const auto n = static_cast<std::size_t>(graph.per_point);
  std::priority_queue<Link> links;
  const auto reach = [&](std::size_t k) {
    const auto link = [&](std::size_t to) {
      if (!decided[to]) links.push({std::abs(glm::dot(turns[k], turns[to])), k, to});
    };
    for (std::size_t s = k * n; s < (k + 1) * n; ++s) link(graph.target[s]);
    for (std::uint32_t l = lists.first[k]; l < lists.first[k + 1]; ++l) link(lists.slot[l] / n);
  };
  for (std::size_t k = 0; k < turns.size(); ++k) {
    if (decided[k]) reach(k);
  }
  // A part without any clear joint goes the way of its first.
  for (std::size_t k = 0;; ++k) {
    while (!links.empty()) {
      const Link link = links.top();
      links.pop();
      if (decided[link.to]) continue;
      if (glm::dot(turns[link.from], turns[link.to]) < 0) turns[link.to] = -turns[link.to];
      decided[link.to] = true;
      reach(link.to);
    }
    while (k < turns.size() && decided[k]) ++k;
    if (k == turns.size()) return;
    decided[k] = true;
    reach(k);
  }
}

struct Step {
  dvec3 shift;
  dquat turn;
};

// The part `share` of the screw with this turn that shifts its joint by `whole`.
Step partOf(const dquat& turn, const dvec3& whole, double share) {
  const dvec3 v(turn.x, turn.y, turn.z);
  const double sine = glm::length(v);
  if (sine < kLeastSine) return {share * whole, dquat(1, 0, 0, 0)};
  const double half = std::atan2(sine, turn.w), angle = 2 * half * share;
  const dvec3 axis = v / sine;
  const dvec3 along = glm::dot(axis, whole) * axis, across = whole - along;
  // An arc about the screw's axis from 0 to `across`, written without its centre, which is far away where the
  // turn is small.
  const dvec3 arc = (std::sin(half) + std::sin(angle - half)) / (2 * sine) * across +
                    (std::cos(half) - std::cos(angle - half)) / (2 * sine) * glm::cross(axis, across);
  return {share * along + arc, glm::angleAxis(angle, axis)};
}

// What a frame's Gaussians are away from their joints' warp, in axes that turn with it.
Pose leftOver(const Pose& warped, const GaussianCloud& cloud) {
  Pose out{std::vector<vec3>(cloud.size()), std::vector<quat>(cloud.size())};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const quat back = glm::conjugate(glm::normalize(warped.rotation[i]));
    out.position_m[i] = back * (cloud.position_m[i] - warped.position_m[i]);
    out.rotation[i] = back * cloud.rotation[i];
  }
  return out;
}

}  // namespace

Pose interpolateJoints(const Pose& a, const Pose& b, double share) {
  demandSame(a.size(), b.size(), "joints");
  std::vector<dquat> turns(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    turns[k] = glm::normalize(dquat(b.rotation[k])) * glm::conjugate(glm::normalize(dquat(a.rotation[k])));
  }
  takeSides(turns, a.position_m);
  Pose out = a;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Step step = partOf(turns[k], dvec3(b.position_m[k]) - dvec3(a.position_m[k]), share);
    out.position_m[k] = vec3(dvec3(a.position_m[k]) + step.shift);
    out.rotation[k] = quat(step.turn * glm::normalize(dquat(a.rotation[k])));
  }
  return out;
}

GaussianCloud interpolateSkin(const CarriedSkin& a, const CarriedSkin& b, const Pose& rest_joints,
                              double share) {
  demandSame(a.cloud.size(), b.cloud.size(), "Gaussians");
  demandSame(a.rest_skin.size(), a.cloud.size(), "Gaussians");
  demandSame(b.rest_skin.size(), b.cloud.size(), "Gaussians");
  demandSame(a.joints.size(), rest_joints.size(), "joints");
  demandSame(b.joints.size(), rest_joints.size(), "joints");
  const auto part = static_cast<float>(share);
  JointWarp warp(a.rest_skin, rest_joints, boundTo(a.rest_skin, rest_joints));
  const Pose left_a = leftOver(warp.skin(a.joints), a.cloud);
  warp.setRestSkin(b.rest_skin);
  const Pose left_b = leftOver(warp.skin(b.joints), b.cloud);
  warp.setRestSkin(mixed(a.rest_skin, b.rest_skin, part));
  Pose skin = warp.skin(interpolateJoints(a.joints, b.joints, share));
  const Pose left = mixed(left_a, left_b, part);
  for (std::size_t i = 0; i < skin.size(); ++i) {
    skin.position_m[i] += glm::normalize(skin.rotation[i]) * left.position_m[i];
    skin.rotation[i] = skin.rotation[i] * left.rotation[i];
  }
  GaussianCloud out{{},
                    {},
                    mixed(a.cloud.scale_m, b.cloud.scale_m, part),
                    mixed(a.cloud.opacity, b.cloud.opacity, part),
                    mixed(a.cloud.color, b.cloud.color, part)};
  setPose(out, skin);
  return out;
}

Materials interpolateMaterials(const Materials& a, const Materials& b, double share) {
  demandSame(a.roughness.size(), b.roughness.size(), "Gaussians");
  const auto part = static_cast<float>(share);
  return {mixed(a.roughness, b.roughness, part), mixed(a.base_color, b.base_color, part),
          mixed(a.ambient_occlusion, b.ambient_occlusion, part)};
}

ShBlock interpolateSh(const ShBlock& a, const ShBlock& b, double share) {
  return mixed(a, b, static_cast<float>(share));
}

}  // namespace beam
