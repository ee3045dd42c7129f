// SPDX-License-Identifier: Apache-2.0
#include "core/method/evaluate.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/image/metrics.h"
#include "core/math/knn.h"
#include "core/scene/frame_views.h"

namespace beam {
namespace {

constexpr std::size_t kScored = 100000;  // points each way
constexpr std::size_t kDense = 400000;   // samples whose triangles are candidates for the exact distance
constexpr int kCandidates = 6;

struct Samples {
  std::vector<vec3> points;
  std::vector<std::uint32_t> triangle;  // empty: the mesh is a cloud
};

// Uniform by area; a mesh without triangles is its vertices.
Samples sampleSurface(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  if (mesh.triangles.empty()) return {mesh.vertices, {}};
  std::vector<double> cdf;
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const dvec3 a(mesh.vertices[t[0]]), b(mesh.vertices[t[1]]), c(mesh.vertices[t[2]]);
    cdf.push_back(sum += 0.5 * glm::length(glm::cross(b - a, c - a)));
  }
  Samples s;
  const RandomStream random(seed, 0xc4a3fe5u);
  for (std::size_t i = 0; i < count; ++i) {
    const double u = static_cast<double>(random.bits(3 * i) >> 11) * 0x1p-53 * sum;
    const auto t =
        std::min<std::size_t>(std::upper_bound(cdf.begin(), cdf.end(), u) - cdf.begin(), cdf.size() - 1);
    float p = random.uniform(3 * i + 1), q = random.uniform(3 * i + 2);
    if (p + q > 1) p = 1 - p, q = 1 - q;
    const auto& v = mesh.triangles[t];
    const vec3 a = mesh.vertices[v[0]];
    s.points.push_back(a + p * (mesh.vertices[v[1]] - a) + q * (mesh.vertices[v[2]] - a));
    s.triangle.push_back(static_cast<std::uint32_t>(t));
  }
  return s;
}

double segmentDistance(dvec3 p, dvec3 a, dvec3 b) {
  const dvec3 d = b - a;
  const double t = std::clamp(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-30), 0.0, 1.0);
  return glm::length(p - a - t * d);
}

double triangleDistance(dvec3 p, dvec3 a, dvec3 b, dvec3 c) {
  const dvec3 ab = b - a, ac = c - a, ap = p - a, n = glm::cross(ab, ac);
  const double nn = std::max(glm::dot(n, n), 1e-30);
  const double v = glm::dot(glm::cross(ap, ac), n) / nn, w = glm::dot(glm::cross(ab, ap), n) / nn;
  if (v >= 0 && w >= 0 && v + w <= 1) return std::abs(glm::dot(ap, n)) / std::sqrt(nn);
  return std::min({segmentDistance(p, a, b), segmentDistance(p, b, c), segmentDistance(p, c, a)});
}

// Of no meaning when a stop is requested.
double meanDistance_m(const std::vector<vec3>& points, const Mesh& mesh, std::uint64_t seed,
                      const Progress& progress) {
  if (progress.stopRequested()) return 0;
  const Samples dense = sampleSurface(mesh, kDense, seed);
  if (progress.stopRequested()) return 0;
  const KdTree tree(dense.points);
  const int k = dense.triangle.empty() ? 1 : kCandidates;
  const double sum = parallelReduce(
      points.size(), 1024, 0.0,
      [&](std::size_t begin, std::size_t end) {
        double part = 0;
        if (progress.stopRequested()) return part;
        for (std::size_t i = begin; i < end; ++i) {
          const std::vector<Neighbor> near = tree.nearest(points[i], k);
          double best = std::sqrt(static_cast<double>(near.front().squared_distance));
          for (const Neighbor& n : near) {
            if (dense.triangle.empty()) break;
            const auto& t = mesh.triangles[dense.triangle[n.index]];
            best = std::min(best, triangleDistance(dvec3(points[i]), dvec3(mesh.vertices[t[0]]),
                                                   dvec3(mesh.vertices[t[1]]), dvec3(mesh.vertices[t[2]])));
          }
          part += best;
        }
        return part;
      },
      [](double a, double b) { return a + b; });
  return sum / static_cast<double>(points.size());
}

}  // namespace

