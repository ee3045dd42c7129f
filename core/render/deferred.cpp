// SPDX-License-Identifier: Apache-2.0
#include "core/render/deferred.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/brdf.h"
#include "core/render/pixel_rays.h"

namespace beam {
namespace {

constexpr float kDiffuseShare =
    0.955f;                          // k_d: what (1 - F) leaves, averaged over the hemisphere (methods 7.2)
constexpr float kDegenerate = 0.1f;  // |sum w n| below this share of alpha is no normal (methods 7.1)
enum Extra { kBaseColor = 0, kOcclusion = 3, kRoughness = 4, kExtraCount = 5 };

vec3 triple(const Planes& p, std::size_t i, int first = 0) {
  return {p.plane(first)[i], p.plane(first + 1)[i], p.plane(first + 2)[i]};
}

void put(Planes& p, std::size_t i, vec3 v) {
  for (int c = 0; c < 3; ++c) p.plane(c)[i] = v[c];
}

// Room for `channels` planes of the view's size; the values are whatever they were.
void shape(const Planes& like, int channels, Planes& out) {
  if (out.width == like.width && out.height == like.height && out.channels == channels) return;
  out = Planes(like.width, like.height, channels);
}

// body(x, y, pixel) for every pixel, in parallel by rows.
template <class Body>
void forPixels(int width, int height, Body&& body) {
  parallelFor(height, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      for (int x = 0; x < width; ++x) body(x, static_cast<int>(y), y * width + x);
    }
  });
}

// Unit, world; the direction to the camera where the blended normals cancel out.
vec3 resolveNormal(vec3 blended, float alpha, const PixelRays& rays, int x, int y) {
  const float length = glm::length(blended);
  const dvec3 n =
      length < kDegenerate * alpha ? -glm::normalize(rays.through(x, y)) : dvec3(blended / length);
  return vec3(glm::normalize(rays.worldFromCamera() * n));
}

float clampedShare(float v) { return std::clamp(v, 0.0f, 1.0f); }

struct Surface {
  vec3 base_color;
  float occlusion, roughness;
  vec3 normal, to_eye;
  const Visibility* visibility = nullptr;  // null: the occlusion holds in its place
  const TransferTables* tables = nullptr;  // as LightTurn gives them, with a visibility
};

// GTAO's fit of light that bounces between surfaces of the same colour (methods 5.11).
vec3 multibounce(vec3 a, vec3 rho) {
  const vec3 x = 2.0404f * rho - 0.3324f, y = -4.7951f * rho + 0.6417f, z = 2.7552f * rho + 0.6903f;
  return glm::max(a, ((a * x + y) * a + z) * a);
}

// Lagarde's specular occlusion (methods 7.2).
float specularOcclusion(float n_dot_v, float occlusion, float roughness) {
  const float power = std::exp2(-16 * roughness - 1);
  return std::clamp(std::pow(n_dot_v + occlusion, power) - 1 + occlusion, 0.0f, 1.0f);
}

// The surface that values x alpha were blended of.
Surface surfaceOf(vec3 base_color, float occlusion, float roughness, float alpha, vec3 normal, vec3 to_eye) {
  return {.base_color = glm::clamp(base_color / alpha, 0.0f, 1.0f),
          .occlusion = clampedShare(occlusion / alpha),
          .roughness = std::clamp(roughness / alpha, kLeastRoughness, 1.0f),
          .normal = normal,
          .to_eye = to_eye};
}

// A lobe that a disc widens: by the variance of half vectors to it, theta^2 / 16 along an axis, where alpha^2
// / 2 is that of the slopes.
float widened(float alpha, float half_angle_rad) {
  return std::sqrt(alpha * alpha + half_angle_rad * half_angle_rad / 8);
}

