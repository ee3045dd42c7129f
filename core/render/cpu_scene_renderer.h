// SPDX-License-Identifier: Apache-2.0
// The renderer of the compute device: rasterised Gaussians, deferred shading in the light of a panorama
// (render/deferred.h). Needs no graphics, draws every channel of the table that is a picture, and any
// attribute of the Gaussians. No meshes, no ground, no other lights.
#pragma once

#include <memory>

#include "core/render/device.h"
#include "core/render/prepared_light.h"
#include "core/render/scene_renderer.h"

namespace beam {

// `lights` may be shared with others; null: it keeps its own. `kept_sizes`: picture sizes between which one
// goes to and fro.
std::unique_ptr<SceneRenderer> newCpuSceneRenderer(std::shared_ptr<ComputeDevice> device,
                                                   std::shared_ptr<PreparedLights> lights = nullptr,
                                                   std::size_t kept_sizes = 1);

// `device` outlives it.
std::unique_ptr<SceneRenderer> newCpuSceneRenderer(ComputeDevice& device);

// Makes renderers that share prepared lights.
SceneRendererFactory cpuSceneRenderers(std::shared_ptr<ComputeDevice> device, std::size_t kept_sizes = 1);

}  // namespace beam