PictureScore scorePicture(const Planes& prediction, const Planes& truth, const Image<std::uint8_t>& mask,
                          const Progress& progress) {
  const PixelRect box = maskBounds(mask);
  PictureScore s;
  s.psnr = psnr(prediction, truth, box);
  s.ssim = ssim(prediction, truth, box, progress);
  double sum = 0;
  std::size_t count = 0;
  for (int c = 0; c < truth.channels; ++c) {
    for (std::size_t i = 0; i < truth.planeSize(); ++i) {
      if (mask.pixels[i] < kInside) continue;
      const double d = static_cast<double>(prediction.plane(c)[i]) - truth.plane(c)[i];
      sum += d * d;
      ++count;
    }
  }
  const double mse = count > 0 ? sum / static_cast<double>(count) : 0;
  s.psnr_mask = mse <= 0 ? 100.0 : std::min(100.0, -10 * std::log10(mse));
  return s;
}

PictureScore meanOf(std::span<const PictureScore> scores) {
  PictureScore mean;
  double sum = 0, with_ssim = 0;
  for (const PictureScore& s : scores) {
    mean.psnr += s.psnr, mean.psnr_mask += s.psnr_mask;
    if (s.ssim) sum += *s.ssim, ++with_ssim;
  }
  const double n = static_cast<double>(std::max<std::size_t>(1, scores.size()));
  mean.psnr /= n, mean.psnr_mask /= n;
  if (with_ssim > 0) mean.ssim = sum / with_ssim;
  return mean;
}

double normalErrorDeg(const Planes& prediction, const Planes& truth, const Image<std::uint8_t>& mask) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < truth.planeSize(); ++i) {
    const dvec3 g(truth.plane(0)[i], truth.plane(1)[i], truth.plane(2)[i]);
    if (mask.pixels[i] < kInside || glm::length(g) <= 0.5) continue;
    const dvec3 p(prediction.plane(0)[i], prediction.plane(1)[i], prediction.plane(2)[i]);
    const double length = glm::length(p);
    const double cosine =
        length < 1e-3 ? 0 : std::clamp(glm::dot(p, g) / std::max(length * glm::length(g), 1e-9), -1.0, 1.0);
    sum += glm::degrees(std::acos(cosine));
    ++count;
  }
  if (count == 0)
    throw Error(Error::Kind::Data, "no pixel has both a mask and a true normal: there is nothing to score");
  return sum / static_cast<double>(count);
}

double depthErrorMm(const Planes& prediction, const Planes& truth, const Image<std::uint8_t>& mask) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < truth.planeSize(); ++i) {
    if (mask.pixels[i] < kInside || truth.values[i] <= 0) continue;
    sum += std::abs(static_cast<double>(prediction.values[i]) - truth.values[i]);
    ++count;
  }
  if (count == 0)
    throw Error(Error::Kind::Data, "no pixel has both a mask and a true depth: there is nothing to score");
  return 1000 * sum / static_cast<double>(count);
}

Chamfer chamferDistance(const Mesh& prediction, const Mesh& truth, const Progress& progress) {
  if (prediction.vertices.empty() || truth.vertices.empty()) {
    throw Error(Error::Kind::Data, "a mesh without vertices has no distance");
  }
  const Samples p = sampleSurface(prediction, kScored, 1), t = sampleSurface(truth, kScored, 2);
  Chamfer c;
  c.prediction_to_truth_mm = 1000 * meanDistance_m(p.points, truth, 3, progress);
  c.truth_to_prediction_mm = 1000 * meanDistance_m(t.points, prediction, 4, progress);
  c.chamfer_mm = (c.prediction_to_truth_mm + c.truth_to_prediction_mm) / 2;
  return c;
}

}  // namespace beam
