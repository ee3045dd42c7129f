// SPDX-License-Identifier: Apache-2.0
#include "core/method/fit_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/math/knn.h"
#include "core/method/training_loop.h"
#include "core/optim/mcmc.h"
#include "core/scene/visual_hull.h"

namespace beam {
namespace {

constexpr int kNeighbors = 12;
constexpr float kSeedOpacity = 0.3f;
constexpr float kSeedThinness = 0.35f;  // of the in-plane size: seeds lie on a surface
constexpr float kInsideShare = 0.9f;    // of the views: a Gaussian outside more masks is pruned (methods 3.8)
constexpr float kDeadOpacity = 0.005f;

// The direction in which the points scatter least: smallest eigenvector of their covariance, by inverse
// iteration.
vec3 planeNormal(std::span<const vec3> points) {
  dvec3 mean(0);
  for (const vec3& p : points) mean += dvec3(p);
  mean /= static_cast<double>(points.size());
  dmat3 covariance(0.0);
  for (const vec3& p : points) covariance += glm::outerProduct(dvec3(p) - mean, dvec3(p) - mean);
  const double trace = covariance[0][0] + covariance[1][1] + covariance[2][2];
  if (!(trace > 0)) return {0, 0, 1};
  const dmat3 inverse = glm::inverse(covariance / trace + dmat3(1e-6));
  dvec3 n = glm::normalize(dvec3(0.3, 0.5, 0.81));
  for (int i = 0; i < 24; ++i) n = glm::normalize(inverse * n);
  return vec3(n);
}

quat rotationFromZ(vec3 n) {
  const vec3 z(0, 0, 1);
  const float c = glm::dot(z, n);
  if (c < -0.9999f) return quat(0, 1, 0, 0);
  const vec3 axis = glm::cross(z, n);
  return glm::normalize(quat(1 + c, axis.x, axis.y, axis.z));
}

// One flat Gaussian a seed, as large as its distance to its neighbours, lying in their plane.
GaussianCloud initialCloud(const PointCloud& seeds) {
  const std::size_t n = seeds.position_m.size();
  const KdTree tree(seeds.position_m);
  GaussianCloud c;
  c.position_m = seeds.position_m;
  c.rotation.resize(n);
  c.scale_m.resize(n);
  c.opacity.assign(n, kSeedOpacity);
  c.color = ShBlock(n, 3);
  parallelFor(n, 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::vector<Neighbor> near = tree.nearest(seeds.position_m[i], kNeighbors + 1);
      std::vector<vec3> around;
      around.reserve(near.size());
      float squared = 0;
      for (const Neighbor& k : near) around.push_back(seeds.position_m[k.index]);
      const std::size_t three = std::min<std::size_t>(4, near.size());
      for (std::size_t k = 1; k < three; ++k)
        squared += near[k].squared_distance / static_cast<float>(three - 1);
      const float size = std::sqrt(std::max(squared, 1e-7f));
      c.rotation[i] = rotationFromZ(planeNormal(around));
      c.scale_m[i] = vec3(size, size, kSeedThinness * size);
      for (int k = 0; k < 3; ++k) c.color.of(i)[k] = (seeds.color[i][k] / 255.0f - 0.5f) / kShC0;
    }
  });
  return c;
}

// Positions learn as everything else; before E_normal acts MCMC moves, adds and replaces Gaussians.
class SurfaceRule final : public TrainingRule {
 public:
  // `extent_m`: what position rates are relative to. `count`: Gaussians at the first step.
  SurfaceRule(const FitSurfaceOptions& options, bool geometry, float extent_m, std::size_t count)
      : options_(options),
        geometry_(geometry),
        extent_m_(extent_m),
        first_count_(static_cast<int>(count)),
        refine_start_(halfOf(options.iterations, options.refine_fraction, true).begin) {}

  int shDegree(int step) const override { return std::min(3, step / std::max(1, options_.iterations / 30)); }

  ModelStep learn(TrainingStep step, const GaussianBuffers& /*gradients*/, TrainingOps& /*ops*/) override {
    if (geometry_) return {rates(step.index), {}};
    return {rates(step.index),
            {.opacity = static_cast<float>(options_.opacity_regularizer),
             .scale = static_cast<float>(options_.scale_regularizer),
             .isotropy = static_cast<float>(options_.isotropy_weight),
             .size = static_cast<float>(options_.size_weight)}};
  }

