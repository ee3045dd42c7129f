// SPDX-License-Identifier: Apache-2.0
// A small scene whose sides tell themselves apart by colour, and how to read colours off a view.
#pragma once

#include <QImage>

#include <memory>
#include <utility>
#include <vector>

#include "core/scene/render_scene.h"
#include "tests/support/splat_shapes.h"

namespace beam::testing {

// The mean colour of a rectangle in shares of the picture's size.
inline vec3 meanColor(const QImage& image, QRectF share) {
  dvec3 sum(0);
  int count = 0;
  for (int y = static_cast<int>(share.top() * image.height()); y < share.bottom() * image.height(); ++y) {
    for (int x = static_cast<int>(share.left() * image.width()); x < share.right() * image.width(); ++x) {
      const QColor c = image.pixelColor(x, y);
      sum += dvec3(c.red(), c.green(), c.blue());
      ++count;
    }
  }
  return vec3(sum / static_cast<double>(count));
}

// A red ball at +Y above a blue one at -Y, a green one to the right (+X).
inline std::shared_ptr<const GaussianCloud> threeBalls() {
  auto cloud = std::make_shared<GaussianCloud>();
  const auto ball = [&](vec3 center, vec3 color) {
    const std::size_t first = cloud->size();
    addSphere(*cloud, center, 0.3f, 400);
    for (std::size_t i = first; i < cloud->size(); ++i) {
      for (int c = 0; c < 3; ++c) cloud->color.of(i)[c] = (color[c] - 0.5f) / kShC0;
    }
  };
  ball(vec3(0, 0.6f, 0), vec3(0.9f, 0.1f, 0.1f));
  ball(vec3(0, -0.6f, 0), vec3(0.1f, 0.1f, 0.9f));
  ball(vec3(0.6f, 0, 0), vec3(0.1f, 0.8f, 0.1f));
  return cloud;
}

inline std::shared_ptr<const Materials> plainMaterials(std::size_t count) {
  auto materials = std::make_shared<Materials>();
  materials->roughness.assign(count, 0.6f);
  materials->base_color = ShBlock(count, 3);
  materials->ambient_occlusion = ShBlock(count, 1);
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) materials->base_color.of(i)[c] = ((c == 0 ? 0.6f : 0.2f) - 0.5f) / kShC0;
    materials->ambient_occlusion.of(i)[0] = 0.5f / kShC0;
  }
  return materials;
}

// One instance where it was captured; `materials` may be null.
inline std::vector<RenderInstance> sceneOf(std::shared_ptr<const GaussianCloud> cloud,
                                           std::shared_ptr<const Materials> materials = nullptr) {
  static const auto none = std::make_shared<const std::vector<Attribute>>();
  RenderInstance instance;
  instance.cloud = std::move(cloud);
  instance.materials = std::move(materials);
  instance.attributes = none;
  return {instance};
}

}  // namespace beam::testing
