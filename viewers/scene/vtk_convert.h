// SPDX-License-Identifier: Apache-2.0
// Values of the scene as VTK geometry with one 8-bit colour a point. World axes and metres stay as they are.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <array>

#include "core/scene/capture.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/mesh.h"

namespace beam {

using PolyData = vtkSmartPointer<vtkPolyData>;

inline constexpr u8vec3 kTrainColor(92, 158, 255), kTestColor(255, 168, 76), kMarkColor(255, 244, 150);

// A pyramid of four corner rays with a tick at the picture's top: the eye, the corners from the upper left
// one on, the tick's tip.
using Frustum = std::array<vec3, 6>;
Frustum frustumOf(const Camera& camera, double length_m);
inline constexpr std::array<std::array<int, 2>, 10> kFrustumEdges{
    {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {5, 2}}};

// `marked`: that one alone, in the colour of marks; -1: all of them by their split.
PolyData frustaOf(const std::vector<View>& views, double length_m, int marked = -1);
PolyData pointsOf(const PointCloud& cloud);
PolyData meshOf(const Mesh& mesh);

// The largest `most` Gaussians (by opacity and cross-section) as ellipsoids of `sigmas` standard deviations.
// `influence`: shares in [0, 1] in false colours instead of their own; empty: none. `splits` halves the edges
// of an octahedron: eight triangles each, four times as many with every split.
PolyData ellipsoidsOf(const GaussianCloud& cloud, std::size_t most, float sigmas,
                      const std::vector<float>& influence = {}, int splits = 2);

// Where the joints were: by moment, oldest first, in the same order; the last is shown.
using JointTrails = std::vector<std::vector<vec3>>;
// The joints as points and their ways as lines that fade into the past; -1: all of them alike. Otherwise the
// picked one's way alone is left, so that its influence on the skin is seen, and of the others faint points
// if `others`.
PolyData jointsOf(const JointTrails& trails, int picked, bool others = true);

// A floor of `cell_m` cells at y = 0 and the three axes, x red, y green, z blue.
PolyData gridAndAxes(float extent_m, float cell_m);

}  // namespace beam
