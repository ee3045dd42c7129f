// SPDX-License-Identifier: Apache-2.0
#include "core/render/reference_scene_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/filter.h"
#include "core/math/color.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/render/first_hits.h"
#include "core/render/prepared_light.h"
#include "core/scene/gbuffer.h"

namespace beam {
namespace {

constexpr std::size_t kRows = 2;       // of a tile
constexpr float kLeastAlbedo = 0.05f;  // of what a denoised signal is divided by
constexpr int kLevels = 5;
constexpr int kMostOfAPass = 16;  // paths a pixel between two pictures
constexpr float kNoLimit = 1e30f;

using Values = std::shared_ptr<const Planes>;

vec3 triple(const Planes& p, std::size_t i) { return {p.plane(0)[i], p.plane(1)[i], p.plane(2)[i]}; }
void put(Planes& p, std::size_t i, vec3 v) {
  for (int c = 0; c < 3; ++c) p.plane(c)[i] = v[c];
}

// Sums of a pixel's paths; of those that ended in a surface.
struct PixelSum {
  vec3 direct{0}, indirect{0};
  // Of the luminance of each, divided by the base colour: sums and sums of squares.
  float of_direct = 0, of_direct2 = 0, of_indirect = 0, of_indirect2 = 0;
  float luminance = 0, luminance2 = 0;
  float depth_m = 0;
  int hits = 0;
};

// Of one sample nothing is known: as much as it is itself.
float varianceOfMean(float sum, float squares, int count) {
  if (count < 2) return squares;
  const float n = static_cast<float>(count), mean = sum / n;
  return std::max(0.0f, squares / n - mean * mean) / (n - 1);
}

// All that a picture is made of; `shown` has meshes in it where there are some.
struct PathScene {
  const FirstHits& first;
  Guides shown;
  const PathSurfaces& surfaces;
  const PathLights& lights;
};

class PathPicture {
 public:
  PathPicture(PathScene scene, const ReferenceOptions& options)
      : first_(scene.first),
        shown_(std::move(scene.shown)),
        options_(options),
        paths_(scene.surfaces, scene.lights,
               {.bounces = options.bounces,
                .offset_m = options.offset_m,
                .brightest = kNoLimit,
                .visible_normals = true,
                .sure_bounces = 3,
                .specular = options.specular,
                .draws = options.draws}),
        sums_(shown_.alpha->values.size()) {}

  // Samples [from, to) of every pixel.
  void add(int from, int to, const Progress& progress) {
    const int w = shown_.alpha->width;
    parallelFor(static_cast<std::size_t>(shown_.alpha->height), kRows,
                [&](std::size_t begin, std::size_t end) {
                  for (std::size_t y = begin; y < end; ++y) {
                    for (int x = 0; x < w; ++x) {
                      const std::size_t i = y * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
                      if (shown_.alpha->values[i] < kVisibleAlpha) continue;
                      if (progress.stopRequested()) return;
                      addPixel(x, static_cast<int>(y), i, from, to);
                    }
                  }
                });
    progress.check();
  }

  // Linear, x alpha.
  struct Parts {
    Planes direct, indirect, variance;
  };
  Parts parts() const {
    const int w = shown_.alpha->width, h = shown_.alpha->height;
    Parts p{Planes(w, h, 3), Planes(w, h, 3), Planes(w, h, 1)};
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const PixelSum& s = sums_[i];
      if (s.hits == 0) continue;
      const float share = shown_.alpha->values[i] / static_cast<float>(s.hits);
      put(p.direct, i, share * s.direct);
      put(p.indirect, i, share * s.indirect);
      const float alpha = shown_.alpha->values[i];
      p.variance.values[i] = alpha * alpha * varianceOfMean(s.luminance, s.luminance2, s.hits);
    }
    return p;
  }

