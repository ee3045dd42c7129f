// SPDX-License-Identifier: Apache-2.0
#include "core/render/deferred.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/brdf.h"
#include "core/render/prepared_light.h"

namespace beam {
namespace {

constexpr float kVisible = 1 / 255.0f;
constexpr float kDiffuseShare =
    0.955f;                          // k_d: what (1 - F) leaves, averaged over the hemisphere (methods 7.2)
constexpr float kDegenerate = 0.1f;  // |sum w n| below this share of alpha is no normal (methods 7.1)
enum Extra { kBaseColor = 0, kOcclusion = 3, kRoughness = 4, kExtraCount = 5 };

vec3 triple(const Planes& p, std::size_t i) { return {p.plane(0)[i], p.plane(1)[i], p.plane(2)[i]}; }

dvec3 rayThrough(const Camera& camera, std::size_t pixel) {
  const std::size_t x = pixel % camera.width, y = pixel / camera.width;
  return rayOf(camera.intrinsics, {static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5});
}

// Unit, world; the direction to the camera where the blended normals cancel out.
vec3 resolveNormal(vec3 blended, float alpha, const Camera& camera, std::size_t pixel) {
  const dquat world_from_camera = glm::conjugate(camera.camera_from_world.rotation);
  const float length = glm::length(blended);
  const dvec3 n =
      length < kDegenerate * alpha ? -glm::normalize(rayThrough(camera, pixel)) : dvec3(blended / length);
  return vec3(glm::normalize(world_from_camera * n));
}

struct Surface {
  vec3 base_color;
  float occlusion, roughness;
  vec3 normal, to_eye;
};

// GTAO's fit of light that bounces between surfaces of the same colour (methods 5.11).
vec3 multibounce(float a, vec3 rho) {
  const vec3 x = 2.0404f * rho - 0.3324f, y = -4.7951f * rho + 0.6417f, z = 2.7552f * rho + 0.6903f;
  return glm::max(vec3(a), ((a * x + y) * a + z) * a);
}

// Lagarde's specular occlusion (methods 7.2).
float specularOcclusion(float n_dot_v, float occlusion, float roughness) {
  const float power = std::exp2(-16 * roughness - 1);
  return std::clamp(std::pow(n_dot_v + occlusion, power) - 1 + occlusion, 0.0f, 1.0f);
}

vec3 radiance(const Surface& s, const PreparedLight& light, const ShadeOptions& o) {
  const float n_dot_v = std::clamp(glm::dot(s.normal, s.to_eye), 1e-3f, 1.0f);
  const vec3 occlusion = o.multibounce_ao ? multibounce(s.occlusion, s.base_color) : vec3(s.occlusion);
  const vec3 diffuse = kDiffuseShare / kPi * s.base_color * light.irradiance(s.normal, o.yaw_rad) * occlusion;
  const vec3 mirror = glm::normalize(2 * glm::dot(s.normal, s.to_eye) * s.normal - s.to_eye);
  const vec2 ab = splitSum(n_dot_v, s.roughness);
  const float shadow = o.specular_occlusion ? specularOcclusion(n_dot_v, s.occlusion, s.roughness) : 1.0f;
  return diffuse + shadow * (kF0 * ab.x + ab.y) * light.prefiltered(mirror, s.roughness, o.yaw_rad);
}

}  // namespace

GBufferRenderer::GBufferRenderer(ComputeDevice& device, std::size_t kept_sizes)
    : rasterizers_(device, kept_sizes) {}

GBuffer GBufferRenderer::render(const ResidentScene& scene, const Camera& camera) {
  static const std::vector<std::string> kMaterialNames = {kBaseColorName, kOcclusionName, kRoughnessName};
  const bool materials = std::all_of(kMaterialNames.begin(), kMaterialNames.end(),
                                     [&](const std::string& name) { return scene.has(name); });
  Rasterizer& rasterizer = rasterizers_.of({.width = camera.width,
                                            .height = camera.height,
                                            .color = true,
                                            .geometry = true,
                                            .extra_channels = materials ? kExtraCount : 0});
  RasterImages& images = images_;
  rasterizer.forward(scene, materials ? kMaterialNames : std::vector<std::string>(), camera, vec3(0), images);

  const int w = camera.width, h = camera.height;
  GBuffer g;
  g.alpha = Image<float>(w, h);
  g.depth_m = Image<float>(w, h);
  g.normal_world = Image<vec3>(w, h);
  g.radiance = Image<vec3>(w, h, vec3(0), Encoding::Srgb);
  if (materials) {
    g.base_color = Image<vec3>(w, h, vec3(0), Encoding::Linear);
    g.ambient_occlusion = Image<float>(w, h);
    g.roughness = Image<float>(w, h);
  }
  parallelFor(h, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * w; i < end * w; ++i) {
      const float alpha = images.alpha.values[i];
      g.alpha.pixels[i] = alpha;
      g.radiance.pixels[i] = triple(images.color, i);
      if (alpha >= 0.5f) g.depth_m.pixels[i] = images.median_depth.values[i];
      if (alpha >= kVisible)
        g.normal_world.pixels[i] = resolveNormal(triple(images.normal, i), alpha, camera, i);
      if (!materials) continue;
      // Clamped after blending, not per Gaussian (methods 5.10).
      g.base_color.pixels[i] = glm::clamp(triple(images.extra, i), 0.0f, 1.0f);
      g.ambient_occlusion.pixels[i] = std::clamp(images.extra.plane(kOcclusion)[i], 0.0f, 1.0f);
      g.roughness.pixels[i] = std::clamp(images.extra.plane(kRoughness)[i], 0.0f, 1.0f);
    }
  });
  return g;
}

Image<vec3> shade(const GBuffer& g, const Camera& camera, const PreparedLight& light,
                  const ShadeOptions& options) {
  if (g.base_color.empty() || g.ambient_occlusion.empty() || g.roughness.empty()) {
    throw Error(Error::Kind::Bug,
                "shade: expected a G-buffer with base colour, ambient occlusion and roughness");
  }
  const dquat world_from_camera = glm::conjugate(camera.camera_from_world.rotation);
  Image<vec3> out(g.alpha.width, g.alpha.height, vec3(0), Encoding::Linear);
  parallelFor(out.height, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * out.width; i < end * out.width; ++i) {
      const float alpha = g.alpha.pixels[i];
      if (alpha < kVisible) continue;
      const Surface s{.base_color = glm::clamp(g.base_color.pixels[i] / alpha, 0.0f, 1.0f),
                      .occlusion = std::clamp(g.ambient_occlusion.pixels[i] / alpha, 0.0f, 1.0f),
                      .roughness = std::clamp(g.roughness.pixels[i] / alpha, 0.04f, 1.0f),
                      .normal = g.normal_world.pixels[i],
                      .to_eye = vec3(-glm::normalize(world_from_camera * rayThrough(camera, i)))};
      out.pixels[i] = options.exposure * alpha * radiance(s, light, options);
    }
  });
  return out;
}

}  // namespace beam
