// SPDX-License-Identifier: Apache-2.0
#include "core/method/bake_visibility.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/math/sampling.h"
#include "core/render/gaussian_buffers.h"
#include "core/render/rasterizer_cache.h"
#include "core/scene/thin_axis.h"

namespace beam {
namespace {

constexpr double kVotePixels = 320'000;  // of a picture that votes; more would tell no more
constexpr float kNear_m = 0.03f;         // between a Gaussian's reach and the surface that it is part of
constexpr std::size_t kSightPieces = 2;  // each reads all weights: more would read more than they save
constexpr std::size_t kPiece = 32;       // Gaussians whose rays are traced together
constexpr std::size_t kBand = 8192;      // Gaussians between two looks at the progress
constexpr double kToMean = 1e-3;  // pull of the SH beyond the mean to 0, against 1/N sum of (n.w) Y Y^T
constexpr int kTurned = 32;       // directions that tell a degree-3 function, twice as many as it has numbers

using Coefficients = Eigen::Matrix<float, kShCount, 1>;

Coefficients basisOf(vec3 d) {
  const std::array<float, kShCount> b = shBasis(d);
  return Eigen::Map<const Coefficients>(b.data());
}

// Evenly over the sphere by the golden angle.
vec3 spherePoint(int i, int count) {
  const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), phi = 2.399963229728653 * i;
  return vec3(dvec3(r * std::cos(phi), r * std::sin(phi), z));
}

// From what the rays of a Gaussian meet to the coefficients of V. Rays lie around +Z, distributed as their
// cosine: the weight of the least squares is in their number.
class VisibilityFit {
 public:
  explicit VisibilityFit(int rays) : local_(static_cast<std::size_t>(rays)) {
    Eigen::Matrix<double, Eigen::Dynamic, kShCount> b(rays, kShCount);
    for (int i = 0; i < rays; ++i) {
      const double u = (i + 0.5) / rays, r = std::sqrt(u), phi = 2.399963229728653 * i;
      local_[static_cast<std::size_t>(i)] =
          vec3(dvec3(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)));
      b.row(i) = basisOf(local_[static_cast<std::size_t>(i)]).transpose().cast<double>();
    }
    const Eigen::Matrix<double, kShCount, kShCount> normal =
        b.transpose() * b / rays + kToMean * Eigen::Matrix<double, kShCount, kShCount>::Identity();
    solve_ = (normal.ldlt().solve(b.transpose()) / rays).cast<float>();
    Eigen::Matrix<double, kTurned, kShCount> world;
    for (int k = 0; k < kTurned; ++k) {
      turned_[k] = spherePoint(k, kTurned);
      world.row(k) = basisOf(turned_[k]).transpose().cast<double>();
    }
    from_values_ = (world.transpose() * world).ldlt().solve(world.transpose()).cast<float>();
  }

  const std::vector<vec3>& localRays() const { return local_; }

  // `open`: 1 a ray that meets nothing, else 0. `frame`: world from local.
  void coefficients(const Eigen::VectorXf& open, const mat3& frame, float* out) const {
    const float mean = open.mean();
    const Coefficients local = solve_ * (open.array() - mean).matrix();
    Eigen::Matrix<float, kTurned, 1> values;
    for (int k = 0; k < kTurned; ++k) values[k] = local.dot(basisOf(turned_[k] * frame));
    Eigen::Map<Coefficients> world(out);
    world.noalias() = from_values_ * values;
    world[0] += (mean - 0.5f) / kShC0;
  }

 private:
  std::vector<vec3> local_;
  Eigen::Matrix<float, kShCount, Eigen::Dynamic> solve_;
  vec3 turned_[kTurned];
  Eigen::Matrix<float, kShCount, kTurned> from_values_;
};

// What pictures tell of a Gaussian: sums over the pixels that it is blended into.
struct Sight {
  double side = 0;  // blend weights of those that see the front of its thinnest axis, less the others
  double weight = 0;
  dvec3 from_middle = dvec3(0);  // weight x (surface - middle)
};

// Of the Gaussians [begin, end), pixel after pixel.
void addSights(const GaussianCloud& cloud, std::span<const vec3> axes, const Camera& camera,
               const RasterImages& images, const BlendWeights& blend, std::size_t begin, std::size_t end,
               std::vector<Sight>& sights) {
  const Rigid3 world_from_camera = inverse(camera.camera_from_world);
  const vec3 eye(world_from_camera.translation_m);
  for (std::size_t p = 0; p + 1 < blend.first.size(); ++p) {
    if (blend.first[p] == blend.first[p + 1]) continue;
    const int x = static_cast<int>(p) % camera.width, y = static_cast<int>(p) / camera.width;
    const double depth = images.median_depth.values[p];
    const vec3 surface(world_from_camera * (depth * rayOf(camera.intrinsics, {x + 0.5, y + 0.5})));
    for (std::size_t e = blend.first[p]; e < blend.first[p + 1]; ++e) {
      const std::size_t i = blend.gaussian[e];
      if (i < begin || i >= end) continue;
      const float weight = blend.weight[e];
      sights[i].side += glm::dot(axes[i], eye - cloud.position_m[i]) < 0 ? -weight : weight;
      const vec3 s = cloud.scale_m[i], away = surface - cloud.position_m[i];
      // A Gaussian of another layer: at outlines, and behind what is half transparent.
      if (depth <= 0 || glm::length(away) > kNear_m + 2 * std::max({s.x, s.y, s.z})) continue;
      sights[i].weight += weight;
      sights[i].from_middle += dvec3(away) * static_cast<double>(weight);
    }
  }
}

