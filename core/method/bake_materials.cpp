// SPDX-License-Identifier: Apache-2.0
#include "core/method/bake_materials.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/log.h"
#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/image/filter.h"
#include "core/math/color.h"
#include "core/math/statistics.h"
#include "core/method/light_integrals.h"
#include "core/render/deferred.h"

namespace beam {
namespace {

constexpr float kClippedHigh = 0.98f, kClippedLow = 0.01f;  // sRGB (methods 5.6)
constexpr float kDarkShare = 0.05f;                         // of the frame's median L_D (methods 5.7)
constexpr float kMinSky = 0.05f;
constexpr std::uint8_t kFullCoverage = 250;  // a mask below it mixes in the background

float smoothStep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

// BEAM's 100 rays are split 40 : 40 : 20 (methods 5.4); A keeps at least the rays of eq. 3.
LightSampling samplingOf(const BakeMaterialsOptions& o, std::size_t view) {
  const int environment = o.base_color_samples * 2 / 5, specular = o.base_color_samples / 5;
  return {.cosine = std::max(o.ao_samples, o.base_color_samples - environment - specular),
          .environment = environment,
          .specular = specular,
          .offset_m = static_cast<float>(o.offset_m),
          .roughness = static_cast<float>(o.roughness),
          .seed = RandomStream(static_cast<std::uint64_t>(o.seed), 0x62616b65, view).bits(0)};
}

// L_D, L_S and A as pictures, denoised each by itself: what is smooth is filtered, the texture of the
// photograph is not (methods 5.5).
struct IntegralImages {
  NoisySignal diffuse, specular, sky;
};

IntegralImages denoised(std::span<const SurfacePoint> points, std::span<const LightIntegrals> integrals,
                        const GBuffer& g, int levels) {
  const int w = g.alpha.width, h = g.alpha.height;
  std::array<NoisySignal, 3> signals;
  for (int s = 0; s < 3; ++s) signals[s] = {Planes(w, h, s < 2 ? 3 : 1), Planes(w, h, 1)};
  DenoiseGuides guides{g.normal_world, g.depth_m, Image<std::uint8_t>(w, h)};
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::size_t i = g.alpha.index(points[p].x, points[p].y);
    guides.valid.pixels[i] = 1;
    for (int c = 0; c < 3; ++c) {
      signals[0].values.plane(c)[i] = integrals[p].diffuse[c];
      signals[1].values.plane(c)[i] = integrals[p].specular[c];
      signals[c].variance.values[i] = integrals[p].variance[c];
    }
    signals[2].values.values[i] = integrals[p].sky;
  }
  denoiseATrous(signals, guides, levels);
  return {std::move(signals[0]), std::move(signals[1]), std::move(signals[2])};
}

vec3 triple(const Planes& p, std::size_t i) { return {p.plane(0)[i], p.plane(1)[i], p.plane(2)[i]}; }

bool clipped(u8vec3 c) {
  const float low = std::min({c.x, c.y, c.z}) / 255.0f, high = std::max({c.x, c.y, c.z}) / 255.0f;
  return high >= kClippedHigh || low <= kClippedLow;
}

// BEAM eq. 20 with pi absorbed: rho = (L_o - L_S) / L_D.
struct BaseColor {
  vec3 value;
  bool trusted;  // neither negative nor above 1 before the clamp, and light enough
};

BaseColor baseColor(vec3 observed, vec3 diffuse, vec3 specular, float sky, bool multibounce) {
  const vec3 numerator = observed - specular;
  if (std::min({diffuse.x, diffuse.y, diffuse.z}) <= 0) return {vec3(0), false};
  const vec3 raw = numerator / diffuse;
  vec3 rho = glm::clamp(raw, 0.0f, 1.0f);
  // One bounce between surfaces of the same colour: rho' = rho / (1 - rho (1 - A)) inverted (methods 5.11).
  if (multibounce) rho = rho / (1.0f + rho * (1 - sky));
  const bool positive = std::min({numerator.x, numerator.y, numerator.z}) > 0;
  return {rho, positive && sky >= kMinSky};
}

// What base colour's weights need until the light of all views is known; light: luminance of L_D.
struct WeightedPixel {
  std::uint32_t index;
  float weight, light;
};
struct LitPixels {
  std::vector<float> light;                          // of all pixels with a weight of occlusion, all views
  std::vector<std::vector<WeightedPixel>> weighted;  // of each view
};

// Without base_color_weight. Adds a view to `lit`.
MaterialMaps assemble(const FrameView& view, const GBuffer& g, std::span<const SurfacePoint> points,
                      const IntegralImages& light, bool multibounce, LitPixels& lit) {
  const int w = g.alpha.width, h = g.alpha.height;
  MaterialMaps m{view.camera, Planes(w, h, 1), Planes(w, h, 3), Planes(w, h, 1), {}};
  std::vector<WeightedPixel>& weighted = lit.weighted.emplace_back();
  for (const SurfacePoint& p : points) {
    const std::size_t i = g.alpha.index(p.x, p.y);
    const float sky = std::clamp(light.sky.values.values[i], 0.0f, 1.0f);
    const vec3 diffuse = triple(light.diffuse.values, i), specular = triple(light.specular.values, i);
    const u8vec3 code = view.photo.pixels[i];
    const BaseColor rho = baseColor(linearFromSrgb(vec3(code) / 255.0f), diffuse, specular, sky, multibounce);
    const float facing = smoothStep(0.1f, 0.4f, glm::dot(p.normal, p.to_eye));
    m.ambient_occlusion.values[i] = sky;
    m.ao_weight.values[i] = facing;
    for (int c = 0; c < 3; ++c) m.base_color.plane(c)[i] = rho.value[c];
    if (!(facing > 0)) continue;
    lit.light.push_back(luminance(diffuse));
    const bool covered = view.mask.empty() || view.mask.pixels[i] >= kFullCoverage;
    if (covered && rho.trusted && !clipped(code))
      weighted.push_back({static_cast<std::uint32_t>(i), facing, luminance(diffuse)});
  }
  return m;
}

// Takes weight from pixels that get little light compared with the frame's median (methods 5.7).
Planes weightsByLight(const std::vector<WeightedPixel>& pixels, float usual, const FrameView& view) {
  Planes weights(view.camera.width, view.camera.height, 1);
  for (const WeightedPixel& p : pixels)
    weights.values[p.index] = p.weight * smoothStep(kDarkShare, 3 * kDarkShare, p.light / usual);
  return weights;
}

}  // namespace

