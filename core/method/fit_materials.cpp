// SPDX-License-Identifier: Apache-2.0
#include "core/method/fit_materials.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/math/color.h"
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

void fitByDescent(std::span<const MaterialMaps> maps, const GaussianCloud& cloud,
                  const FitMaterialsOptions& options, ComputeDevice& device, Progress& progress,
                  Materials& out) {
  Progress color_part = progress.part(0.5, "fitting base colour");
  out.base_color =
      fitDescent(maps, MapKind::BaseColor, cloud, fromRadiance(cloud), options, device, color_part);
  Progress occlusion_part = progress.part(0.5, "fitting ambient occlusion");
  const ShBlock occlusion = fitDescent(maps, MapKind::AmbientOcclusion, cloud, ShBlock(cloud.size(), 3),
                                       options, device, occlusion_part);
  for (std::size_t i = 0; i < out.ambient_occlusion.coefficients.size(); ++i) {
    out.ambient_occlusion.coefficients[i] = occlusion.coefficients[i * 3];
  }
}

void fitByLinearSolve(std::span<const MaterialMaps> maps, const GaussianCloud& cloud,
                      const FitMaterialsOptions& options, ComputeDevice& device, Progress& progress,
                      Materials& out) {
  const MaterialCoefficients x = fitLinear(maps, cloud, options, device, progress);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (int c = 0; c < 3; ++c) out.base_color.coefficients[i * 3 + c] = x[i][c];
    out.ambient_occlusion.coefficients[i] = x[i].w;
  }
}

}  // namespace

void describe(Fields& f, FitMaterialsOptions& o) {
  f.field(
      {.name = "solver",
       .label = "Solver",
       .help = "\"adam\" is the paper's descent on L1 + D-SSIM; \"linear\" solves weighted least squares.",
       .choices = {"adam", "linear"}},
      o.solver);
  f.field({.name = "adam_iterations",
           .label = "Adam iterations",
           .help = "Steps for each of base colour and occlusion; the paper takes 5000 (3.2).",
           .min = 1,
           .max = 1e6},
          o.adam_iterations);
  f.field({.name = "linear_iterations",
           .label = "Linear iterations",
           .help = "Steps of conjugate gradients.",
           .min = 0,
           .max = 1000},
          o.linear_iterations);
  f.field({.name = "regularization",
           .label = "Regularization",
           .help = "Pull of the view-dependent coefficients towards 0; raise it when new views show spots.",
           .min = 0,
           .max = 100,
           .advanced = true},
          o.regularization);
}

Materials fitMaterials(std::span<const MaterialMaps> maps, const GaussianCloud& cloud, float roughness,
                       const FitMaterialsOptions& options, ComputeDevice& device, Progress& progress) {
  if (maps.empty())
    throw Error(Error::Kind::Data, "material fit: expected the maps of at least one view, found none");
  Materials out{std::vector<float>(cloud.size(), roughness), ShBlock(cloud.size(), 3),
                ShBlock(cloud.size(), 1)};
  if (options.solver == "linear") {
    fitByLinearSolve(maps, cloud, options, device, progress, out);
  } else {
    fitByDescent(maps, cloud, options, device, progress, out);
  }
  return out;
}

}  // namespace beam