// Of lamps that are part of a panorama: what would come, what comes, what of that is reflected as a
// highlight.
struct LampLight {
  vec3 open{0}, seen{0}, highlight{0};
};
LampLight lampLight(const std::vector<ShadedLamp>& lamps, const Surface& s, vec3 x_m) {
  LampLight sum;
  for (const auto& [source, map] : lamps) {
    const float cosine = glm::dot(s.normal, source.toward);
    const float half_angle = source.half_angle_rad, open = cosineOfDisc(cosine, half_angle);
    if (open <= 0) continue;
    const float seen = map ? map->lightAt(x_m + kShadowOffset_m * s.normal, half_angle) : 1;
    sum.open += open * source.strength;
    sum.seen += seen * open * source.strength;
    if (seen <= 0 || cosine <= 0) continue;
    const Reflectance r =
        reflectance(s.normal, source.toward, s.to_eye, widened(ggxAlpha(s.roughness), half_angle));
    sum.highlight += seen * r.specular * cosine * source.strength;
  }
  return sum;
}

// Without lamps that are apart from `light`: LampLight{}.
vec3 radiance(const Surface& s, const PreparedLight& light, const LightTurn& turn, const LampLight& lamps,
              const ShadeOptions& o) {
  const float n_dot_v = std::clamp(glm::dot(s.normal, s.to_eye), 1e-3f, 1.0f);
  const vec3 normal = turn(s.normal);
  const vec3 mirror = glm::normalize(2 * glm::dot(s.normal, s.to_eye) * s.normal - s.to_eye);
  vec3 open = irradiance(light, normal);
  vec3 seen(s.occlusion);  // the share of `open` that arrives
  float shadow = 1;        // the share of the highlight
  if (s.visibility) {
    seen = seenIrradiance(*s.tables, normal, *s.visibility, open) / glm::max(open, vec3(1e-20f));
    shadow = seenHighlight(*s.visibility, mirror, s.roughness);
  } else if (o.specular_occlusion) {
    shadow = specularOcclusion(n_dot_v, s.occlusion, s.roughness);
  }
  if (lamps.open != vec3(0)) {
    seen = (seen * open + lamps.seen) / (open + lamps.open);
    open += lamps.open;
  }
  const vec3 bounced = o.multibounce_ao ? multibounce(seen, s.base_color) : seen;
  const vec3 diffuse = kDiffuseShare / kPi * s.base_color * open * bounced;
  const vec2 ab = splitSum(n_dot_v, s.roughness);
  return diffuse + lamps.highlight +
         shadow * (kF0 * ab.x + ab.y) * prefiltered(light, turn(mirror), s.roughness);
}

vec3 lampRadiance(const ShadedLamp& lamp, const Surface& s, vec3 x_m) {
  const ArrivingLight light = arrivingAt(lamp.source, x_m);
  const float cosine = glm::dot(s.normal, light.toward);
  if (cosine <= 0 || light.irradiance == vec3(0)) return vec3(0);
  const float seen = lamp.shadow ? lamp.shadow->lightAt(x_m + kShadowOffset_m * s.normal) : 1;
  if (seen <= 0) return vec3(0);
  const Reflectance r = reflectance(s.normal, light.toward, s.to_eye, ggxAlpha(s.roughness));
  return seen * light.irradiance * scattered(r, s.base_color, cosine);
}

}  // namespace

void RasterView::radiance(Planes& out) const { out = images_.color; }

void RasterView::alpha(Planes& out) const { out = images_.alpha; }

void RasterView::depth(Planes& out) const {
  shape(images_.alpha, 1, out);
  forPixels(out.width, out.height, [&](int, int, std::size_t i) {
    out.values[i] = images_.alpha.values[i] >= kDepthAlpha ? images_.median_depth.values[i] : 0;
  });
}

void RasterView::normal(Planes& out) const {
  shape(images_.alpha, 3, out);
  const PixelRays rays(camera_);
  forPixels(out.width, out.height, [&](int x, int y, std::size_t i) {
    const float alpha = images_.alpha.values[i];
    put(out, i,
        alpha >= kVisibleAlpha ? resolveNormal(triple(images_.normal, i), alpha, rays, x, y) : vec3(0));
  });
}

void RasterView::requireMaterials(const char* what) const {
  if (!materials_) throw Error(Error::Kind::Bug, fmt::format("{}: the scene has no materials", what));
}

