// SPDX-License-Identifier: Apache-2.0
// The slow right answer: every Gaussian at every pixel, in double, sorted by depth, without tiles
// (methods 1.2-1.5, 2.1-2.4). Independent of the engine's kernels.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/math/sh.h"
#include "core/render/rasterizer.h"

namespace beam::testing {

struct ReferencePixel {
  dvec3 color{0}, normal{0};
  double alpha = 0, depth = 0, median = 0;
  std::vector<double> extra;
};

struct ReferenceOptions {
  double min_alpha = 1 / 255.0;  // 0 takes the step out of finite differences
  double min_transmittance = 1e-4;
  int sh_degree = 3;
  dvec3 background{0};
  double dilation_px2 = 0;
};

// `values` holds the planes of GaussianBuffers in double: values[plane * count + gaussian].
class ReferenceRaster {
 public:
  ReferenceRaster(std::size_t count, int extra, const Camera& camera, ReferenceOptions options)
      : count_(count), extra_(extra), camera_(camera), options_(options) {}

  std::vector<ReferencePixel> draw(const std::vector<double>& values) const {
    std::vector<Splat> splats;
    for (std::size_t i = 0; i < count_; ++i) splats.push_back(projected(values, i));
    std::stable_sort(splats.begin(), splats.end(),
                     [](const Splat& a, const Splat& b) { return a.t.z < b.t.z; });
    std::vector<ReferencePixel> out;
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) out.push_back(pixel(splats, values, {x + 0.5, y + 0.5}));
    }
    return out;
  }

 private:
  using L = PlaneLayout;
  struct Splat {
    std::size_t index;
    bool drawn;
    dvec3 t, normal, color;
    dvec2 mean;
    double ka, kb, kc, opacity;
    dmat3 inverse_covariance;  // camera axes
  };

  double at(const std::vector<double>& v, int plane, std::size_t i) const { return v[plane * count_ + i]; }

  Splat projected(const std::vector<double>& v, std::size_t i) const {
    Splat s{};
    s.index = i;
    const dmat3 w = glm::mat3_cast(camera_.camera_from_world.rotation);
    const dvec3 mu(at(v, 0, i), at(v, 1, i), at(v, 2, i));
    s.t = w * mu + camera_.camera_from_world.translation_m;
    s.drawn = s.t.z > 0.05;
    const dquat q = glm::normalize(dquat(at(v, L::kRotation, i), at(v, L::kRotation + 1, i),
                                         at(v, L::kRotation + 2, i), at(v, L::kRotation + 3, i)));
    const dmat3 rc = w * glm::mat3_cast(q);
    dmat3 s2(0.0), inverse_s2(0.0);
    for (int k = 0; k < 3; ++k) {
      const double scale = at(v, L::kScale + k, i);
      s2[k][k] = scale * scale;
      inverse_s2[k][k] = 1 / (scale * scale);
    }
    const dmat3 covariance = rc * s2 * glm::transpose(rc);
    s.inverse_covariance = rc * inverse_s2 * glm::transpose(rc);
    const Intrinsics& n = camera_.intrinsics;
    const double tan_x = 0.5 * camera_.width / n.fx, tan_y = 0.5 * camera_.height / n.fy, z = s.t.z;
    const double xr =
        std::clamp(s.t.x / z, -n.cx / n.fx - 0.3 * tan_x, (camera_.width - n.cx) / n.fx + 0.3 * tan_x);
    const double yr =
        std::clamp(s.t.y / z, -n.cy / n.fy - 0.3 * tan_y, (camera_.height - n.cy) / n.fy + 0.3 * tan_y);
    const dvec3 j0(n.fx / z, 0, -n.fx * xr / z), j1(0, n.fy / z, -n.fy * yr / z);
    const double a = glm::dot(j0, covariance * j0) + options_.dilation_px2, b = glm::dot(j0, covariance * j1);
    const double c = glm::dot(j1, covariance * j1) + options_.dilation_px2, det = a * c - b * b;
    s.ka = c / det, s.kb = -b / det, s.kc = a / det;
    s.mean = project(n, s.t);
    s.opacity = at(v, L::kOpacity, i);
    s.normal = -glm::normalize(s.inverse_covariance * s.t);
    const auto basis = basisInDouble(glm::normalize(mu - centerOf(camera_)));
    for (int ch = 0; ch < 3; ++ch) {
      double value = 0.5;
      for (int k = 0; k < shCount(options_.sh_degree); ++k) value += basis[k] * at(v, L::kSh + 3 * k + ch, i);
      s.color[ch] = std::max(0.0, value);
    }
    return s;
  }

  static std::array<double, 16> basisInDouble(dvec3 d) {
    const double x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z;
    return {0.28209479177387814,
            -0.4886025119029199 * y,
            0.4886025119029199 * z,
            -0.4886025119029199 * x,
            1.0925484305920792 * x * y,
            -1.0925484305920792 * y * z,
            0.31539156525252005 * (2 * zz - xx - yy),
            -1.0925484305920792 * x * z,
            0.5462742152960396 * (xx - yy),
            -0.5900435899266435 * y * (3 * xx - yy),
            2.890611442640554 * x * y * z,
            -0.4570457994644658 * y * (4 * zz - xx - yy),
            0.3731763325901154 * z * (2 * zz - 3 * xx - 3 * yy),
            -0.4570457994644658 * x * (4 * zz - xx - yy),
            1.445305721320277 * z * (xx - yy),
            -0.5900435899266435 * x * (xx - 3 * yy)};
  }

  ReferencePixel pixel(const std::vector<Splat>& splats, const std::vector<double>& values, dvec2 p) const {
    ReferencePixel out;
    out.extra.assign(extra_, 0.0);
    const dvec3 ray = rayOf(camera_.intrinsics, p);
    double transmittance = 1, depth = 0;
    for (const Splat& s : splats) {
      if (!s.drawn) continue;
      const dvec2 d = p - s.mean;
      const double power = -0.5 * (s.ka * d.x * d.x + s.kc * d.y * d.y) - s.kb * d.x * d.y;
      const double alpha = std::min(0.99, s.opacity * std::exp(std::min(power, 0.0)));
      if (alpha < options_.min_alpha) continue;
      const double after = transmittance * (1 - alpha);
      if (after < options_.min_transmittance) break;
      const double w = alpha * transmittance;
      const double ratio =
          glm::dot(ray, s.inverse_covariance * s.t) / glm::dot(ray, s.inverse_covariance * ray) / s.t.z;
      const double z = s.t.z * std::clamp(ratio, 0.5, 2.0);
      out.color += w * s.color;
      out.normal += w * s.normal;
      depth += w * z;
      if (transmittance > 0.5 && after <= 0.5) out.median = z;
      for (int e = 0; e < extra_; ++e) out.extra[e] += w * at(values, L::kExtra + e, s.index);
      transmittance = after;
    }
    out.alpha = 1 - transmittance;
    out.depth = out.alpha > 1e-6 ? depth / out.alpha : 0;
    out.color += transmittance * options_.background;
    return out;
  }

  std::size_t count_;
  int extra_;
  Camera camera_;
  ReferenceOptions options_;
};

}  // namespace beam::testing
