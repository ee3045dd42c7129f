// SPDX-License-Identifier: Apache-2.0
#include "core/method/fit_linear.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/log.h"
#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/math/knn.h"
#include "core/math/sh.h"
#include "core/render/rasterizer_cache.h"

namespace beam {
namespace {

constexpr std::size_t kViewsTogether = 16;  // whose back-projections are held at a time
constexpr float kSlopeFloor = 0.01f;        // linear; below it the eye's slope would drown the rest
constexpr float kSeen = 0.05f;              // sum of blend weights (pixels) that makes a Gaussian seen
constexpr float kPrior = 1e-4f;             // pull towards the first guess, of what the pictures say
constexpr float kPriorPixels = 0.003f;      // and at least as much as this many pixels would say
constexpr float kLeanPixels = 1;            // a Gaussian seen by less leans on the frame before
constexpr float kTiny = 1e-20f;             // keeps quotients of nothing finite
constexpr int kNeighbors = 4;               // seen Gaussians that lend their colour to an unseen one
constexpr double kConverged = 1e-10;        // of the squared residual
constexpr std::size_t kGrain = 2048;        // Gaussians a piece

// What one view asks for: sum of w_i value_i = target, pixel by pixel, with an importance for each channel.
struct ViewEquations {
  vec3 eye;
  std::vector<std::uint32_t> first, gaussian;  // rows of kept pixels
  std::vector<float> weight;
  std::vector<vec4> target, importance;

