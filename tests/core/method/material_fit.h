// SPDX-License-Identifier: Apache-2.0
// A ball of Gaussians seen from all around, and maps of it as a bake would give them, from known materials.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "core/method/fit_materials.h"
#include "core/render/deferred.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam::testing {

class MaterialFit : public ::testing::Test {
 protected:
  MaterialFit() {
    addSphere(cloud, vec3(0), 0.4f, 250);
    for (int i = 0; i < 24; ++i) {
      const double y = 1 - (2 * i + 1.0) / 24, r = std::sqrt(1 - y * y), phi = 2.39996323 * i;
      cameras.push_back(
          cameraLookingAt(2.0 * dvec3(r * std::cos(phi), 0.9 * y, r * std::sin(phi)), dvec3(0), 48, 80));
    }
  }

  Materials blank() const {
    return {std::vector<float>(cloud.size(), 0.5f), ShBlock(cloud.size(), 3), ShBlock(cloud.size(), 1)};
  }

  // Maps as a bake would give them, from known materials.
  std::vector<MaterialMaps> mapsOf(const Materials& m) {
    std::vector<MaterialMaps> maps;
    GBufferRenderer renderer(*device);
    for (const Camera& camera : cameras) {
      const GBuffer g = renderer.render(*residentOf(*device, cloud, &m), camera);
      const int w = camera.width, h = camera.height;
      MaterialMaps map{camera, Planes(w, h, 1), Planes(w, h, 3), Planes(w, h, 1), Planes(w, h, 1)};
      for (std::size_t i = 0; i < g.alpha.pixels.size(); ++i) {
        const float alpha = g.alpha.pixels[i];
        if (alpha < 0.3f) continue;
        map.ambient_occlusion.values[i] = g.ambient_occlusion.pixels[i] / alpha;
        for (int c = 0; c < 3; ++c) map.base_color.plane(c)[i] = g.base_color.pixels[i][c] / alpha;
        map.ao_weight.values[i] = map.base_color_weight.values[i] = 1;
      }
      maps.push_back(std::move(map));
    }
    return maps;
  }

  Materials fit(std::span<const MaterialMaps> maps, const FitMaterialsOptions& options) {
    Progress progress;
    return fitMaterials(sourceOf(maps), cloud, 0.5f, options, *device, progress);
  }

  struct Difference {
    float worst = 0;
    double rms = 0;
  };
  // Of what the training cameras see.
  Difference difference(const Materials& a, const Materials& b) {
    GBufferRenderer renderer(*device);
    Difference d;
    int count = 0;
    for (const Camera& camera : cameras) {
      const GBuffer p = renderer.render(*residentOf(*device, cloud, &a), camera),
                    q = renderer.render(*residentOf(*device, cloud, &b), camera);
      for (std::size_t i = 0; i < p.alpha.pixels.size(); ++i) {
        if (p.alpha.pixels[i] < 0.9f) continue;
        const vec4 apart(p.base_color.pixels[i] - q.base_color.pixels[i],
                         p.ambient_occlusion.pixels[i] - q.ambient_occlusion.pixels[i]);
        for (int c = 0; c < 4; ++c) d.worst = std::max(d.worst, std::abs(apart[c]));
        d.rms += glm::dot(apart, apart);
        count += 4;
      }
    }
    d.rms = std::sqrt(d.rms / count);
    return d;
  }

  std::unique_ptr<ComputeDevice> device = makeCpuDevice();
  GaussianCloud cloud;
  std::vector<Camera> cameras;
  FitMaterialsOptions linear{.solver = "linear", .linear_iterations = 300, .regularization = 1e-7};
};

}  // namespace beam::testing
