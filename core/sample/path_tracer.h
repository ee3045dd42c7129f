// SPDX-License-Identifier: Apache-2.0
// The sample's pictures by path tracing: one posed figure with its procedural looks under a panorama, over
// core/render/triangle_tracer.h and path_integrator.h. Works in the house's world axes.
#pragma once

#include <memory>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/sample/figure.h"
#include "core/scene/camera.h"
#include "core/scene/environment.h"

namespace beam {

struct TraceSettings {
  int samples = 48;
  int bounces = 2;
  std::uint64_t seed = 1;
};

// Everything the ground truth holds of a view: composited on black except normal and depth.
struct TracedMaps {
  Image<vec3> base_color, normal;  // normal: world, unit, 0 outside
  Image<float> roughness, ambient_occlusion, depth_m, coverage;
};

class SampleScene {
 public:
  // `surface` of the figure, in capture axes; `world_from_capture` turns it. Keeps a reference to the figure.
  SampleScene(const Figure& figure, const Mesh& surface, const dmat3& world_from_capture);
  ~SampleScene();
  SampleScene(const SampleScene&) = delete;
  SampleScene& operator=(const SampleScene&) = delete;

  // Moves the vertices; the triangles stay.
  void pose(const Mesh& surface);

  // Linear radiance on black, and the coverage.
  struct Picture {
    Image<vec3> radiance;
    Image<float> coverage;
  };
  Picture photograph(const Camera& camera, const EnvironmentSampler& light, const TraceSettings& settings,
                     const Progress& progress) const;
  TracedMaps maps(const Camera& camera, const TraceSettings& settings, const Progress& progress) const;
  // Cosine-weighted share of the sky that a point with this normal sees.
  float skyVisibility(vec3 x_in_world, vec3 normal, int samples, std::uint64_t seed) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace beam
