// SPDX-License-Identifier: Apache-2.0
#include "core/render/gaussian_buffers.h"

namespace beam {

GaussianBuffers toBuffers(const GaussianCloud& cloud, int extra_channels) {
  GaussianBuffers b(cloud.size(), extra_channels);
  using L = PlaneLayout;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const quat& q = cloud.rotation[i];
    const float rotation[4] = {q.w, q.x, q.y, q.z};
    for (int k = 0; k < 3; ++k) b.plane(L::kPosition + k)[i] = cloud.position_m[i][k];
    for (int k = 0; k < 4; ++k) b.plane(L::kRotation + k)[i] = rotation[k];
    for (int k = 0; k < 3; ++k) b.plane(L::kScale + k)[i] = cloud.scale_m[i][k];
    b.plane(L::kOpacity)[i] = cloud.opacity[i];
    for (int k = 0; k < kShCount * 3; ++k) b.plane(L::kSh + k)[i] = cloud.color.of(i)[k];
  }
  return b;
}

GaussianCloud toCloud(const GaussianBuffers& b) {
  GaussianCloud c;
  using L = PlaneLayout;
  c.color = ShBlock(b.count, 3);
  for (std::size_t i = 0; i < b.count; ++i) {
    const auto at = [&](int plane) { return b.plane(plane)[i]; };
    c.position_m.emplace_back(at(L::kPosition), at(L::kPosition + 1), at(L::kPosition + 2));
    c.rotation.push_back(glm::normalize(
        quat(at(L::kRotation), at(L::kRotation + 1), at(L::kRotation + 2), at(L::kRotation + 3))));
    c.scale_m.emplace_back(at(L::kScale), at(L::kScale + 1), at(L::kScale + 2));
    c.opacity.push_back(at(L::kOpacity));
    for (int k = 0; k < kShCount * 3; ++k) c.color.of(i)[k] = at(L::kSh + k);
  }
  return c;
}

}  // namespace beam