// Every third bit, of ten.
std::uint32_t spread(std::uint32_t v) {
  v = (v | v << 16) & 0x030000ff;
  v = (v | v << 8) & 0x0300f00f;
  v = (v | v << 4) & 0x030c30c3;
  return (v | v << 2) & 0x09249249;
}

// Along a Morton curve: rays that are traced one after the other meet the same part of the tree, which then
// is in the caches. Results do not depend on it.
std::vector<std::uint32_t> spatialOrder(std::span<const vec3> points) {
  vec3 low(kEndless_m), high(-kEndless_m);
  for (const vec3& p : points) low = glm::min(low, p), high = glm::max(high, p);
  const vec3 scale = 1023.0f / glm::max(high - low, vec3(1e-9f));
  std::vector<std::uint64_t> keyed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const vec3 cell = (points[i] - low) * scale;
    const std::uint64_t key = spread(static_cast<std::uint32_t>(cell.x)) << 2 |
                              spread(static_cast<std::uint32_t>(cell.y)) << 1 |
                              spread(static_cast<std::uint32_t>(cell.z));
    keyed[i] = key << 32 | i;
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order(keyed.size());
  for (std::size_t i = 0; i < keyed.size(); ++i) order[i] = static_cast<std::uint32_t>(keyed[i]);
  return order;
}

// World from local, turned about the normal by chance: neighbours err in other directions.
mat3 frameOf(vec3 normal, float angle) {
  const Frame3 f(normal);
  const float c = std::cos(angle), s = std::sin(angle);
  return {c * f.tangent + s * f.bitangent, c * f.bitangent - s * f.tangent, normal};
}

}  // namespace

SeenSurface seenSurface(const GaussianCloud& cloud, std::span<const Camera> cameras, ComputeDevice& device,
                        Progress& progress) {
  std::vector<Sight> sights(cloud.size());
  const std::vector<vec3> axes = thinAxes(cloud);
  const GaussianBuffers buffers = toBuffers(cloud);
  RasterizerCache rasterizers(device, 1);
  RasterImages images;
  progress.expect(static_cast<std::int64_t>(cameras.size()));
  for (const Camera& whole : cameras) {
    const double pixels = static_cast<double>(whole.width) * whole.height;
    const Camera camera =
        scaledDown(whole, std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / kVotePixels)))));
    Rasterizer& rasterizer =
        rasterizers.of({.width = camera.width, .height = camera.height, .color = false, .geometry = true});
    rasterizer.forward(buffers, camera, 0, vec3(0), images);
    const BlendWeights blend = rasterizer.blendWeights(buffers, camera);
    // Each piece reads all weights and adds up its own: in one order, whoever does it.
    parallelFor(cloud.size(), (cloud.size() + kSightPieces - 1) / kSightPieces,
                [&](std::size_t begin, std::size_t end) {
                  addSights(cloud, axes, camera, images, blend, begin, end, sights);
                });
    progress.step();
  }
  const vec3 center = centerOf(cloud);
  SeenSurface surface{std::vector<vec3>(cloud.size()), cloud.position_m};
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const Sight& s = sights[i];
    surface.normal[i] = s.side == 0 ? outwardAxis(cloud, i, center) : s.side < 0 ? -axes[i] : axes[i];
    if (s.weight > 0) surface.position_m[i] += vec3(s.from_middle / s.weight);
  }
  return surface;
}

ShBlock bakeVisibility(const GaussianCloud& cloud, const SeenSurface& surface,
                       const BakeVisibilityOptions& options, ComputeDevice& device, Progress& progress) {
  const auto tracer = device.newTracer({.threshold = static_cast<float>(options.threshold)}, cloud);
  const VisibilityFit fit(options.rays);
  const RandomStream random(options.seed, 0x76697369);
  const auto offset = static_cast<float>(options.offset_m);
  const auto per = static_cast<std::size_t>(options.rays);
  const std::vector<std::uint32_t> order = spatialOrder(surface.position_m);
  ShBlock out(cloud.size(), 1);
  progress.expect(static_cast<std::int64_t>(cloud.size()));
  for (std::size_t band = 0; band < cloud.size(); band += kBand) {
    const std::size_t count = std::min(kBand, cloud.size() - band);
    parallelFor(count, kPiece, [&](std::size_t begin, std::size_t end) {
      if (progress.stopRequested()) return;
      std::vector<Ray> rays;
      rays.reserve((end - begin) * per);
      std::vector<mat3> frames;
      for (std::size_t k = band + begin; k < band + end; ++k) {
        const std::uint32_t i = order[k];
        frames.push_back(frameOf(surface.normal[i], 2 * kPi * random.uniform(i)));
        const vec3 origin = surface.position_m[i] + offset * surface.normal[i];
        for (const vec3& d : fit.localRays()) rays.push_back({origin, frames.back() * d});
      }
      std::vector<std::uint8_t> blocked(rays.size());
      tracer->occluded(rays, blocked);
      Eigen::VectorXf open(options.rays);
      for (std::size_t i = 0; i < end - begin; ++i) {
        for (std::size_t r = 0; r < per; ++r)
          open[static_cast<Eigen::Index>(r)] = blocked[i * per + r] ? 0.0f : 1.0f;
        fit.coefficients(open, frames[i], out.of(order[band + begin + i]));
      }
    });
    progress.step(static_cast<std::int64_t>(count));
  }
  progress.check();
  return out;
}

}  // namespace beam
