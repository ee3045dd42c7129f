// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gaussian_cloud.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/error.h"

namespace beam {
namespace {

void checkLength(std::string_view what, std::size_t found, std::size_t expected) {
  if (found == expected) return;
  throw Error(Error::Kind::Data, fmt::format("cloud of {} Gaussians: expected {} {}, found {}", expected,
                                             expected, what, found));
}

void checkFinite(std::string_view what, const std::vector<float>& values, std::size_t perGaussian) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    throw Error(Error::Kind::Data,
                fmt::format("Gaussian {}: expected a finite {}, found {}", i / perGaussian, what, values[i]));
  }
}

void checkGaussian(const GaussianCloud& c, std::size_t i) {
  const auto bad = [&](std::string_view expected) {
    throw Error(Error::Kind::Data, fmt::format("Gaussian {}: expected {}", i, expected));
  };
  const vec3 p = c.position_m[i], s = c.scale_m[i];
  if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) bad("a finite position");
  if (!(s.x > 0 && s.y > 0 && s.z > 0 && std::isfinite(s.x + s.y + s.z))) bad("positive, finite scales");
  if (!(c.opacity[i] > 0 && c.opacity[i] < 1)) bad("an opacity between 0 and 1");
  const float norm = glm::dot(c.rotation[i], c.rotation[i]);
  if (!(std::abs(norm - 1.0f) < 1e-3f)) bad("a unit quaternion");
}

}  // namespace

void validate(const GaussianCloud& c) {
  const std::size_t n = c.size();
  checkLength("rotations", c.rotation.size(), n);
  checkLength("scales", c.scale_m.size(), n);
  checkLength("opacities", c.opacity.size(), n);
  checkLength("colour coefficients", c.color.coefficients.size(), n * kShCount * 3);
  for (std::size_t i = 0; i < n; ++i) checkGaussian(c, i);
  checkFinite("colour coefficient", c.color.coefficients, kShCount * 3);
}

void validate(const Materials& m, const GaussianCloud& cloud) {
  const std::size_t n = cloud.size();
  checkLength("roughness values", m.roughness.size(), n);
  checkLength("base-colour coefficients", m.base_color.coefficients.size(), n * kShCount * 3);
  checkLength("ambient-occlusion coefficients", m.ambient_occlusion.coefficients.size(), n * kShCount);
  for (std::size_t i = 0; i < n; ++i) {
    if (m.roughness[i] >= 0.04f && m.roughness[i] <= 1.0f) continue;
    throw Error(Error::Kind::Data,
                fmt::format("Gaussian {}: expected a roughness in [0.04, 1], found {}", i, m.roughness[i]));
  }
  checkFinite("base-colour coefficient", m.base_color.coefficients, kShCount * 3);
  checkFinite("ambient-occlusion coefficient", m.ambient_occlusion.coefficients, kShCount);
}

}  // namespace beam