  // What is smooth is filtered, the texture of the base colour is not.
  Parts denoised(const Progress& progress) const {
    Parts p = parts();
    const int w = shown_.alpha->width, h = shown_.alpha->height;
    DenoiseGuides guides{Image<vec3>(w, h), Image<float>(w, h), Image<std::uint8_t>(w, h)};
    std::array<NoisySignal, 2> signals{NoisySignal{Planes(w, h, 3), Planes(w, h, 1)},
                                       NoisySignal{Planes(w, h, 3), Planes(w, h, 1)}};
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const PixelSum& s = sums_[i];
      guides.valid.pixels[i] = s.hits > 0;
      if (!guides.valid.pixels[i]) continue;
      guides.depth_m.pixels[i] = s.depth_m / static_cast<float>(s.hits);
      guides.normal.pixels[i] = triple(*shown_.normal, i);
      const vec3 albedo = albedoOf(i);
      const auto n = static_cast<float>(s.hits);
      put(signals[0].values, i, s.direct / (n * albedo));
      put(signals[1].values, i, s.indirect / (n * albedo));
      signals[0].variance.values[i] = varianceOfMean(s.of_direct, s.of_direct2, s.hits);
      signals[1].variance.values[i] = varianceOfMean(s.of_indirect, s.of_indirect2, s.hits);
    }
    denoiseATrous(signals, guides, kLevels, progress);
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      if (!guides.valid.pixels[i]) continue;
      const vec3 albedo = shown_.alpha->values[i] * albedoOf(i);
      put(p.direct, i, albedo * triple(signals[0].values, i));
      put(p.indirect, i, albedo * triple(signals[1].values, i));
    }
    return p;
  }

 private:
  vec3 albedoOf(std::size_t i) const { return glm::max(shown_.baseColor(i), vec3(kLeastAlbedo)); }

  void addPixel(int x, int y, std::size_t i, int from, int to) {
    const vec3 albedo = albedoOf(i);
    PixelSum& sum = sums_[i];
    for (int sample = from; sample < to; ++sample) {
      PathNumbers numbers(options_.seed, i, sample, options_.samples, Strata::Permuted);
      const std::optional<FirstHit> first = first_.draw(x, y, numbers);
      if (!first) continue;
      const PathRadiance l = paths_.trace(first->hit, first->to_eye, numbers);
      if (!std::isfinite(l.all.x + l.all.y + l.all.z)) continue;
      const vec3 indirect = l.all - l.direct;
      const float a = luminance(l.direct / albedo), b = luminance(indirect / albedo), c = luminance(l.all);
      ++sum.hits;
      sum.depth_m += first->depth_m;
      sum.direct += l.direct;
      sum.indirect += indirect;
      sum.of_direct += a, sum.of_direct2 += a * a;
      sum.of_indirect += b, sum.of_indirect2 += b * b;
      sum.luminance += c, sum.luminance2 += c * c;
    }
  }

  const FirstHits& first_;
  Guides shown_;
  const ReferenceOptions& options_;
  PathIntegrator paths_;
  std::vector<PixelSum> sums_;
};

bool isLit(const ChannelInfo& channel) { return channel.needs == ChannelNeeds::MaterialsAndLight; }

Values valuesOf(const ChannelInfo& channel, const PathPicture::Parts& parts) {
  if (channel.id == kDirectChannel) return std::make_shared<const Planes>(parts.direct);
  if (channel.id == kIndirectChannel) return std::make_shared<const Planes>(parts.indirect);
  if (channel.id == kVarianceChannel) return std::make_shared<const Planes>(parts.variance);
  auto all = std::make_shared<Planes>(parts.direct);
  for (std::size_t k = 0; k < all->values.size(); ++k) all->values[k] += parts.indirect.values[k];
  return all;
}

class ReferenceSceneRenderer final : public SceneRenderer {
 public:
  ReferenceSceneRenderer(std::shared_ptr<ComputeDevice> device, const ReferenceOptions& options)
      : device_(std::move(device)), options_(options), unlit_(newCpuSceneRenderer(device_)) {
    abilities_ = unlit_->abilities();
    abilities_.id = "reference";
    abilities_.title = "Reference, path by path";
    abilities_.settings =
        fmt::format("{} paths, {} bounces{}, seed {}, offset {}", options.samples, options.bounces,
                    options.denoise ? ", denoised" : "", options.seed, options.offset_m);
    for (const char* id : {kDirectChannel, kIndirectChannel, kVarianceChannel})
      abilities_.channels.emplace_back(id);
    abilities_.occlusion = false;
    abilities_.without_visibility = "surfaces shadow themselves, for their outer sides are unknown";
    abilities_.refines = true;
    abilities_.meshes = abilities_.ground = true;
  }

  const RendererAbilities& abilities() const override { return abilities_; }

 private:
  void doLoad(const RenderScene& scene, const Progress& progress) override {
    RenderScene dark = scene;  // nothing is prepared of a light that is not shaded by
    dark.environment = nullptr;
    dark.lighting.lights.clear();
    unlit_->load(dark, progress);
    if (!surfaces_ || scene.instances != instances_) surfaces_ = nullptr;
    instances_ = scene.instances;
    loadMeshes(scene);
    progress.check();
    const EnvironmentLight& light = scene.lighting.environment;
    lamps_.clear();
    for (const Light& lamp : scene.lighting.lights)
      if (lamp.enabled && !std::holds_alternative<UnknownLight>(lamp.kind)) lamps_.emplace_back(lamp);
    const auto panorama = light.enabled ? scene.environment : nullptr;
    if (panorama == panorama_ && light == light_) return;
    sampler_ = nullptr;
    panorama_ = panorama;
    light_ = light;
  }

  void loadMeshes(const RenderScene& scene) {
    if (scene.meshes == mesh_list_ && scene.ground == ground_ && !!meshes_ == hasMeshes(scene)) return;
    meshes_ = nullptr;
    if (hasMeshes(scene)) meshes_ = std::make_unique<MeshSurfaces>(scene.meshes, scene.ground);
    mesh_list_ = scene.meshes;
    ground_ = scene.ground;
  }

