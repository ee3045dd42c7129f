// SPDX-License-Identifier: Apache-2.0
// Scenes of one material, and what the reference renderer draws of them.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "core/render/reference_scene_renderer.h"

namespace beam::testing {

inline RenderInstance gaussiansOf(GaussianCloud cloud, vec3 base_color, float roughness) {
  const std::size_t n = cloud.size();
  auto materials = std::make_shared<Materials>();
  materials->roughness.assign(n, roughness);
  materials->base_color = ShBlock(n, 3);
  materials->ambient_occlusion = ShBlock(n, 1);
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) materials->base_color.of(i)[c] = (base_color[c] - 0.5f) / kShC0;
  RenderInstance instance;
  instance.cloud = std::make_shared<const GaussianCloud>(std::move(cloud));
  instance.attributes = std::make_shared<const std::vector<Attribute>>();
  instance.materials = std::move(materials);
  return instance;
}

inline std::shared_ptr<const Environment> uniform() {
  return std::make_shared<const Environment>(makeEnvironment(Image<vec3>(32, 16, vec3(1))));
}

// The last of the pictures.
inline RenderedPicture pictureOf(const RenderScene& scene, const Camera& camera,
                                 const std::vector<const char*>& ids, const ReferenceOptions& options) {
  const auto renderer = newReferenceSceneRenderer(makeCpuDevice(), options);
  EXPECT_TRUE(renderer->load(scene).empty());
  std::vector<ChannelInfo> asked;
  for (const char* id : ids) asked.push_back(channelOf(id));
  RenderedPicture last;
  Progress progress;
  renderer->draw(camera, asked, progress, [&](RenderedPicture p) { last = std::move(p); });
  EXPECT_TRUE(last.final);
  return last;
}

inline vec3 pixelOf(const RenderedPicture& picture, const char* id, std::size_t pixel) {
  const Planes& p = *channelIn(picture, id)->values;
  vec3 value(0);
  for (int c = 0; c < p.channels; ++c) value[c] = p.plane(c)[pixel];
  return value;
}

inline vec3 meanOf(const Planes& p) {
  dvec3 sum(0);
  const std::size_t n = p.values.size() / 3;
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) sum[c] += p.plane(c)[i];
  return vec3(sum / static_cast<double>(n));
}

}  // namespace beam::testing
