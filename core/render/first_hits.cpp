// SPDX-License-Identifier: Apache-2.0
#include "core/render/first_hits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/math/brdf.h"
#include "core/math/color.h"
#include "core/scene/gbuffer.h"

namespace beam {
namespace {

constexpr std::size_t kRows = 2;   // of a tile
constexpr float kLayer_m = 0.03f;  // from the blended surface; beyond it a Gaussian is of another one
constexpr int kTries = 16;
constexpr int kPlaces = 16;  // in a pixel where meshes are met
constexpr float kPlaceShare = 1.0f / kPlaces;
constexpr float kDegenerate = 0.1f;  // of alpha; a shorter sum of normals is none (methods 7.1)

vec3 triple(const Planes& p, std::size_t i) { return {p.plane(0)[i], p.plane(1)[i], p.plane(2)[i]}; }

// Hammersley's: even along both axes, and along edges of few slopes in steps.
dvec2 placeOf(int k) {
  const int reversed = (k & 1) << 3 | (k & 2) << 1 | (k & 4) >> 1 | (k & 8) >> 3;
  return {(k + 0.5) / kPlaces, (reversed + 0.5) / kPlaces};
}

// What a pixel shows of meshes: sums over its places by share.
struct MeshPixel {
  float share = 0;  // of the pixel
  float kept = 1;   // of what was rasterised
  vec3 base_color{0}, normal{0};
  float roughness = 0;
  float depth_m = 0;  // at the middle, or at most that of half of its places
};

struct PlaceHit {
  PathHit hit;
  float depth_m = 0;
};

class MeshView {
 public:
  MeshView(const Camera& camera, const GaussianSurfaces* gaussians, const MeshSurfaces& meshes)
      : rays_(camera), eye_(rays_.eye()), gaussians_(gaussians), meshes_(meshes) {}

  // `alpha`: as rasterised.
  MeshPixel at(int x, int y, float alpha) const {
    std::array<PlaceHit, kPlaces> hits;
    int count = 0;
    for (int k = 0; k < kPlaces; ++k) {
      if (const auto hit = met(rays_.worldThrough(x, y, placeOf(k)))) hits[count++] = *hit;
    }
    MeshPixel pixel;
    if (count == 0) return pixel;
    const auto end = hits.begin() + count;
    std::sort(hits.begin(), end, [](const auto& a, const auto& b) { return a.depth_m < b.depth_m; });
    const auto before = sharesBefore(x, y, alpha, {hits.begin(), end});
    for (int k = 0; k < count; ++k) {
      const PathHit& hit = hits[k].hit;
      const float share = (1 - alpha * before[k]) * kPlaceShare;
      pixel.share += share;
      pixel.kept -= (1 - before[k]) * kPlaceShare;
      pixel.base_color += share * hit.base_color;
      pixel.normal += share * hit.normal;
      pixel.roughness += share * hit.roughness;
    }
    pixel.kept = std::max(pixel.kept, 0.0f);
    const auto middle = met(rays_.worldThrough(x, y));
    pixel.depth_m = middle ? middle->depth_m : hits[(count - 1) / 2].depth_m;
    return pixel;
  }

 private:
  std::optional<PlaceHit> met(dvec3 through) const {
    const double length = glm::length(through);
    const auto hit = meshes_.nearest(eye_, vec3(through / length), PathSurfaces::kFar_m);
    if (!hit) return {};
    return PlaceHit{*hit, hit->distance_m / static_cast<float>(length)};
  }

  // Of what the pixel's Gaussians stop, the share before each depth. `hits` from near to far.
  std::array<float, kPlaces> sharesBefore(int x, int y, float alpha, std::span<const PlaceHit> hits) const {
    std::array<float, kPlaces> shares{};
    if (!gaussians_ || alpha < kVisibleAlpha) return shares;
    const vec3 through(rays_.worldThrough(x, y));
    const float length = glm::length(through);
    const float all = gaussians_->alphaBefore(eye_, through / length, PathSurfaces::kFar_m);
    if (all <= 0) return shares;
    const auto before = [&](std::size_t k) {
      return std::min(1.0f, gaussians_->alphaBefore(eye_, through / length, hits[k].depth_m * length) / all);
    };
    shares.fill(before(0));
    const float last = before(hits.size() - 1);
    if (last == shares[0]) return shares;
    for (std::size_t k = 1; k < hits.size(); ++k) shares[k] = before(k);
    return shares;
  }

  PixelRays rays_;
  vec3 eye_;
  const GaussianSurfaces* gaussians_;
  const MeshSurfaces& meshes_;
};

// The values of a channel where a pixel shows meshes; `rastered` holds those of the Gaussians alone.
struct MixedPixel {
  const MeshPixel& mesh;
  float alpha;  // as rasterised
  vec3 to_eye;

