// SPDX-License-Identifier: Apache-2.0
// Gaussians of one frame, structure of arrays, physical values: logits and logs live only inside the
// optimiser and in the splat PLY dialect.
#pragma once

#include <vector>

#include "core/math/sh.h"
#include "core/math/types.h"

namespace beam {

// Degree-3 spherical harmonics of every Gaussian: coefficients[(gaussian * kShCount + k) * channels +
// channel]. value(d) = 0.5 + sum_k basis_k(d) coefficient_k (methods 1.2).
struct ShBlock {
  int channels = 3;
  std::vector<float> coefficients;

  ShBlock() = default;
  ShBlock(std::size_t gaussians, int c) : channels(c), coefficients(gaussians * kShCount * c, 0.0f) {}
  float* of(std::size_t gaussian) { return coefficients.data() + gaussian * kShCount * channels; }
  const float* of(std::size_t gaussian) const { return coefficients.data() + gaussian * kShCount * channels; }
};

// All arrays have size() entries.
struct GaussianCloud {
  std::vector<vec3> position_m;
  std::vector<quat> rotation;  // world_from_gaussian, unit
  std::vector<vec3> scale_m;   // standard deviations, > 0
  std::vector<float> opacity;  // in (0, 1)
  ShBlock color;               // 3 channels, sRGB-encoded radiance as photographed

  std::size_t size() const { return position_m.size(); }
};

struct Materials {
  std::vector<float> roughness;               // [0.04, 1]; GGX alpha = roughness^2
  ShBlock base_color = ShBlock(0, 3);         // scene-linear Rec.709
  ShBlock ambient_occlusion = ShBlock(0, 1);  // share of the sky that is seen, [0, 1] after blending
};

// Throw Error{Data} that names the first bad index.
void validate(const GaussianCloud& cloud);
void validate(const Materials& materials, const GaussianCloud& cloud);

}  // namespace beam
