// SPDX-License-Identifier: Apache-2.0
// Triangle meshes, plain point clouds and poses as PLY, ASCII or binary of either byte order on reading,
// binary little-endian on writing.
#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/io/ply_file.h"
#include "core/io/written_by.h"
#include "core/scene/capture.h"
#include "core/scene/mesh.h"
#include "core/scene/pose.h"

namespace beam {

// Normals and texture positions as nx ny nz and s t, where every vertex has some; notes as
// comments. Throws Error{Data} before
// anything is written where a reader would refuse it for its rows. `progress` is asked whether to stop.
struct MeshPlyWriting {
  std::size_t most_rows = kMostPlyRows;
  const Progress* progress = nullptr;
  FileNotes notes = {};
};
void writeMeshPly(const std::filesystem::path& path, const Mesh& mesh, const MeshPlyWriting& how = {});
void writePointsPly(const std::filesystem::path& path, const PointCloud& points);

// Polygons are fanned; a file without faces gives a mesh without triangles. Counts are checked against the
// bytes. Texture positions may also be called u v or texture_u texture_v; t points up in the file.
Mesh readMeshPly(const std::filesystem::path& path, std::size_t most_rows = kMostPlyRows);
PointCloud readPointsPly(const std::filesystem::path& path);

// x y z and rot_0..3 (w x y z), as a splat PLY names them.
void writePosePly(const std::filesystem::path& path, const Pose& pose);
Pose readPosePly(const std::filesystem::path& path);

}  // namespace beam
