// SPDX-License-Identifier: Apache-2.0
#include "core/image/filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "core/math/color.h"

namespace beam {
namespace {

constexpr float kSpline[3] = {3 / 8.0f, 1 / 4.0f, 1 / 16.0f};  // B3, by distance

bool inside(const Image<float>& image, int x, int y) {
  return x >= 0 && y >= 0 && x < image.width && y < image.height;
}

// Median of the steps between horizontal and vertical neighbours of the 3x3 patch around an inner pixel.
float medianStep(const Image<float>& z, int x, int y) {
  std::array<float, 12> steps{};
  int count = 0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      if (i < 1) steps[count++] = std::abs(z(x + i + 1, y + j) - z(x + i, y + j));
      if (j < 1) steps[count++] = std::abs(z(x + i, y + j + 1) - z(x + i, y + j));
    }
  }
  std::nth_element(steps.begin(), steps.begin() + 6, steps.end());
  return steps[6];
}

bool isDepthEdge(const Image<float>& z, const Image<float>& alpha, int x, int y) {
  if (x == 0 || y == 0 || x == z.width - 1 || y == z.height - 1 || z(x, y) <= 0) return true;
  const float limit = std::max(0.02f, 3 * medianStep(z, x, y));
  constexpr ivec2 kNeighbours[4] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  for (const ivec2& d : kNeighbours) {
    if (alpha(x + d.x, y + d.y) < 0.5f || std::abs(z(x + d.x, y + d.y) - z(x, y)) > limit) return true;
  }
  return false;
}

// The smaller of the one-sided differences along an axis: the slope of the own surface beside an edge.
float slopeAlong(const DenoiseGuides& g, int x, int y, ivec2 axis) {
  float best = 0;
  bool found = false;
  for (const int side : {-1, 1}) {
    const int u = x + side * axis.x, v = y + side * axis.y;
    if (!inside(g.depth_m, u, v) || !g.valid(u, v)) continue;
    const float slope = side * (g.depth_m(u, v) - g.depth_m(x, y));
    if (!found || std::abs(slope) < std::abs(best)) best = slope;
    found = true;
  }
  return best;
}

float brightness(const Planes& p, std::size_t i) {
  if (p.channels == 1) return p.values[i];
  const std::size_t n = p.planeSize();
  return luminance({p.values[i], p.values[n + i], p.values[2 * n + i]});
}

struct Scene {
  const DenoiseGuides& guides;
  Image<vec2> slope;                  // metres a pixel
  std::vector<std::uint32_t> pixels;  // the valid ones
};

Scene prepare(const DenoiseGuides& guides) {
  Scene s{guides, Image<vec2>(guides.depth_m.width, guides.depth_m.height), {}};
  for (int y = 0; y < guides.valid.height; ++y) {
    for (int x = 0; x < guides.valid.width; ++x) {
      if (!guides.valid(x, y)) continue;
      s.slope(x, y) = {slopeAlong(guides, x, y, {1, 0}), slopeAlong(guides, x, y, {0, 1})};
      s.pixels.push_back(static_cast<std::uint32_t>(s.slope.index(x, y)));
    }
  }
  return s;
}

// Calls use(neighbour, weight of spline, normal and depth) for the taps of a pixel.
template <class Use>
void forTaps(const Scene& s, std::uint32_t pixel, int distance, Use&& use) {
  const DenoiseGuides& g = s.guides;
  const int x = static_cast<int>(pixel) % g.valid.width, y = static_cast<int>(pixel) / g.valid.width;
  const vec3 n = g.normal.pixels[pixel];
  const float z = g.depth_m.pixels[pixel];
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i) {
      const int u = x + i * distance, v = y + j * distance;
      if (!inside(g.depth_m, u, v) || !g.valid(u, v)) continue;
      const std::size_t q = g.valid.index(u, v);
      float facing = std::max(0.0f, glm::dot(n, g.normal.pixels[q]));
      for (int k = 0; k < 6; ++k) facing *= facing;  // to the power of 64
      const vec2 step(static_cast<float>(i * distance), static_cast<float>(j * distance));
      const float reach = std::abs(glm::dot(s.slope.pixels[pixel], step)) + 1e-3f * z;
      const float apart = std::abs(g.depth_m.pixels[q] - z) / reach;
      use(q, kSpline[std::abs(i)] * kSpline[std::abs(j)] * facing * std::exp(-apart));
    }
  }
}

