// SPDX-License-Identifier: Apache-2.0
// Signed normals and visibility of a frame's Gaussians as a PLY table: nx ny nz, then beam_visibility_dc_0
// and beam_visibility_rest_0 .. 14 (degree-3 SH, value = 0.5 + SH), a row a Gaussian in the order of the
// frame's splat file.
#pragma once

#include <filesystem>
#include <vector>

#include "core/scene/gaussian_cloud.h"

namespace beam {

struct VisibilityFile {
  std::vector<vec3> normal;            // unit, world
  ShBlock visibility = ShBlock(0, 1);  // world axes
};

// Bytes depend on the values alone.
void writeVisibilityPly(const std::filesystem::path& path, const VisibilityFile& file);
// Throws Error{Data} that names the file: a column is missing, a value is not finite.
VisibilityFile readVisibilityPly(const std::filesystem::path& path);

}  // namespace beam