// Clamped after blending, not per Gaussian (methods 5.10).
void RasterView::share(int channel, int count, Planes& out) const {
  requireMaterials("materials of a view");
  shape(images_.alpha, count, out);
  parallelFor(out.values.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    const float* in = extra(channel);
    for (std::size_t i = begin; i < end; ++i) out.values[i] = clampedShare(in[i]);
  });
}

void RasterView::baseColor(Planes& out) const { share(kBaseColor, 3, out); }
void RasterView::occlusion(Planes& out) const { share(kOcclusion, 1, out); }
void RasterView::roughness(Planes& out) const { share(kRoughness, 1, out); }

void RasterView::attribute(std::string_view name, Planes& out) const {
  const auto found =
      std::find_if(further_.begin(), further_.end(), [&](const Further& f) { return f.name == name; });
  if (found == further_.end())
    throw Error(Error::Kind::Bug, fmt::format("attribute \"{}\" was not drawn", name));
  shape(images_.alpha, found->channels, out);
  std::copy_n(extra(found->first), out.values.size(), out.values.begin());
}

Visibility RasterView::visibilityAt(std::size_t pixel, float alpha) const {
  Visibility v;
  for (int k = 0; k < kShCount; ++k) v[k] = extra(visibility_ + k)[pixel] / alpha;
  return v;
}

template <class Body, class Nothing>
void RasterView::forSurfaces(Body&& body, Nothing&& nothing) const {
  const PixelRays rays(camera_);
  forPixels(images_.alpha.width, images_.alpha.height, [&](int x, int y, std::size_t i) {
    const float alpha = images_.alpha.values[i];
    if (alpha < kVisibleAlpha) return nothing(i);
    const vec3 base_color = glm::clamp(triple(images_.extra, i, kBaseColor), 0.0f, 1.0f);
    const Planes& depth =
        alpha >= kDepthAlpha ? images_.median_depth : images_.depth;  // a fringe has no median
    body(i, alpha,
         surfaceOf(base_color, clampedShare(extra(kOcclusion)[i]), clampedShare(extra(kRoughness)[i]), alpha,
                   resolveNormal(triple(images_.normal, i), alpha, rays, x, y), rays.toEye(x, y)),
         [&] { return rays.at(x, y, depth.values[i]); });
  });
}

void RasterView::relit(const PreparedLight& light, const ShadeOptions& options,
                       const std::vector<ShadedLamp>& lamps, Planes& out) const {
  requireMaterials("relit");
  shape(images_.alpha, 3, out);
  const LightTurn turn(light, options.yaw_rad);
  const bool transfer = options.transfer && hasVisibility();
  const TransferTables tables = transfer ? turn.of(light.transfer) : TransferTables{};
  forSurfaces(
      [&](std::size_t i, float alpha, Surface s, const auto& position) {
        const Visibility visibility = transfer ? visibilityAt(i, alpha) : Visibility{};
        if (transfer) s.visibility = &visibility, s.tables = &tables;
        const LampLight apart = lamps.empty() ? LampLight{} : lampLight(lamps, s, position());
        put(out, i, options.exposure * alpha * beam::radiance(s, light, turn, apart, options));
      },
      [&](std::size_t i) { put(out, i, vec3(0)); });
}

void RasterView::unlit(Planes& out) const {
  shape(images_.alpha, 3, out);
  std::fill(out.values.begin(), out.values.end(), 0.0f);
}

void RasterView::addLamps(const std::vector<ShadedLamp>& lamps, Planes& out) const {
  requireMaterials("lamps");
  forSurfaces(
      [&](std::size_t i, float alpha, const Surface& s, const auto& position) {
        vec3 sum(0);
        const vec3 x_m = position();
        for (const ShadedLamp& lamp : lamps) sum += lampRadiance(lamp, s, x_m);
        put(out, i, triple(out, i) + alpha * sum);
      },
      [](std::size_t) {});
}

