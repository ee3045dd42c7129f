// SPDX-License-Identifier: Apache-2.0
// Deferred rendering on the CPU: Gaussians to a G-buffer (methods 7.1), G-buffer and light to a picture
// (methods 7.2: SH irradiance, split-sum specular, AO, specular occlusion). Later shaders must match it.
#pragma once

#include <array>
#include <memory>

#include "core/render/device.h"
#include "core/render/rasterizer_cache.h"
#include "core/scene/environment.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/gbuffer.h"

namespace beam {

// G-buffer of a view: everything that the scene's attributes can give, materials where every instance has
// some. Keeps its rasterisers between calls of `kept_sizes` sizes.
class GBufferRenderer {
 public:
  explicit GBufferRenderer(ComputeDevice& device, std::size_t kept_sizes = 1);
  GBuffer render(const ResidentScene& scene, const Camera& camera);

 private:
  RasterizerCache rasterizers_;
  RasterImages images_;
};

// A panorama prepared for shading: irradiance SH, GGX-prefiltered levels, split-sum table. Preparing takes a
// moment (parallel); shading many views with it does not. Turning the light (yaw) needs no new preparation.
class PreparedLight {
 public:
  explicit PreparedLight(const Environment& environment);
  ~PreparedLight();
  PreparedLight(PreparedLight&&) noexcept;
  PreparedLight& operator=(PreparedLight&&) noexcept;
  vec3 irradiance(vec3 normal, float yaw_rad) const;  // E(n)
  vec3 prefiltered(vec3 direction, float roughness, float yaw_rad) const;
  vec3 background(vec3 direction, float yaw_rad) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct ShadeOptions {
  float yaw_rad = 0;               // turns the light about +Y
  float exposure = 1;              // linear factor before encoding
  bool multibounce_ao = true;      // GTAO's coloured fit (methods 5.11)
  bool specular_occlusion = true;  // Lagarde (methods 7.2)
};

// Linear relit radiance x alpha (premultiplied, black background).
Image<vec3> shade(const GBuffer& gbuffer, const Camera& camera, const PreparedLight& light,
                  const ShadeOptions& options);

}  // namespace beam
