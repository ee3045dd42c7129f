// SPDX-License-Identifier: Apache-2.0
// A panorama that is seen past what stands in its way: visibility V(w) = 0.5 + sum_k Y_k(w) c_k in place of
// the paper's one number of occlusion, so that each light casts its own shadow (methods 7.8).
#pragma once

#include <array>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/math/sh.h"
#include "core/math/sh_rotation.h"
#include "core/math/types.h"

namespace beam {

// c_k of a surface, in the axes of a panorama.
using Visibility = std::array<float, kShCount>;

// T_k(n) = integral of L(w) Y_k(w) max(0, n.w) dw, scene-linear, lat-long over n; plain data that a shader
// can read as well.
struct TransferTables {
  int width = 0, height = 0;
  std::vector<std::array<vec3, kShCount>> texels;  // row after row
  bool empty() const { return texels.empty(); }
};

// Throws Cancelled when the progress is stopped.
TransferTables prepareTransfer(const Image<vec3>& panorama, const Progress& progress = Progress{});

// E_V(n): what of the irradiance `open` = E(n) arrives, clamped to [0, open]; V = 1 gives `open` itself.
vec3 seenIrradiance(const TransferTables& tables, vec3 normal, const Visibility& visibility, vec3 open);

// V averaged over the specular lobe of `roughness` about `mirror`, in [0, 1].
float seenHighlight(const Visibility& visibility, vec3 mirror, float roughness);

}  // namespace beam
