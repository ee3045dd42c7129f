// SPDX-License-Identifier: Apache-2.0
#include "core/method/fit_materials.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/math/sh_rotation.h"
#include "core/method/fit_descent.h"
#include "core/method/fit_linear.h"

namespace beam {
namespace {

// Linear base colour from the photographed colour, without its dependence on the view (methods 5.10).
ShBlock fromRadiance(const GaussianCloud& cloud) {
  ShBlock block(cloud.size(), 3);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float color = std::clamp(0.5f + kShC0 * cloud.color.of(i)[c], 0.0f, 1.0f);
      block.of(i)[c] = (linearFromSrgb(color) - 0.5f) / kShC0;
    }
  }
  return block;
}

ShBlock tripled(const ShBlock& one) {
  ShBlock block(one.coefficients.size() / kShCount, 3);
  for (std::size_t i = 0; i < block.coefficients.size(); ++i) block.coefficients[i] = one.coefficients[i / 3];
  return block;
}

// `before`: turned to this frame, or null.
void fitByDescent(const MapSource& maps, const GaussianCloud& cloud, const Materials* before,
                  const FitMaterialsOptions& options, ComputeDevice& device, Progress& progress,
                  Materials& out) {
  const double weight = before ? options.later.temporal_weight : 0;
  const int steps = before ? options.later.adam_iterations : options.adam_iterations;
  const double regularization = options.regularization;
  std::vector<MaterialMaps> all;  // steps choose among them at random
  for (std::size_t i = 0; i < maps.views; ++i) {
    progress.check();
    all.push_back(maps.read(i));
  }
  Progress color_part = progress.part(0.5, "fitting base colour");
  out.base_color = fitDescent(all, cloud, before ? before->base_color : fromRadiance(cloud),
                              {MapKind::BaseColor, steps, regularization, weight}, device, color_part);
  Progress occlusion_part = progress.part(0.5, "fitting ambient occlusion");
  const ShBlock occlusion =
      fitDescent(all, cloud, before ? tripled(before->ambient_occlusion) : ShBlock(cloud.size(), 3),
                 {MapKind::AmbientOcclusion, steps, regularization, 0}, device, occlusion_part);
  for (std::size_t i = 0; i < out.ambient_occlusion.coefficients.size(); ++i) {
    out.ambient_occlusion.coefficients[i] = occlusion.coefficients[i * 3];
  }
}

MaterialCoefficients coefficientsOf(const Materials& m) {
  MaterialCoefficients x(m.ambient_occlusion.coefficients.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const float* color = m.base_color.coefficients.data() + i * 3;
    x[i] = {color[0], color[1], color[2], m.ambient_occlusion.coefficients[i]};
  }
  return x;
}

void fitByLinearSolve(const MapSource& maps, const GaussianCloud& cloud, const Materials* before,
                      const FitMaterialsOptions& options, ComputeDevice& device, Progress& progress,
                      Materials& out) {
  const bool held = options.later.memory_frames > 0 || options.later.occlusion_memory_frames > 0;
  MaterialCoefficients earlier;
  if (before && held) earlier = coefficientsOf(*before);
  const MaterialCoefficients x =
      fitLinear(maps, cloud, earlier.empty() ? nullptr : &earlier, options, device, progress);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (int c = 0; c < 3; ++c) out.base_color.coefficients[i * 3 + c] = x[i][c];
    out.ambient_occlusion.coefficients[i] = x[i].w;
  }
}

Materials fit(const MapSource& maps, const GaussianCloud& cloud, const Materials* before,
              const FitMaterialsOptions& options, ComputeDevice& device, Progress& progress,
              std::vector<float> roughness) {
  if (maps.views == 0)
    throw Error(Error::Kind::Data, "material fit: expected the maps of at least one view, found none");
  Materials out{std::move(roughness), ShBlock(cloud.size(), 3), ShBlock(cloud.size(), 1)};
  const auto by = options.solver == "linear" ? fitByLinearSolve : fitByDescent;
  by(maps, cloud, before, options, device, progress, out);
  return out;
}