  std::size_t rows() const { return target.size(); }
  float alpha(std::size_t row) const {
    float sum = 0;
    for (std::uint32_t k = first[row]; k < first[row + 1]; ++k) sum += weight[k];
    return sum;
  }
  // W values, of one row.
  vec4 blend(std::size_t row, const std::vector<vec4>& values) const {
    vec4 sum(0);
    for (std::uint32_t k = first[row]; k < first[row + 1]; ++k) sum += weight[k] * values[gaussian[k]];
    return sum;
  }
  // Adds W^T value, of one row.
  void spread(std::size_t row, vec4 value, std::vector<vec4>& out) const {
    for (std::uint32_t k = first[row]; k < first[row + 1]; ++k) out[gaussian[k]] += weight[k] * value;
  }
};

// Importance of a pixel and its target, w last. Base colour errors count as they are seen: slope of sRGB
// squared.
std::pair<vec4, vec4> demand(const MaterialMaps& m, std::size_t i, float alpha) {
  const float base = m.base_color_weight.values[i], occlusion = m.ao_weight.values[i];
  vec4 target, importance;
  for (int c = 0; c < 3; ++c) {
    target[c] = m.base_color.plane(c)[i];
    const float slope = srgbSlope(std::max(target[c], kSlopeFloor));
    importance[c] = base * slope * slope;
  }
  target.w = m.ambient_occlusion.values[i];
  importance.w = occlusion;
  return {target * alpha, importance};
}

// Every `stride`-th pixel of a lattice without rows or columns of its own; all of them for stride 1.
bool kept(int x, int y, int stride) { return (x + y * (stride * 5 / 8 | 1)) % stride == 0; }

bool isAskedFor(const MaterialMaps& m, std::size_t i) {
  return m.base_color_weight.values[i] > 0 || m.ao_weight.values[i] > 0;
}

std::size_t pixelsAskedFor(const MapSource& maps, const Progress& progress) {
  std::size_t count = 0;
  for (std::size_t v = 0; v < maps.views; ++v) {
    progress.check();
    const MaterialMaps m = maps.read_weights(v);
    for (std::size_t i = 0; i < m.ao_weight.planeSize(); ++i) count += isAskedFor(m, i);
  }
  return count;
}

ViewEquations equationsOf(const MaterialMaps& m, const BlendWeights& blend, int stride) {
  ViewEquations e;
  e.eye = vec3(centerOf(m.camera));
  e.first.push_back(0);
  for (int y = 0; y < blend.height; ++y) {
    for (int x = 0; x < blend.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * blend.width + x;
      const std::uint32_t begin = blend.first[i], end = blend.first[i + 1];
      if (begin == end || !kept(x, y, stride)) continue;
      if (!isAskedFor(m, i)) continue;
      float alpha = 0;
      for (std::uint32_t k = begin; k < end; ++k) alpha += blend.weight[k];
      const auto [target, importance] = demand(m, i, alpha);
      e.gaussian.insert(e.gaussian.end(), blend.gaussian.begin() + begin, blend.gaussian.begin() + end);
      e.weight.insert(e.weight.end(), blend.weight.begin() + begin, blend.weight.begin() + end);
      e.target.push_back(target);
      e.importance.push_back(importance);
      e.first.push_back(static_cast<std::uint32_t>(e.gaussian.size()));
    }
  }
  return e;
}

// Of a lattice that leaves about `most_entries` in all views, by the pixels of one view.
int strideFor(const ViewEquations& view, std::size_t pixels, std::size_t most_entries) {
  const std::size_t expected = view.gaussian.size() * pixels / view.rows();
  if (expected <= most_entries) return 1;
  const int stride = static_cast<int>(expected / most_entries + 1);
  logInfo("material fit: {} million blend weights are too many, 1 pixel in {} is used", expected / 1'000'000,
          stride);
  return stride;
}

std::vector<ViewEquations> collect(const MapSource& maps, const GaussianCloud& cloud,
                                   std::size_t most_entries, ComputeDevice& device, Progress& progress) {
  const GaussianBuffers buffers = toBuffers(cloud);
  const std::size_t pixels = pixelsAskedFor(maps, progress);
  RasterizerCache rasterizers(device);
  std::vector<ViewEquations> views;
  int stride = 0;  // not known before a view has shown something
  progress.expect(static_cast<std::int64_t>(maps.views), "photographs");
  for (std::size_t v = 0; v < maps.views; ++v) {
    progress.step();
    const MaterialMaps m = maps.read(v);
    Rasterizer& rasterizer = rasterizers.of(
        {.width = m.camera.width, .height = m.camera.height, .color = false, .geometry = true});
    const BlendWeights blend = rasterizer.blendWeights(buffers, m.camera);
    ViewEquations e = equationsOf(m, blend, std::max(1, stride));
    if (stride == 0 && e.rows() > 0) {
      stride = strideFor(e, pixels, most_entries);
      if (stride > 1) e = equationsOf(m, blend, stride);
    }
    views.push_back(std::move(e));
  }
  return views;
}

// The normal equations of all views, never formed: products only.
class NormalEquations {
 public:
  NormalEquations(const MapSource& maps, const GaussianCloud& cloud, float regularization,
                  std::size_t most_entries, ComputeDevice& device, Progress& progress)
      : cloud_(cloud),
        regularization_(regularization),
        views_(collect(maps, cloud, most_entries, device, progress)) {
    // Row sums stand for how much the pictures say about a Gaussian; the diagonal preconditions.
    row_sum_.assign(cloud.size(), vec4(0));
    coverage_.assign(cloud.size(), vec4(0));
    mean_.assign(cloud.size(), vec4(0));
    diagonal_.assign(cloud.size() * kShCount, vec4(0));
    forViews([&](const ViewEquations& v, std::vector<vec4>& out) { squares(v, out); },
             [&](std::size_t i, const std::array<float, kShCount>& b, vec4 s) {
               for (int k = 0; k < kShCount; ++k) diagonal_[i * kShCount + k] += b[k] * b[k] * s;
             });
    progress.check();
    forViews([&](const ViewEquations& v, std::vector<vec4>& out) { project(v, out, Row::Importance); },
             [&](std::size_t i, const std::array<float, kShCount>&, vec4 s) { row_sum_[i] += s; });
    progress.check();
    forViews([&](const ViewEquations& v, std::vector<vec4>& out) { project(v, out, Row::Seen); },
             [&](std::size_t i, const std::array<float, kShCount>&, vec4 s) { coverage_[i] += s; });
    progress.check();
    forViews([&](const ViewEquations& v, std::vector<vec4>& out) { project(v, out, Row::Target); },
             [&](std::size_t i, const std::array<float, kShCount>&, vec4 s) { mean_[i] += s; });
    typical_ = meanImportance();
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
      diagonal_[i] += pull(i);
    }
  }