  float total() const { return mesh.kept * alpha + mesh.share; }
  vec3 normal(vec3 rastered) const {
    const vec3 sum = mesh.kept * alpha * rastered + mesh.normal;
    const float length = glm::length(sum);
    return length < kDegenerate * total() ? to_eye : sum / length;
  }
  float depth(float rastered) const {
    if (total() < kDepthAlpha) return 0;
    return rastered > 0 && mesh.kept * alpha >= mesh.share ? rastered : mesh.depth_m;
  }
  vec3 of(std::string_view channel, vec3 rastered) const {
    if (channel == kAlphaChannel) return vec3(total());
    if (channel == kNormalChannel) return normal(rastered);
    if (channel == kDepthChannel) return vec3(depth(rastered.x));
    return mesh.kept * rastered + meshSum(channel);
  }
  vec3 meshSum(std::string_view channel) const {
    if (channel == kBaseColorChannel) return mesh.base_color;
    if (channel == kRoughnessChannel) return vec3(mesh.roughness);
    if (channel == kOcclusionChannel) return vec3(mesh.share);
    if (channel == kRgbChannel) return mesh.share * srgbFromLinear(mesh.base_color / mesh.share);
    return vec3(0);
  }
};

}  // namespace

RenderedPicture withMeshes(const RenderedPicture& rastered, const GaussianSurfaces* gaussians,
                           const MeshSurfaces& meshes, const Progress& progress) {
  const Camera& camera = rastered.camera;
  const PixelRays rays(camera);
  const MeshView view(camera, gaussians, meshes);
  const Planes& alpha = *channelIn(rastered, kAlphaChannel)->values;
  std::vector<Planes> mixed;
  for (const RenderedChannel& c : rastered.channels) mixed.push_back(*c.values);
  parallelFor(static_cast<std::size_t>(camera.height), kRows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end && !progress.stopRequested(); ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const std::size_t i = y * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(x);
        const int row = static_cast<int>(y);
        const MeshPixel mesh = view.at(x, row, alpha.values[i]);
        if (mesh.share <= 0) continue;
        const MixedPixel pixel{mesh, alpha.values[i], rays.toEye(x, row)};
        for (std::size_t c = 0; c < mixed.size(); ++c) {
          const Planes& in = *rastered.channels[c].values;
          vec3 value(0);
          for (int k = 0; k < in.channels; ++k) value[k] = in.plane(k)[i];
          value = pixel.of(rastered.channels[c].id, value);
          for (int k = 0; k < in.channels; ++k) mixed[c].plane(k)[i] = value[k];
        }
      }
    }
  });
  progress.check();
  RenderedPicture picture = rastered;
  for (std::size_t c = 0; c < mixed.size(); ++c)
    picture.channels[c].values = std::make_shared<const Planes>(std::move(mixed[c]));
  return picture;
}

Guides::Guides(const RenderedPicture& picture)
    : alpha(channelIn(picture, kAlphaChannel)->values),
      depth(channelIn(picture, kDepthChannel)->values),
      normal(channelIn(picture, kNormalChannel)->values),
      base_color(channelIn(picture, kBaseColorChannel)->values),
      roughness(channelIn(picture, kRoughnessChannel)->values) {}

vec3 Guides::baseColor(std::size_t i) const {
  return glm::clamp(triple(*base_color, i) / alpha->values[i], 0.0f, 1.0f);
}

// What the eye sees of the Gaussian that its ray ends in: the blended surface, or another one behind it.
PathHit FirstHits::seen(const GaussianSurfaces::FirstHit& first, std::size_t i, vec3 through,
                        float before_m) const {
  const float length = glm::length(through);
  PathHit hit = first.hit;
  const float z_m = rastered_.depth->values[i];
  if (z_m > 0) {
    const bool other = std::abs(hit.distance_m - z_m * length) > kLayer_m;
    if (other && !first.from_behind) return hit;
    if (z_m < before_m) hit.position_m = vec3(rays_.eye()) + z_m * through;
  }
  hit.normal = triple(*rastered_.normal, i);
  hit.base_color = rastered_.baseColor(i);
  hit.roughness =
      std::clamp(rastered_.roughness->values[i] / rastered_.alpha->values[i], kLeastRoughness, 1.0f);
  return hit;
}

// A ray through the fringe of a surface mostly ends nowhere; alpha has that already.
std::optional<FirstHit> FirstHits::ofGaussians(int x, int y, float before_m, PathNumbers& numbers) const {
  const vec3 through(rays_.worldThrough(x, y));
  const float length = glm::length(through);
  const vec3 direction = through / length;
  const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(rastered_.alpha->width) +
                        static_cast<std::size_t>(x);
  for (int k = 0; k < kTries; ++k) {
    if (const auto first = surfaces_.gaussians->first(vec3(rays_.eye()), direction, numbers.bits()))
      return FirstHit{seen(*first, i, through, before_m), -direction, first->hit.distance_m / length};
  }
  return {};
}

// As often of a place's mesh as Gaussians before it let through: one that is drawn behind it is hidden.
std::optional<FirstHit> FirstHits::ofBoth(int x, int y, PathNumbers& numbers) const {
  const vec2 u = numbers.next();
  const int place = std::min(static_cast<int>(u.x * kPlaces), kPlaces - 1);
  const dvec3 through = rays_.worldThrough(x, y, placeOf(place));
  const auto length = static_cast<float>(glm::length(through));
  const vec3 direction(glm::normalize(through));
  const auto mesh = surfaces_.meshes->nearest(vec3(rays_.eye()), direction, PathSurfaces::kFar_m);
  const float z_m = mesh ? mesh->distance_m / length : PathSurfaces::kFar_m;
  const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(rastered_.alpha->width) +
                        static_cast<std::size_t>(x);
  const float alpha = rastered_.alpha->values[i];
  if (surfaces_.gaussians && alpha >= kVisibleAlpha && u.y < alpha) {
    auto first = ofGaussians(x, y, z_m, numbers);
    if (first && first->depth_m < z_m) {
      first->hit = surfaces_.scene->besideMeshes(first->hit, first->to_eye);
      return first;
    }
  }
  return mesh ? std::optional(FirstHit{*mesh, -direction, z_m}) : std::nullopt;
}

std::optional<FirstHit> FirstHits::draw(int x, int y, PathNumbers& numbers) const {
  return surfaces_.meshes ? ofBoth(x, y, numbers) : ofGaussians(x, y, PathSurfaces::kFar_m, numbers);
}

}  // namespace beam