  void finish(GaussianModel& model, TrainingStep step) override {
    if (geometry_) return;
    model.addNoise(static_cast<float>(options_.noise) * rates(step.index).position_m, options_.seed,
                   step.index);
    changeCount(model, step.index);
  }

 private:
  LearningRates rates(int step) const {
    return ratesAt(options_.rates, step, options_.iterations, extent_m_);
  }

  // MCMC every `interval` steps; the growth reaches the cap half way through the appearance steps.
  void changeCount(GaussianModel& model, int step) const {
    const int interval = options_.iterations >= 10000 ? 100 : 50;
    const int start = std::min(500, refine_start_ / 10), stop = refine_start_ * 5 / 6;
    if (step < start || step >= stop || step % interval != 0) return;
    relocateDead(model, options_.seed, step);
    const double rounds = std::max(1.0, (refine_start_ * 0.5 - start) / interval);
    const double factor = std::pow(static_cast<double>(options_.cap) / first_count_, 1.0 / rounds);
    grow(model, std::max(1.0, factor), options_.cap, options_.seed, step);
  }

  const FitSurfaceOptions& options_;
  bool geometry_;
  float extent_m_;
  int first_count_, refine_start_;
};

void trainSurface(TrainingLoop& loop, std::span<const FrameView> views, const FitSurfaceOptions& options,
                  bool geometry, Progress& progress, const CloudPreview& preview) {
  const TrainingSpan span = halfOf(options.iterations, options.refine_fraction, geometry);
  SurfaceRule rule(options, geometry, sceneExtent(views), loop.model().size());
  progress.expect(span.end - span.begin, "iterations");
  loop.run(span, rule, progress, preview);
}

void pruneOutsideHull(GaussianModel& model, const VisualHull& hull) {
  const GaussianBuffers& g = model.physical();
  std::vector<std::uint8_t> keep(model.size(), 1);
  for (std::size_t i = 0; i < keep.size(); ++i) {
    const auto v = hull.votes({g.plane(0)[i], g.plane(1)[i], g.plane(2)[i]});
    if (v.seen > 0 && static_cast<float>(v.inside) < kInsideShare * static_cast<float>(v.seen)) keep[i] = 0;
    if (model.opacity(i) < kDeadOpacity) keep[i] = 0;
  }
  model.keep(keep);
}

}  // namespace

namespace {

void describeAdvanced(Fields& f, FitSurfaceOptions& o) {
  f.field({.name = "seed",
           .label = "Random seed",
           .help = "Start of the random numbers: the same number gives the same result again, another one a "
                   "slightly different result.",
           .min = 0,
           .max = 1e9,
           .advanced = true},
          o.seed);
  f.field({.name = "seed_share",
           .label = "Share of starting points",
           .help = "Points on the hull of the masks that the fit starts from, as a share of the most "
                   "Gaussians; growth adds the rest.",
           .min = 0.01,
           .max = 1,
           .advanced = true},
          o.seed_share);
  f.field({.name = "ssim_weight",
           .label = "Share of structure in the loss",
           .help = "Part of structural dissimilarity (D-SSIM) in the difference to the photographs; the rest "
                   "is absolute difference (L1). The paper takes 0.2.",
           .min = 0,
           .max = 1,
           .advanced = true},
          o.ssim_weight);
  f.field({.name = "mask_weight",
           .label = "Mask weight",
           .help = "How strongly the covered area is pulled towards the mask; 0 switches it off.",
           .min = 0,
           .max = 10,
           .advanced = true},
          o.mask_weight);
  f.field({.name = "filter",
           .label = "Smallest size (3D filter)",
           .help = "Smallest size of a Gaussian, as a share of what Mip-Splatting sets by the resolution of "
                   "the cameras; 0 switches it off.",
           .min = 0,
           .max = 4,
           .advanced = true},
          o.filter);
  f.field({.name = "position_rate",
           .label = "Learning rate, position",
           .help = "Learning rate of positions at the first step, as a share of the extent of the scene; "
                   "falls to a hundredth.",
           .min = 0,
           .max = 1,
           .advanced = true},
          o.rates.position);
  f.field({.name = "scale_rate",
           .label = "Learning rate, size",
           .help = "Learning rate of the logarithms of the sizes.",
           .min = 0,
           .max = 1,
           .advanced = true},
          o.rates.log_scale);
  f.field({.name = "opacity_rate",
           .label = "Learning rate, opacity",
           .help = "Learning rate of the opacities before their sigmoid (logits).",
           .min = 0,
           .max = 1,
           .advanced = true},
          o.rates.opacity_logit);
  f.field({.name = "color_rate",
           .label = "Learning rate, colour",
           .help = "Learning rate of the colour that is the same from every side; what depends on the view "
                   "learns a 20th as fast.",
           .min = 0,
           .max = 1,
           .advanced = true},
          o.rates.color);
  f.field({.name = "noise",
           .label = "Exploration noise",
           .help = "Random moves that spread Gaussians to where some are missing (MCMC), as a multiple of "
                   "the learning rate of positions.",
           .min = 0,
           .max = 1e8,
           .advanced = true},
          o.noise);
  f.field({.name = "opacity_regularizer",
           .label = "Pull on opacity",
           .help = "Pull of the mean opacity towards 0, so that Gaussians that show nothing become free to "
                   "be used elsewhere (MCMC).",
           .min = 0,
           .max = 1,
           .advanced = true},
          o.opacity_regularizer);
  f.field(
      {.name = "scale_regularizer",
       .label = "Pull on size",
       .help = "Pull of the mean size towards 0, so that no Gaussian stays larger than it has to be (MCMC).",
       .min = 0,
       .max = 1,
       .advanced = true},
      o.scale_regularizer);
}

}  // namespace

