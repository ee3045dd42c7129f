// SPDX-License-Identifier: Apache-2.0
// The reference: light followed path by path among Gaussians, meshes and the ground (methods 7.5), which
// real-time shading is judged by. A ray ends in a Gaussian drawn by its blend weight, or in a mesh; of what
// the camera sees of Gaussians, normal and material are the blended ones, and meshes have smooth edges
// (first_hits.h). Light from the panorama by next-event estimation with multiple importance sampling, bounces
// by cosine and visible normals, no baked occlusion. Progressive; the same picture for any number of threads
// and any instruction set.
#pragma once

#include <cstdint>
#include <memory>

#include "core/render/device.h"
#include "core/render/path_integrator.h"
#include "core/render/scene_renderer.h"

namespace beam {

struct ReferenceOptions {
  int samples = 128;    // paths a pixel
  int bounces = 2;      // of a path, after the first hit
  bool denoise = true;  // by the house's filter (image/filter.h), guided by the first hit
  // Of a path's next ray along the normal of Gaussians, as of occlusion (methods A-23); never through a mesh.
  // From meshes rays go on where they are.
  float offset_m = 0.02f;
  std::uint64_t seed = 1;
  // --- What tests take apart ---
  bool specular = true;
  LightDraws draws = LightDraws::Both;
};

inline constexpr int kMostSamples = 65536;

// Draws relight and its parts, and what the CPU renderer draws without light. Throws Error{Usage} for options
// out of range; its load() Error{Data} for a mesh that is broken.
std::unique_ptr<SceneRenderer> newReferenceSceneRenderer(std::shared_ptr<ComputeDevice> device,
                                                         const ReferenceOptions& options);

}  // namespace beam