void describe(Fields& f, BakeMaterialsOptions& o) {
  f.field({.name = "ao_samples",
           .label = "Occlusion rays",
           .help = "Rays per pixel that measure ambient occlusion; the paper takes 50.",
           .min = 1,
           .max = 4096,
           .unit = "rays"},
          o.ao_samples);
  f.field({.name = "base_color_samples",
           .label = "Light rays",
           .help = "Rays per pixel that gather the light that falls in; the paper takes 100.",
           .min = 5,
           .max = 4096,
           .unit = "rays"},
          o.base_color_samples);
  f.field({.name = "offset_m",
           .label = "Ray offset",
           .help = "How far off the surface rays start; the paper takes 0.02 m. Too little darkens, too much "
                   "brightens creases.",
           .min = 0,
           .max = 0.5,
           .unit = "m"},
          o.offset_m);
  f.field({.name = "threshold",
           .label = "Occlusion threshold",
           .help = "A ray is blocked where the opacities along it sum to more; the paper takes 0.9999.",
           .min = 0.01,
           .max = 10,
           .advanced = true},
          o.threshold);
  f.field(
      {.name = "denoise_levels",
       .label = "Denoising passes",
       .help =
           "Passes of a filter that keeps edges, each twice as wide as the one before; 0 switches it off.",
       .min = 0,
       .max = 7,
       .advanced = true},
      o.denoise_levels);
  f.field({.name = "multibounce",
           .label = "Correct for one bounce",
           .help = "Takes light that bounces inside creases out of the base colour; the paper ignores it."},
          o.multibounce);
  f.field(
      {.name = "roughness",
       .label = "Roughness",
       .help =
           "One number for the whole subject: it is stated, not measured. Cotton 0.8, skin 0.5, leather 0.4.",
       .min = 0.04,
       .max = 1},
      o.roughness);
  f.field({.name = "seed",
           .label = "Random seed",
           .help = "Start of the random numbers: the same number gives the same result again, another one a "
                   "slightly different result.",
           .min = 0,
           .max = 1e9,
           .advanced = true},
          o.seed);
}

void bakeMaterials(std::span<const FrameView> views, const GaussianCloud& cloud,
                   const Environment& environment, const BakeMaterialsOptions& options, ComputeDevice& device,
                   Progress& progress, const TakeMaps& take) {
  const EnvironmentSampler light(environment);
  const auto tracer = device.newTracer({.threshold = static_cast<float>(options.threshold)}, cloud);
  GBufferRenderer renderer(device);
  const auto resident = residentOf(device, cloud, nullptr);
  LitPixels lit;
  for (std::size_t v = 0; v < views.size(); ++v) {
    Progress part = progress.part(1.0 / static_cast<double>(views.size()), "tracing " + views[v].name);
    const GBuffer g = renderer.render(*resident, views[v].camera);
    const std::vector<SurfacePoint> points = surfacePoints(g, views[v].camera, views[v].mask);
    part.expect(static_cast<std::int64_t>(points.size()));
    const auto integrals = integrateLight(points, samplingOf(options, v), light, *tracer, part);
    const IntegralImages images = denoised(points, integrals, g, options.denoise_levels);
    take(v, assemble(views[v], g, points, images, options.multibounce, lit));
    if (points.empty()) logWarning("camera {}: no surface was found, its picture is not used", views[v].name);
  }
  const float usual = std::max(median(std::move(lit.light)), 1e-12f);
  for (std::size_t v = 0; v < views.size(); ++v) {
    progress.check();
    take(v, {views[v].camera, {}, {}, {}, weightsByLight(lit.weighted[v], usual, views[v])});
  }
}

std::vector<MaterialMaps> bakeMaterials(std::span<const FrameView> views, const GaussianCloud& cloud,
                                        const Environment& environment, const BakeMaterialsOptions& options,
                                        ComputeDevice& device, Progress& progress) {
  std::vector<MaterialMaps> all(views.size());
  bakeMaterials(views, cloud, environment, options, device, progress,
                [&](std::size_t view, const MaterialMaps& maps) {
                  if (maps.base_color_weight.empty()) {
                    all[view] = maps;
                  } else {
                    all[view].base_color_weight = maps.base_color_weight;
                  }
                });
  return all;
}

}  // namespace beam