  // Weighted back-projection (methods 5.10): DC only; Gaussians that no weighted pixel sees borrow from
  // neighbours.
  MaterialCoefficients firstGuess() const {
    MaterialCoefficients x(cloud_.size() * kShCount, vec4(0));
    for (int channel : {0, 3}) {  // base colour's three share their pixels, AO has its own
      std::vector<std::uint32_t> seen;
      std::vector<vec3> positions;
      for (std::size_t i = 0; i < cloud_.size(); ++i) {
        if (coverage_[i][channel] < kSeen) continue;
        seen.push_back(static_cast<std::uint32_t>(i));
        positions.push_back(cloud_.position_m[i]);
      }
      if (seen.empty()) continue;
      const KdTree tree(positions);
      const int last = channel == 0 ? 3 : 4;
      parallelFor(cloud_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          for (int c = channel; c < last; ++c)
            x[i * kShCount][c] = (guess(i, c, channel, tree, seen) - 0.5f) / kShC0;
        }
      });
    }
    return x;
  }

  // The mean of `found` in this frame and `before`, which counts as `memory` frames; more where the pictures
  // say little, and fading where they contradict it by more than `outlier` (a Gaussian that slid onto another
  // cloth).
  void mix(const MaterialCoefficients& before, vec4 memory, float outlier,
           MaterialCoefficients& found) const {
    const std::vector<vec4> apart = contradictions(before);
    parallelFor(cloud_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const vec4 shift = apart[i] / outlier;
        const vec4 doubt = 1.0f + shift * shift;
        const vec4 held = memory / (doubt * doubt);
        const vec4 said = row_sum_[i] / (row_sum_[i] + glm::max(kLeanPixels * typical_, kTiny));
        for (std::size_t k = i * kShCount; k < (i + 1) * kShCount; ++k)
          found[k] += (before[k] - found[k]) * (held / glm::max(held + said, kTiny));
      }
    });
  }

  // B^T W^T D (target - 0.5 alpha - W B x): the right-hand side for a step away from x.
  MaterialCoefficients residual(const MaterialCoefficients& x) const {
    MaterialCoefficients r(x.size(), vec4(0));
    const auto evaluate = [&](std::size_t i, const std::array<float, kShCount>& b) {
      return 0.5f + at(x, i, b);
    };
    forViews([&](const ViewEquations& v, std::vector<vec4>& out) { misfit(v, out, evaluate, true); },
             [&](std::size_t i, const std::array<float, kShCount>& b, vec4 s) {
               for (int k = 0; k < kShCount; ++k) r[i * kShCount + k] += b[k] * s;
             });
    return r;
  }

  // (B^T W^T D W B + pull) p.
  MaterialCoefficients times(const MaterialCoefficients& p) const {
    MaterialCoefficients q(p.size());
    parallelFor(p.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        q[i] = pull(i) * p[i];
      }
    });
    const auto evaluate = [&](std::size_t i, const std::array<float, kShCount>& b) { return at(p, i, b); };
    forViews([&](const ViewEquations& v, std::vector<vec4>& out) { misfit(v, out, evaluate, false); },
             [&](std::size_t i, const std::array<float, kShCount>& b, vec4 s) {
               for (int k = 0; k < kShCount; ++k) q[i * kShCount + k] += b[k] * s;
             });
    return q;
  }

  const std::vector<vec4>& diagonal() const { return diagonal_; }

 private:
  enum class Row { Importance, Seen, Target };

  // Of coefficient i: little-seen Gaussians keep their first guess, view-dependence must pay its way.
  vec4 pull(std::size_t i) const {
    const float share = i % kShCount == 0 ? kPrior : regularization_;
    return share * row_sum_[i / kShCount] + kPriorPixels * typical_;
  }

  // How far off x is in the pixels of each Gaussian, as seen (sRGB-encoded; AO as it is): the worst channel's
  // for all of base colour, so that its hue does not split.
  std::vector<vec4> contradictions(const MaterialCoefficients& x) const {
    std::vector<vec4> apart(cloud_.size(), vec4(0));
    const auto evaluate = [&](std::size_t i, const std::array<float, kShCount>& b) {
      return 0.5f + at(x, i, b);
    };
    forViews([&](const ViewEquations& v, std::vector<vec4>& out) { differences(v, out, evaluate); },
             [&](std::size_t i, const std::array<float, kShCount>&, vec4 s) { apart[i] += s; });
    for (std::size_t i = 0; i < apart.size(); ++i) {
      for (int c = 0; c < 4; ++c) apart[i][c] = row_sum_[i][c] > 0 ? apart[i][c] / row_sum_[i][c] : 0.0f;
      const float worst = std::max({apart[i].x, apart[i].y, apart[i].z});
      apart[i] = {worst, worst, worst, apart[i].w};
    }
    return apart;
  }

  // Mean importance of a pixel that has any.
  vec4 meanImportance() const {
    dvec4 sum(0), count(0);
    for (const ViewEquations& v : views_) {
      for (const vec4& importance : v.importance) {
        sum += dvec4(importance);
        count += dvec4(glm::greaterThan(importance, vec4(0)));
      }
    }
    return vec4(sum / glm::max(count, dvec4(1)));
  }

  static vec4 at(const MaterialCoefficients& x, std::size_t gaussian, const std::array<float, kShCount>& b) {
    vec4 v(0);
    for (int k = 0; k < kShCount; ++k) v += b[k] * x[gaussian * kShCount + k];
    return v;
  }

  std::array<float, kShCount> basis(const ViewEquations& v, std::size_t gaussian) const {
    const vec3 to = cloud_.position_m[gaussian] - v.eye;
    return shBasis(to / std::max(glm::length(to), 1e-6f));
  }

  // view(v, out) adds a vec4 a Gaussian; join(gaussian, basis, vec4) takes it over, views in their order.
  template <class View, class Join>
  void forViews(View&& view, Join&& join) const {
    std::vector<std::vector<vec4>> sums(std::min(kViewsTogether, views_.size()));
    for (std::size_t first = 0; first < views_.size(); first += kViewsTogether) {
      const std::size_t count = std::min(kViewsTogether, views_.size() - first);
      parallelFor(count, 1, [&](std::size_t i, std::size_t) {
        sums[i].assign(cloud_.size(), vec4(0));
        view(views_[first + i], sums[i]);
      });
      parallelFor(cloud_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          for (std::size_t v = 0; v < count; ++v) {
            if (sums[v][i] != vec4(0)) join(i, basis(views_[first + v], i), sums[v][i]);
          }
        }
      });
    }
  }

  static void squares(const ViewEquations& v, std::vector<vec4>& out) {
    for (std::size_t r = 0; r < v.rows(); ++r) {
      for (std::uint32_t k = v.first[r]; k < v.first[r + 1]; ++k) {
        out[v.gaussian[k]] += v.weight[k] * v.weight[k] * v.importance[r];
      }
    }
  }

  static void project(const ViewEquations& v, std::vector<vec4>& out, Row kind) {
    for (std::size_t r = 0; r < v.rows(); ++r) {
      const vec4 importance = v.importance[r];
      vec4 value = importance;
      if (kind == Row::Seen) value = vec4(glm::greaterThan(importance, vec4(0)));
      if (kind == Row::Target) value = importance * v.target[r] / v.alpha(r);
      v.spread(r, value, out);
    }
  }

  // Of the Gaussians that the view sees.
  template <class Evaluate>
  std::vector<vec4> valuesIn(const ViewEquations& v, Evaluate&& evaluate) const {
    std::vector<vec4> values(cloud_.size());
    std::vector<std::uint8_t> known(cloud_.size(), 0);
    for (const std::uint32_t g : v.gaussian) {
      if (known[g]) continue;
      values[g] = evaluate(g, basis(v, g));
      known[g] = 1;
    }
    return values;
  }

  // W^T D |target - W values| / alpha, as seen.
  template <class Evaluate>
  void differences(const ViewEquations& v, std::vector<vec4>& out, Evaluate&& evaluate) const {
    const std::vector<vec4> values = valuesIn(v, evaluate);
    for (std::size_t r = 0; r < v.rows(); ++r) {
      const float alpha = v.alpha(r);
      vec4 apart = glm::abs(v.target[r] - v.blend(r, values)) / alpha;
      for (int c = 0; c < 3; ++c) apart[c] *= srgbSlope(std::max(v.target[r][c] / alpha, kSlopeFloor));
      v.spread(r, apart * v.importance[r], out);
    }
  }

  // W^T D (W values), or W^T D (target - W values).
  template <class Evaluate>
  void misfit(const ViewEquations& v, std::vector<vec4>& out, Evaluate&& evaluate,
              bool against_target) const {
    const std::vector<vec4> values = valuesIn(v, evaluate);
    for (std::size_t r = 0; r < v.rows(); ++r) {
      const vec4 sum = v.blend(r, values);
      v.spread(r, v.importance[r] * (against_target ? v.target[r] - sum : sum), out);
    }
  }

  float guess(std::size_t i, int c, int channel, const KdTree& tree,
              std::span<const std::uint32_t> seen) const {
    if (coverage_[i][channel] >= kSeen) return mean_[i][c] / row_sum_[i][c];
    float sum = 0, count = 0;
    for (const Neighbor& n : tree.nearest(cloud_.position_m[i], kNeighbors)) {
      const std::uint32_t g = seen[n.index];
      sum += mean_[g][c] / row_sum_[g][c];
      count += 1;
    }
    return sum / count;
  }

  const GaussianCloud& cloud_;
  float regularization_;
  std::vector<ViewEquations> views_;
  std::vector<vec4> row_sum_, coverage_, mean_;  // of importance w, of w where seen, of importance w target
  std::vector<vec4> diagonal_;
  vec4 typical_ = vec4(0);
};