GBuffer RasterView::gbuffer() const {
  const int w = images_.alpha.width, h = images_.alpha.height;
  GBuffer g;
  g.alpha = Image<float>(w, h);
  g.depth_m = Image<float>(w, h);
  g.normal_world = Image<vec3>(w, h);
  g.radiance = Image<vec3>(w, h, vec3(0), Encoding::Srgb);
  if (materials_) {
    g.base_color = Image<vec3>(w, h, vec3(0), Encoding::Linear);
    g.ambient_occlusion = Image<float>(w, h);
    g.roughness = Image<float>(w, h);
  }
  const PixelRays rays(camera_);
  forPixels(w, h, [&](int x, int y, std::size_t i) {
    const float alpha = images_.alpha.values[i];
    g.alpha.pixels[i] = alpha;
    g.radiance.pixels[i] = triple(images_.color, i);
    if (alpha >= kDepthAlpha) g.depth_m.pixels[i] = images_.median_depth.values[i];
    if (alpha >= kVisibleAlpha)
      g.normal_world.pixels[i] = resolveNormal(triple(images_.normal, i), alpha, rays, x, y);
    if (!materials_) return;
    g.base_color.pixels[i] = glm::clamp(triple(images_.extra, i, kBaseColor), 0.0f, 1.0f);
    g.ambient_occlusion.pixels[i] = clampedShare(extra(kOcclusion)[i]);
    g.roughness.pixels[i] = clampedShare(extra(kRoughness)[i]);
  });
  return g;
}

GBufferRenderer::GBufferRenderer(ComputeDevice& device, std::size_t kept_sizes)
    : rasterizers_(device, kept_sizes) {}

const RasterView& GBufferRenderer::draw(const ResidentScene& scene, const Camera& camera,
                                        const std::vector<std::string>& further, bool visibility) {
  static const std::vector<std::string> kMaterialNames = {kBaseColorName, kOcclusionName, kRoughnessName};
  view_.camera_ = camera;
  view_.materials_ = std::all_of(kMaterialNames.begin(), kMaterialNames.end(),
                                 [&](const std::string& name) { return scene.has(name); });
  std::vector<std::string> names = view_.materials_ ? kMaterialNames : std::vector<std::string>();
  int count = view_.materials_ ? kExtraCount : 0;
  view_.visibility_ = -1;
  if (visibility && view_.materials_ && scene.has(kVisibilityName)) {
    names.push_back(coefficientsOf(kVisibilityName));
    view_.visibility_ = count;
    count += kShCount;
  }
  view_.further_.clear();
  for (const AttributeInfo& info : scene.attributes()) {
    if (std::find(further.begin(), further.end(), info.name) == further.end()) continue;
    view_.further_.push_back({info.name, count, info.channels});
    names.push_back(info.name);
    count += info.channels;
  }
  rasterizers_
      .of({.width = camera.width,
           .height = camera.height,
           .color = true,
           .geometry = true,
           .extra_channels = count})
      .forward(scene, names, camera, vec3(0), view_.images_);
  return view_;
}

Image<vec3> shade(const GBuffer& g, const Camera& camera, const PreparedLight& light,
                  const ShadeOptions& options) {
  if (g.base_color.empty() || g.ambient_occlusion.empty() || g.roughness.empty()) {
    throw Error(Error::Kind::Bug,
                "shade: expected a G-buffer with base colour, ambient occlusion and roughness");
  }
  const PixelRays rays(camera);
  const LightTurn turn(light, options.yaw_rad);
  Image<vec3> out(g.alpha.width, g.alpha.height, vec3(0), Encoding::Linear);
  forPixels(out.width, out.height, [&](int x, int y, std::size_t i) {
    const float alpha = g.alpha.pixels[i];
    if (alpha < kVisibleAlpha) return;
    const Surface s = surfaceOf(g.base_color.pixels[i], g.ambient_occlusion.pixels[i], g.roughness.pixels[i],
                                alpha, g.normal_world.pixels[i], rays.toEye(x, y));
    out.pixels[i] = options.exposure * alpha * radiance(s, light, turn, {}, options);
  });
  return out;
}

}  // namespace beam
