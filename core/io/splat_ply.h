// SPDX-License-Identifier: Apache-2.0
// The splat PLY dialect of 3DGS, the only file that knows its logits and logs: 62 columns that viewers read,
// then ours (roughness, metallic, base_color_dc/rest, ao_dc/rest).
#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "core/io/written_by.h"
#include "core/scene/gaussian_cloud.h"

namespace beam {

struct SplatFile {
  GaussianCloud cloud;
  std::optional<Materials> materials;
  int sh_degree = 3;  // as stored
};

// Bytes depend on the values alone: no name, path or time enters them. `normal_sides`: by which a Gaussian's
// thinnest axis times 1 or -1 is its normal (kNormalSideName); empty: it points away from the middle of the
// cloud.
void writeSplatPly(const std::filesystem::path& path, const GaussianCloud& cloud, const Materials* materials,
                   const FileNotes& notes = {}, std::span<const float> normal_sides = {});
SplatFile readSplatPly(const std::filesystem::path& path);

}  // namespace beam
