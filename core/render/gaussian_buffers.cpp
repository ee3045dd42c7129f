// SPDX-License-Identifier: Apache-2.0
#include "core/render/gaussian_buffers.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace beam {

void packPlanes(std::span<const float> values, std::size_t planes, std::size_t gaussians, std::size_t stride,
                float* to) {
  // Blocks of Gaussians that stay in the first cache while their planes are written one after the other.
  constexpr std::size_t kBlock = 64, kGrain = 32;
  parallelFor((gaussians + kBlock - 1) / kBlock, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t first = begin * kBlock; first < std::min(end * kBlock, gaussians); first += kBlock) {
      const std::size_t last = std::min(first + kBlock, gaussians);
      for (std::size_t p = 0; p < planes; ++p) {
        for (std::size_t i = first; i < last; ++i) to[p * stride + i] = values[i * planes + p];
      }
    }
  });
}

void packCloud(const GaussianCloud& cloud, GaussianBuffers& into, std::size_t first) {
  using L = PlaneLayout;
  const std::size_t n = cloud.size();
  const auto at = [&](int plane) { return into.plane(plane) + first; };
  for (std::size_t i = 0; i < n; ++i) {
    const quat& q = cloud.rotation[i];
    const float rotation[4] = {q.w, q.x, q.y, q.z};
    for (int k = 0; k < 3; ++k) at(L::kPosition + k)[i] = cloud.position_m[i][k];
    for (int k = 0; k < 4; ++k) at(L::kRotation + k)[i] = rotation[k];
    for (int k = 0; k < 3; ++k) at(L::kScale + k)[i] = cloud.scale_m[i][k];
  }
  std::copy(cloud.opacity.begin(), cloud.opacity.end(), at(L::kOpacity));
  packPlanes(cloud.color.coefficients, kShCount * 3, n, into.stride, at(L::kSh));
}

GaussianBuffers toBuffers(const GaussianCloud& cloud, int extra_channels) {
  GaussianBuffers b(cloud.size(), extra_channels);
  packCloud(cloud, b, 0);
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