dvec4 dot(const std::vector<vec4>& a, const std::vector<vec4>& b) {
  return parallelReduce(
      a.size(), 1 << 14, dvec4(0),
      [&](std::size_t begin, std::size_t end) {
        dvec4 sum(0);
        for (std::size_t i = begin; i < end; ++i) sum += dvec4(a[i]) * dvec4(b[i]);
        return sum;
      },
      [](dvec4 x, dvec4 y) { return x + y; });
}

vec4 quotient(dvec4 a, dvec4 b) {
  vec4 q(0);
  for (int c = 0; c < 4; ++c) q[c] = b[c] > 0 ? static_cast<float>(a[c] / b[c]) : 0.0f;
  return q;
}

template <class Body>
void forAll(std::size_t count, Body&& body) {
  parallelFor(count, 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

// Preconditioned conjugate gradients, four systems abreast, from x in place; r: the right-hand side for a
// step away from x.
void descend(const NormalEquations& a, MaterialCoefficients& x, MaterialCoefficients r, int iterations,
             Progress& progress) {
  progress.expect(iterations, "iterations");
  const std::vector<vec4>& diagonal = a.diagonal();
  MaterialCoefficients z(r.size()), p;
  const auto precondition = [&] {
    forAll(r.size(), [&](std::size_t i) {
      for (int c = 0; c < 4; ++c) z[i][c] = diagonal[i][c] > 0 ? r[i][c] / diagonal[i][c] : 0.0f;
    });
  };
  precondition();
  p = z;
  dvec4 rz = dot(r, z);
  const dvec4 start = rz;
  for (int i = 0; i < iterations; ++i) {
    progress.step();
    if (glm::all(glm::lessThanEqual(rz, kConverged * start))) break;
    const MaterialCoefficients q = a.times(p);
    const vec4 step = quotient(rz, dot(p, q));
    forAll(r.size(), [&](std::size_t j) {
      x[j] += step * p[j];
      r[j] -= step * q[j];
    });
    precondition();
    const dvec4 next = dot(r, z);
    const vec4 carry = quotient(next, rz);
    rz = next;
    forAll(r.size(), [&](std::size_t j) { p[j] = z[j] + carry * p[j]; });
  }
}

}  // namespace

MaterialCoefficients fitLinear(const MapSource& maps, const GaussianCloud& cloud,
                               const MaterialCoefficients* before, const FitMaterialsOptions& options,
                               ComputeDevice& device, Progress& progress, std::size_t most_entries) {
  Progress collecting = progress.part(0.3, "collecting blend weights");
  NormalEquations equations(maps, cloud, static_cast<float>(options.regularization), most_entries, device,
                            collecting);
  // From its own pictures each time: conjugate gradients that stop early are a regularization, which a start
  // from the frame before would undo a little more with every frame (measured: 0.5 dB of new views).
  MaterialCoefficients x = equations.firstGuess();
  Progress solving = progress.part(0.7, "solving for materials");
  descend(equations, x, equations.residual(x), options.linear_iterations, solving);
  if (before) {
    vec4 memory(static_cast<float>(options.later.memory_frames));
    memory.w = static_cast<float>(options.later.occlusion_memory_frames);
    equations.mix(*before, memory, static_cast<float>(options.later.outlier), x);
  }
  return x;
}

}  // namespace beam
