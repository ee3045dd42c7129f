// SPDX-License-Identifier: Apache-2.0
// The reference: light followed path by path through the Gaussians (methods 7.5), which real-time shading is
// judged by. A ray ends in a Gaussian drawn by its blend weight; of what the camera sees, normal and material
// are the blended ones. Light from the panorama by next-event estimation with multiple importance sampling,
// bounces by cosine and visible normals, no baked occlusion. Progressive; the same picture for any number of
// threads and any instruction set.
#pragma once

#include <cstdint>
#include <memory>

#include "core/render/device.h"
#include "core/render/path_integrator.h"
#include "core/render/scene_renderer.h"

namespace beam {

struct ReferenceOptions {
  int samples = 128;       // paths a pixel
  int bounces = 2;         // of a path, after the first hit
  bool denoise = true;     // by the house's filter (image/filter.h), guided by the first hit
  float offset_m = 0.02f;  // of a path's next ray along the normal, as of occlusion (methods A-23)
  std::uint64_t seed = 1;
  // --- What tests take apart ---
  bool specular = true;
  LightDraws draws = LightDraws::Both;
};

inline constexpr int kMostSamples = 65536;

// Draws relight and its parts, and what the CPU renderer draws without light. Throws Error{Usage} for options
// out of range.
std::unique_ptr<SceneRenderer> newReferenceSceneRenderer(std::shared_ptr<ComputeDevice> device,
                                                         const ReferenceOptions& options);

}  // namespace beam
