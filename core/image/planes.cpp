// SPDX-License-Identifier: Apache-2.0
#include "core/image/planes.h"

namespace beam {

Planes planesOf(const Image<float>& image) {
  Planes p(image.width, image.height, 1);
  p.values = image.pixels;
  return p;
}

Planes planesOf(const Image<vec3>& image, const dmat3& rotation) {
  Planes p(image.width, image.height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const dvec3 v = rotation * dvec3(image.pixels[i]);
    for (int c = 0; c < 3; ++c) p.plane(c)[i] = static_cast<float>(v[c]);
  }
  return p;
}

}  // namespace beam