void describe(Fields& f, FitSurfaceOptions& o) {
  f.field({.name = "iterations",
           .label = "Iterations",
           .help = "Optimiser steps of a frame that is fitted alone or begins a take, in all; the paper "
                   "takes 15,000 + 15,000 for a lone frame.",
           .min = 10,
           .max = 1e6},
          o.iterations);
  f.field({.name = "refine_fraction",
           .label = "Share of steps with normals",
           .help = "The last part of the steps, as a share of all, also makes the normals of the Gaussians "
                   "agree with those of the rendered depth.",
           .min = 0,
           .max = 1},
          o.refine_fraction);
  f.field({.name = "cap",
           .label = "Most Gaussians",
           .help = "Growth stops at this many Gaussians in a frame; the paper has about 140,000.",
           .min = 100,
           .max = 4e6},
          o.cap);
  describeAdvanced(f, o);
  f.group("refine", [&] {
    f.field({.name = "normal_weight",
             .label = "Normal weight",
             .help = "How strongly the normals of the Gaussians are made to agree with those of the rendered "
                     "depth; the paper takes 0.03.",
             .min = 0,
             .max = 10},
            o.normal_weight);
    f.field({.name = "expected_depth_share",
             .label = "Share of the expected depth",
             .help = "How much of the agreement of normals is asked of the mean depth along a ray; the rest "
                     "is asked of the median depth. RaDe-GS takes 0.4.",
             .min = 0,
             .max = 1,
             .advanced = true},
            o.expected_depth_share);
  });
}

float sceneExtent(std::span<const FrameView> views) {
  dvec3 mean(0);
  for (const FrameView& v : views) mean += centerOf(v.camera) / static_cast<double>(views.size());
  double radius = 0;
  for (const FrameView& v : views) radius = std::max(radius, glm::length(centerOf(v.camera) - mean));
  return static_cast<float>(1.1 * radius);
}

ViewLossOptions lossOptions(const FitSurfaceOptions& o) {
  return {.ssim_weight = o.ssim_weight,
          .mask_weight = o.mask_weight,
          .normal_weight = o.normal_weight,
          .expected_depth_share = o.expected_depth_share,
          .seed = o.seed};
}

GaussianCloud fitAppearance(std::span<const FrameView> views, const PointCloud& seeds,
                            const FitSurfaceOptions& options, ComputeDevice& device, Progress& progress,
                            const CloudPreview& preview) {
  TrainingLoop loop(views, lossOptions(options), false, initialCloud(seeds), options.filter, device);
  trainSurface(loop, views, options, false, progress, preview);
  return loop.model().cloud();
}

GaussianCloud refineGeometry(std::span<const FrameView> views, const GaussianCloud& cloud,
                             const FitSurfaceOptions& options, ComputeDevice& device, Progress& progress,
                             const CloudPreview& preview) {
  TrainingLoop loop(views, lossOptions(options), true, cloud, options.filter, device);
  loop.takeFilterOut(loop.model());  // the values hold it already
  trainSurface(loop, views, options, true, progress, preview);
  pruneOutsideHull(loop.model(), VisualHull(views));
  return loop.model().cloud();
}

}  // namespace beam
