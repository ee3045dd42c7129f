// SPDX-License-Identifier: Apache-2.0
// The paper's reflectance (BEAM eq. 12 and 19; methods 5.4): GGX with height-correlated Smith and Schlick's
// Fresnel, metallic 0. alpha = roughness^2. Scalar; cosines are with the normal unless named otherwise.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/types.h"

namespace beam {

inline constexpr float kF0 = 0.04f;              // BEAM eq. 19
inline constexpr float kLeastRoughness = 0.04f;  // a mirror has no lobe

inline float ggxAlpha(float roughness) { return roughness * roughness; }

inline float ggxDistribution(float cos_h, float alpha) {
  const float a2 = alpha * alpha, d = cos_h * cos_h * (a2 - 1) + 1;
  return a2 / (kPi * d * d);
}

inline float smithLambda(float cosine, float alpha) {
  const float c2 = std::max(cosine * cosine, 1e-8f);
  return 0.5f * (std::sqrt(1 + alpha * alpha * (1 - c2) / c2) - 1);
}
inline float smithG1(float cosine, float alpha) { return 1 / (1 + smithLambda(cosine, alpha)); }
inline float smithG2(float cos_i, float cos_o, float alpha) {
  return 1 / (1 + smithLambda(cos_i, alpha) + smithLambda(cos_o, alpha));
}

inline float schlickFresnel(float cos_half) {
  const float m = std::clamp(1 - cos_half, 0.0f, 1.0f), m2 = m * m;
  return kF0 + (1 - kF0) * m2 * m2 * m;
}

// What one pair of directions gives; both above the horizon.
struct Reflectance {
  float fresnel = 0;         // F(h . omega_o)
  float specular = 0;        // D G F / (4 (n.i)(n.o))
  float reflection_pdf = 0;  // per steradian, of visibleNormal + reflect
};

inline Reflectance reflectance(vec3 normal, vec3 to_light, vec3 to_eye, float alpha) {
  const float cos_i = glm::dot(normal, to_light), cos_o = glm::dot(normal, to_eye);
  const vec3 sum = to_light + to_eye;
  const float length = glm::length(sum);
  if (cos_i <= 0 || cos_o <= 0 || length < 1e-6f) return {kF0, 0, 0};
  const vec3 h = sum / length;
  const float d = ggxDistribution(glm::dot(normal, h), alpha), f = schlickFresnel(glm::dot(h, to_eye));
  const float lambda_o = smithLambda(cos_o, alpha), lambda_i = smithLambda(cos_i, alpha);
  return {f, d * f / ((1 + lambda_i + lambda_o) * 4 * cos_i * cos_o), d / ((1 + lambda_o) * 4 * cos_o)};
}

// What leaves towards the eye of light of irradiance 1 on a surface that faces it.
inline vec3 scattered(const Reflectance& r, vec3 base_color, float cos_i) {
  return (base_color * ((1 - r.fresnel) / kPi) + vec3(r.specular)) * cos_i;
}

}  // namespace beam
