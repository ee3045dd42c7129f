// SPDX-License-Identifier: Apache-2.0
// The few weighted neighbours that a Gaussian hangs on: the joint graph, the
// skin graph and the binding of the skin to the joints are all of this form (methods 3.2, 3.5).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/pose.h"
#include "core/scene/skin_binding.h"

namespace beam {

// dL/d(pose); the rotation's gradient is with respect to the stored quaternion, w x y z.
struct PoseGradient {
  std::vector<vec3> position;
  std::vector<vec4> rotation;

  PoseGradient() = default;
  explicit PoseGradient(std::size_t n) : position(n, vec3(0)), rotation(n, vec4(0)) {}
};

// A graph of neighbours has the form of a binding.
using Anchors = SkinBinding;

// The same pairs seen from the targets, in ascending order: target j owns slots [first[j], first[j + 1]) of
// `slot`, each an index into Anchors::target. Sums over it have a fixed order.
struct AnchorLists {
  std::vector<std::uint32_t> first, slot;
};

// `count` near targets of every point with weights exp(-(d^2 - d_min^2) / length^2), normalised (methods 3.2:
// without d_min a far point divides 0 by 0): the nearest of those that stand `apart_m` from one another, then
// the nearest of the rest. MCMC makes copies at one place, and eight of them would tie a point to nothing but
// themselves. Fewer targets than `count`: as many as there are.
Anchors anchorTo(std::span<const vec3> points, std::span<const vec3> targets, int count, float length_m,
                 float apart_m = 0);
// Likewise of the points among themselves, each without itself, and `apart_m` from itself. Throws Error{Data}
// for fewer than 2 points.
Anchors neighborGraph(std::span<const vec3> points, int count, float length_m, float apart_m = 0);

// Distance of neighbours on the surface that the points lie on, metres: the median distance to the 8th
// nearest over its value on a square lattice. Copies at one place, which MCMC makes, do not count.
double spacingOf(std::span<const vec3> points);

inline constexpr int kSurfaceNeighbors = 8;     // of graphs and bindings (methods 3.2, 3.4)
inline constexpr double kNeighborsApart = 0.5;  // spacings

// The graph of points on a surface: their neighbours, weights of a length of `reach` spacings.
Anchors surfaceGraph(std::span<const vec3> points, double reach);

AnchorLists listsOf(const Anchors& anchors, std::size_t targets);

}  // namespace beam