  void doDraw(const Camera& camera, std::span<const ChannelInfo> channels, Progress& progress,
              const OnPicture& on_picture) override {
    std::vector<ChannelInfo> drawn;
    const bool lit = std::any_of(channels.begin(), channels.end(), isLit);
    std::copy_if(channels.begin(), channels.end(), std::back_inserter(drawn),
                 [](const ChannelInfo& c) { return !isLit(c); });
    if (lit) {
      for (const char* id : kGuides) drawn.push_back(channelOf(id));
    } else if (meshes_) {
      drawn.push_back(channelOf(kAlphaChannel));
    }
    RenderedPicture rastered;
    unlit_->draw(camera, drawn, progress, [&](RenderedPicture p) { rastered = std::move(p); });
    if (lit || meshes_) prepareSurfaces(progress);
    const RenderedPicture shown =
        meshes_ ? withMeshes(rastered, surfaces_.get(), *meshes_, progress) : rastered;
    const auto give = [&](const PathPicture::Parts* parts, int samples, bool final) {
      RenderedPicture picture;
      picture.camera = camera;
      picture.samples = samples;
      picture.final = final;
      for (const ChannelInfo& c : channels)
        picture.channels.push_back(
            {c.id, isLit(c) ? valuesOf(c, *parts) : channelIn(shown, c.id)->values, 0});
      on_picture(std::move(picture));
    };
    if (!lit) return give(nullptr, 1, true);
    prepareLight(progress);
    std::optional<SceneSurfaces> all;
    if (meshes_) all.emplace(surfaces_.get(), *meshes_, options_.offset_m);
    const FirstHits first(camera, rastered, {surfaces_.get(), meshes_.get(), all ? &*all : nullptr});
    const PanoramaLights lights(sampler_.get(), lamps_);
    const PathSurfaces& surfaces = all ? static_cast<const PathSurfaces&>(*all) : *surfaces_;
    follow({first, Guides(shown), surfaces, lights}, progress, give);
  }

  // Gives picture after picture, each of more paths.
  template <class Give>
  void follow(PathScene scene, Progress& progress, Give&& give) {
    PathPicture picture(std::move(scene), options_);
    progress.expect(options_.samples, "paths a pixel");
    for (int done = 0; done < options_.samples;) {
      const int next = std::min({options_.samples, std::max(1, 2 * done), done + kMostOfAPass});
      picture.add(done, next, progress);
      progress.step(next - done);
      done = next;
      const bool last = done == options_.samples;
      const PathPicture::Parts parts =
          last && options_.denoise ? picture.denoised(progress) : picture.parts();
      give(&parts, done, last);
    }
  }

  // What rays need; only once there are some to follow.
  void prepareSurfaces(const Progress& progress) {
    if (!surfaces_ && !instances_.empty())
      surfaces_ = std::make_unique<GaussianSurfaces>(instances_, *device_);
    progress.check();
  }
  void prepareLight(const Progress& progress) {
    if (sampler_ || !panorama_) return;
    sampler_ = std::make_unique<EnvironmentSampler>(lightingEnvironment(*panorama_, progress), yawOf(light_),
                                                    static_cast<float>(light_.gain));
    progress.check();
  }

  std::shared_ptr<ComputeDevice> device_;
  ReferenceOptions options_;
  std::unique_ptr<SceneRenderer> unlit_;
  RendererAbilities abilities_;
  std::vector<RenderInstance> instances_;
  std::unique_ptr<GaussianSurfaces> surfaces_;  // of instances_; null: not needed yet, or there are none
  std::vector<RenderMesh> mesh_list_;
  Ground ground_;
  std::unique_ptr<MeshSurfaces> meshes_;  // of mesh_list_ and ground_; null: neither is there
  std::vector<PathLamp> lamps_;
  std::shared_ptr<const Environment> panorama_;  // of the last scene; null: it has none, or it is dark
  EnvironmentLight light_;
  std::unique_ptr<EnvironmentSampler> sampler_;  // of panorama_ and light_; null: not needed yet
};

void requireWithin(const char* name, int value, int low, int high) {
  if (value < low || value > high)
    throw Error(Error::Kind::Usage, fmt::format("{} expects {} to {}, found {}", name, low, high, value));
}

}  // namespace

std::unique_ptr<SceneRenderer> newReferenceSceneRenderer(std::shared_ptr<ComputeDevice> device,
                                                         const ReferenceOptions& options) {
  requireWithin("paths a pixel (--spp)", options.samples, 1, kMostSamples);
  requireWithin("bounces", options.bounces, 0, 64);
  return std::make_unique<ReferenceSceneRenderer>(std::move(device), options);
}

}  // namespace beam