// A Gaussian's view-dependence is fixed in world axes, what it was fitted to is fixed to the body: it is seen
// from the side that the normal faces, and that side turns.
Materials turnedTo(const GaussianCloud& cloud, const EarlierFrame& before) {
  Materials out = before.materials;
  parallelFor(cloud.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const dquat turn = dquat(cloud.rotation[i]) * glm::conjugate(dquat(before.cloud.rotation[i]));
      const ShRotation rotation(glm::mat3_cast(glm::normalize(turn)));
      rotation.apply(3, before.materials.base_color.of(i), out.base_color.of(i));
      rotation.apply(1, before.materials.ambient_occlusion.of(i), out.ambient_occlusion.of(i));
    }
  });
  return out;
}

}  // namespace

void describe(Fields& f, FitMaterialsOptions& o) {
  f.field({.name = "solver",
           .label = "Solver",
           .help = "\"linear\" solves weighted least squares; \"adam\" is the gradient descent of the paper "
                   "on absolute and structural difference (L1 + D-SSIM).",
           .choices = {"adam", "linear"}},
          o.solver);
  f.field({.name = "adam_iterations",
           .label = "Adam iterations",
           .help = "Adam: steps for each of base colour and occlusion; the paper takes 5,000.",
           .min = 1,
           .max = 1e6},
          o.adam_iterations);
  f.field({.name = "linear_iterations",
           .label = "Linear iterations",
           .help = "Linear solver: steps of conjugate gradients.",
           .min = 0,
           .max = 1000},
          o.linear_iterations);
  f.field(
      {.name = "regularization",
       .label = "Pull on view-dependence",
       .help =
           "How strongly what depends on the view is pulled towards 0; raise it when new views show spots.",
       .min = 0,
       .max = 100,
       .advanced = true},
      o.regularization);
}

void describe(Fields& f, LaterMaterialsOptions& o) {
  f.field(
      {.name = "memory_frames",
       .label = "Memory of base colour",
       .help =
           "Linear solver: the base colour of the frame before counts as much as the pictures of this many "
           "frames. Raise it when base colour flickers; 0 here and for occlusion: every frame by itself.",
       .min = 0,
       .max = 100,
       .unit = "frames"},
      o.memory_frames);
  f.field({.name = "occlusion_memory_frames",
           .label = "Memory of occlusion",
           .help = "Linear solver: ambient occlusion of the frame before counts as much as the pictures of "
                   "this many frames. It changes with the pose: too much makes it lag.",
           .min = 0,
           .max = 100,
           .unit = "frames",
           .advanced = true},
          o.occlusion_memory_frames);
  f.field({.name = "outlier",
           .label = "Difference that ends memory",
           .help = "Linear solver: where the pictures contradict the frame before by more than this, it "
                   "counts less; 1 is black against white.",
           .min = 0.001,
           .max = 100,
           .advanced = true},
          o.outlier);
  f.field({.name = "temporal_weight",
           .label = "Hold to the frame before",
           .help = "Adam: how strongly base colour is pulled towards that of the frame before; the paper "
                   "takes 0.00005.",
           .min = 0,
           .max = 1,
           .advanced = true},
          o.temporal_weight);
  f.field({.name = "adam_iterations",
           .label = "Adam iterations, later frames",
           .help = "Adam: steps of a frame that starts from the frame before.",
           .min = 1,
           .max = 1e6,
           .advanced = true},
          o.adam_iterations);
}

MapSource sourceOf(std::span<const MaterialMaps> maps) {
  const auto weights = [maps](std::size_t i) {
    return MaterialMaps{maps[i].camera, {}, {}, maps[i].ao_weight, maps[i].base_color_weight};
  };
  return {maps.size(), [maps](std::size_t i) { return maps[i]; }, weights};
}

Materials fitMaterials(const MapSource& maps, const GaussianCloud& cloud, float roughness,
                       const FitMaterialsOptions& options, ComputeDevice& device, Progress& progress) {
  return fit(maps, cloud, nullptr, options, device, progress, std::vector<float>(cloud.size(), roughness));
}

Materials fitLaterMaterials(const MapSource& maps, const GaussianCloud& cloud, const EarlierFrame& before,
                            const FitMaterialsOptions& options, ComputeDevice& device, Progress& progress) {
  const std::size_t n = cloud.size();
  if (before.cloud.size() != n || before.materials.roughness.size() != n) {
    throw Error(
        Error::Kind::Bug,
        fmt::format("a later frame's {} Gaussians must be those of the frame before, which has {} and "
                    "materials of {}",
                    n, before.cloud.size(), before.materials.roughness.size()));
  }
  const Materials turned = turnedTo(cloud, before);
  return fit(maps, cloud, &turned, options, device, progress, turned.roughness);
}

}  // namespace beam