// The variance of two half buffers has one degree of freedom: only its mean over a neighbourhood says
// something.
Planes smoothed(const Planes& variance, const Scene& s, int distance) {
  Planes out(variance.width, variance.height, 1);
  parallelFor(s.pixels.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      float sum = 0, weight = 0;
      forTaps(s, s.pixels[p], distance, [&](std::size_t q, float w) {
        sum += w * variance.values[q];
        weight += w;
      });
      out.values[s.pixels[p]] = sum / weight;
    }
  });
  return out;
}

NoisySignal filtered(const NoisySignal& in, const Scene& s, int distance) {
  const Planes spread = smoothed(in.variance, s, 1);
  const std::size_t n = in.values.planeSize();
  const int channels = in.values.channels;
  NoisySignal out = in;
  parallelFor(s.pixels.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::uint32_t pixel = s.pixels[p];
      const float own = brightness(in.values, pixel);
      const float tolerance = 4 * std::sqrt(spread.values[pixel]) + 1e-6f;
      float weight = 0, variance = 0;
      vec3 sum(0);
      forTaps(s, pixel, distance, [&](std::size_t q, float w) {
        w *= std::exp(-std::abs(brightness(in.values, q) - own) / tolerance);
        weight += w;
        variance += w * w * in.variance.values[q];
        for (int c = 0; c < channels; ++c) sum[c] += w * in.values.values[n * c + q];
      });
      for (int c = 0; c < channels; ++c) out.values.values[n * c + pixel] = sum[c] / weight;
      out.variance.values[pixel] = variance / (weight * weight);
    }
  });
  return out;
}

}  // namespace

Image<std::uint8_t> depthEdges(const Image<float>& depth_m, const Image<float>& alpha) {
  Image<std::uint8_t> edges(depth_m.width, depth_m.height, 0);
  for (int y = 0; y < edges.height; ++y) {
    for (int x = 0; x < edges.width; ++x) edges(x, y) = isDepthEdge(depth_m, alpha, x, y);
  }
  return edges;
}

float evenDepth(const SurfaceGuides& s, int x, int y, int radius) {
  constexpr float kReach_m = 0.03f;
  const float z = s.depth_m(x, y),
              falloff = 2.0f / static_cast<float>(radius * radius);  // sigma: half the radius
  float sum = 0, weight = 0;
  for (int v = std::max(0, y - radius); v <= std::min(s.alpha.height - 1, y + radius); ++v) {
    for (int u = std::max(0, x - radius); u <= std::min(s.alpha.width - 1, x + radius); ++u) {
      const float other = s.depth_m(u, v);
      if (!(s.alpha(u, v) > 0.9f) || std::abs(other - z) > kReach_m) continue;
      float w = std::max(0.0f, glm::dot(s.normal(x, y), s.normal(u, v)));
      for (int k = 0; k < 3; ++k) w *= w;
      w *= std::exp(-falloff * static_cast<float>((u - x) * (u - x) + (v - y) * (v - y)));
      sum += w * other;
      weight += w;
    }
  }
  return weight > 0 ? sum / weight : z;
}

void denoiseATrous(std::span<NoisySignal> signals, const DenoiseGuides& guides, int levels,
                   const Progress& progress) {
  const Scene scene = prepare(guides);
  for (NoisySignal& signal : signals) {
    signal.variance = smoothed(signal.variance, scene, 2);
    for (int level = 0; level < levels; ++level) {
      progress.check();
      signal = filtered(signal, scene, 1 << level);
    }
  }
}

}  // namespace beam
