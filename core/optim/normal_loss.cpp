// SPDX-License-Identifier: Apache-2.0
#include "core/optim/normal_loss.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"

namespace beam {
namespace {

constexpr std::size_t kRows = 16;

struct DepthField {
  const float* z;
  const float* alpha;
  int width, height;
  float fx, fy, cx, cy;

  vec3 ray(int x, int y) const { return {(x + 0.5f - cx) / fx, (y + 0.5f - cy) / fy, 1.0f}; }
  vec3 point(int x, int y) const { return z[y * width + x] * ray(x, y); }
};

DepthField fieldOf(const Planes& depth, const Planes& alpha, const Intrinsics& k) {
  return {depth.plane(0),
          alpha.plane(0),
          depth.width,
          depth.height,
          static_cast<float>(k.fx),
          static_cast<float>(k.fy),
          static_cast<float>(k.cx),
          static_cast<float>(k.cy)};
}

// Whether the differences at an inner pixel stay on one surface.
bool smooth(const DepthField& f, int x, int y) {
  const int p = y * f.width + x;
  const std::array<int, 4> around = {p - 1, p + 1, p - f.width, p + f.width};
  if (f.alpha[p] < 0.5f) return false;
  std::array<float, 4> dz;
  for (int i = 0; i < 4; ++i) {
    if (f.alpha[around[i]] < 0.5f || f.z[around[i]] <= 0) return false;
    dz[i] = std::abs(f.z[around[i]] - f.z[p]);
  }
  const float largest = *std::max_element(dz.begin(), dz.end());
  std::nth_element(dz.begin(), dz.begin() + 1, dz.end());
  return largest <= std::max(0.02f, 3 * dz[1]);
}

struct Differences {
  vec3 a, b;    // down and right differences of the points
  vec3 normal;  // normalize(a x b)
  float length = 0;
};

Differences differences(const DepthField& f, int x, int y) {
  Differences d;
  d.a = f.point(x, y + 1) - f.point(x, y - 1);
  d.b = f.point(x + 1, y) - f.point(x - 1, y);
  const vec3 c = glm::cross(d.a, d.b);
  d.length = std::max(glm::length(c), 1e-12f);
  d.normal = c / d.length;
  return d;
}

void ensure(Planes& p, int width, int height, int channels) {
  if (p.width == width && p.height == height && p.channels == channels) return;
  p = Planes(width, height, channels);
}

struct PixelGradient {
  vec3 da{0}, db{0};
};

// Loss of one depth; adds to the gradients of A, S and of the depth (`d_depth`).
double depthTerm(const DepthField& f, const Planes& normal, double scale, RasterImages& upstream,
                 Planes& d_depth) {
  const int w = f.width, h = f.height;
  std::vector<PixelGradient> pixel(static_cast<std::size_t>(w) * h);
  const auto rows = static_cast<std::size_t>(h);
  const auto g = static_cast<float>(scale);
  const double loss = parallelReduce(
      rows, kRows, 0.0,
      [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (int y = std::max<int>(1, static_cast<int>(begin));
             y < std::min<int>(h - 1, static_cast<int>(end)); ++y) {
          for (int x = 1; x < w - 1; ++x) {
            const int p = y * w + x;
            if (!smooth(f, x, y)) continue;
            const Differences d = differences(f, x, y);
            const vec3 s(normal.plane(0)[p], normal.plane(1)[p], normal.plane(2)[p]);
            sum += f.alpha[p] - glm::dot(s, d.normal);
            upstream.alpha.plane(0)[p] += g;
            for (int c = 0; c < 3; ++c) upstream.normal.plane(c)[p] -= g * d.normal[c];
            const vec3 g_n = -g * s;
            const vec3 g_c = (g_n - d.normal * glm::dot(g_n, d.normal)) / d.length;
            pixel[p] = {glm::cross(d.b, g_c), glm::cross(g_c, d.a)};
          }
        }
        return sum;
      },
      [](double a, double b) { return a + b; });
  parallelFor(rows, kRows, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < w; ++x) {
        const int p = y * w + x;
        // The point at p is "below" of p - w, "above" of p + w, "right" of p - 1, "left" of p + 1.
        vec3 g_point(0);
        if (y > 0) g_point += pixel[p - w].da;
        if (y < h - 1) g_point -= pixel[p + w].da;
        if (x > 0) g_point += pixel[p - 1].db;
        if (x < w - 1) g_point -= pixel[p + 1].db;
        d_depth.plane(0)[p] += glm::dot(g_point, f.ray(x, y));
      }
    }
  });
  return loss * scale;
}

}  // namespace

Planes normalsFromDepth(const Planes& depth, const Planes& alpha, const Intrinsics& intrinsics) {
  const DepthField f = fieldOf(depth, alpha, intrinsics);
  Planes out(f.width, f.height, 3);
  parallelFor(static_cast<std::size_t>(f.height), kRows, [&](std::size_t begin, std::size_t end) {
    for (int y = std::max<int>(1, static_cast<int>(begin));
         y < std::min<int>(f.height - 1, static_cast<int>(end)); ++y) {
      for (int x = 1; x < f.width - 1; ++x) {
        if (!smooth(f, x, y)) continue;
        const vec3 n = differences(f, x, y).normal;
        for (int c = 0; c < 3; ++c) out.plane(c)[y * f.width + x] = n[c];
      }
    }
  });
  return out;
}

double normalLoss(const RasterImages& images, const Intrinsics& intrinsics, const NormalLossOptions& options,
                  RasterImages& upstream) {
  const int w = images.alpha.width, h = images.alpha.height;
  ensure(upstream.alpha, w, h, 1);
  ensure(upstream.normal, w, h, 3);
  ensure(upstream.depth, w, h, 1);
  ensure(upstream.median_depth, w, h, 1);
  const double pixels = options.pixels > 0 ? options.pixels : static_cast<double>(w) * h;
  const double expected = options.weight * options.expected_share / pixels;
  const double median = options.weight * (1 - options.expected_share) / pixels;
  double loss = 0;
  if (expected > 0) {
    loss += depthTerm(fieldOf(images.depth, images.alpha, intrinsics), images.normal, expected, upstream,
                      upstream.depth);
  }
  if (median > 0) {
    loss += depthTerm(fieldOf(images.median_depth, images.alpha, intrinsics), images.normal, median, upstream,
                      upstream.median_depth);
  }
  return loss;
}

}  // namespace beam
