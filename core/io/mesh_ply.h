// SPDX-License-Identifier: Apache-2.0
// Triangle meshes, plain point clouds and poses as PLY, ASCII or binary of either byte order on reading,
// binary little-endian on writing.
#pragma once

#include <filesystem>

#include "core/scene/capture.h"
#include "core/scene/mesh.h"
#include "core/scene/pose.h"

namespace beam {

void writeMeshPly(const std::filesystem::path& path, const Mesh& mesh);
void writePointsPly(const std::filesystem::path& path, const PointCloud& points);

// Polygons are fanned; a file without faces gives a mesh without triangles. Counts are checked against the
// bytes.
Mesh readMeshPly(const std::filesystem::path& path);
PointCloud readPointsPly(const std::filesystem::path& path);

// x y z and rot_0..3 (w x y z), as a splat PLY names them.
void writePosePly(const std::filesystem::path& path, const Pose& pose);
Pose readPosePly(const std::filesystem::path& path);

}  // namespace beam
