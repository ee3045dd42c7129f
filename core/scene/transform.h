// SPDX-License-Identifier: Apache-2.0
// Values in other axes, another unit, or from another origin: positions and sizes follow the similarity,
// rotations, normals and SH bands its turn. A pure turn between axes only exchanges and negates numbers.
#pragma once

#include <string>

#include "core/math/similarity3.h"
#include "core/scene/capture.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/gaussian_sequence.h"
#include "core/scene/mesh.h"

namespace beam {

// Throw Error{Bug} for a mirror, which has no quaternion, and for a scale that is not positive.
GaussianCloud transformed(const GaussianCloud& cloud, const Similarity3& a_from_b);
Materials transformed(const Materials& materials, const Similarity3& a_from_b);
Attribute transformed(const Attribute& attribute, const Similarity3& a_from_b);
Mesh transformed(const Mesh& mesh, const Similarity3& a_from_b);
// Takes the same picture of what went with it: camera axes keep their directions, depth is in a's unit.
Camera transformed(const Camera& camera, const Similarity3& a_from_b);
PointCloud transformed(const PointCloud& points, const Similarity3& a_from_b);
// A unit of length there: "m", "0.001 m".
std::string lengthUnit(const Similarity3& a_from_world);
// What single precision costs positions that are brought there, a sentence; empty where it is no loss.
std::string roundingWarning(const Similarity3& capture_from_world);
// Its capture_from_world goes back all the way.
CaptureSet transformed(CaptureSet capture, const Similarity3& a_from_b);

}  // namespace beam
