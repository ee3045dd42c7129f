// SPDX-License-Identifier: Apache-2.0
#include "core/optim/gaussian_model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/rng.h"

namespace beam {
namespace {

using L = PlaneLayout;
constexpr std::size_t kGrain = 4096;
constexpr float kMinOpacity = 1e-6f;
constexpr float kMaxUnbakedOpacity = 0.995f;

float sigmoid(float x) { return 1 / (1 + std::exp(-x)); }
float logit(float p) { return std::log(p / (1 - p)); }

GaussianBuffers resized(const GaussianBuffers& in, std::size_t count) {
  GaussianBuffers out(count, in.extra_channels);
  const std::size_t common = std::min(in.count, count);
  for (int p = 0; p < in.planes(); ++p) std::copy_n(in.plane(p), common, out.plane(p));
  return out;
}

}  // namespace

GaussianModel::GaussianModel(const GaussianCloud& cloud)
    : values_(toBuffers(cloud)),
      raw_(values_.stride * 4, 0.0f),
      filter_(values_.stride, 0.0f),
      first_moment_(cloud.size()),
      second_moment_(cloud.size()) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int k = 0; k < 3; ++k) raw(k)[i] = std::log(std::max(cloud.scale_m[i][k], 1e-6f));
    raw(3)[i] = logit(std::clamp(cloud.opacity[i], kMinOpacity, 1 - kMinOpacity));
  }
}

void GaussianModel::activate() {
  parallelFor(size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float f2 = filter_[i] * filter_[i];
      float keep = 1;
      for (int k = 0; k < 3; ++k) {
        const float s = std::exp(raw(k)[i]), used = std::sqrt(s * s + f2);
        values_.plane(L::kScale + k)[i] = used;
        keep *= s / used;
      }
      values_.plane(L::kOpacity)[i] = sigmoid(raw(3)[i]) * keep;
    }
  });
}

void GaussianModel::updateFilter(std::span<const Camera> cameras, float strength) {
  if (strength <= 0) {
    std::fill(filter_.begin(), filter_.end(), 0.0f);
    return;
  }
  const float* position[3] = {values_.plane(0), values_.plane(1), values_.plane(2)};
  std::vector<dmat3> rotations;
  for (const Camera& c : cameras) rotations.push_back(glm::mat3_cast(c.camera_from_world.rotation));
  parallelFor(size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const dvec3 x(position[0][i], position[1][i], position[2][i]);
      double smallest = 0;
      for (std::size_t v = 0; v < cameras.size(); ++v) {
        const Camera& c = cameras[v];
        const dvec3 t = rotations[v] * x + c.camera_from_world.translation_m;
        if (t.z <= 0.2) continue;
        const dvec2 p = project(c.intrinsics, t);
        if (p.x < -0.15 * c.width || p.x > 1.15 * c.width || p.y < -0.15 * c.height || p.y > 1.15 * c.height)
          continue;
        const double size = t.z / std::max(c.intrinsics.fx, c.intrinsics.fy);
        if (smallest == 0 || size < smallest) smallest = size;
      }
      filter_[i] = strength * static_cast<float>(std::sqrt(0.2) * smallest);
    }
  });
  const float largest =
      *std::max_element(filter_.begin(), filter_.begin() + static_cast<std::ptrdiff_t>(size()));
  for (std::size_t i = 0; i < size(); ++i) {
    if (filter_[i] == 0) filter_[i] = largest;
  }
}

void GaussianModel::takeFilterOut(std::span<const Camera> cameras, float strength) {
  updateFilter(cameras, strength);
  for (std::size_t i = 0; i < size(); ++i) {
    const float f = filter_[i];
    float keep = 1;
    for (int k = 0; k < 3; ++k) {
      const float used = std::exp(raw(k)[i]);
      const float s = std::sqrt(std::max(used * used - f * f, 0.01f * used * used));
      raw(k)[i] = std::log(s);
      keep *= s / std::sqrt(s * s + f * f);
    }
    raw(3)[i] = logit(std::clamp(sigmoid(raw(3)[i]) / keep, kMinOpacity, kMaxUnbakedOpacity));
  }
}

void GaussianModel::addShapeGradient(GaussianBuffers& gradients, const Regularizers& regularizers) const {
  if (regularizers.isotropy == 0 && regularizers.size == 0) return;
  const double sum = parallelReduce(
      size(), kGrain, 0.0,
      [&](std::size_t begin, std::size_t end) {
        double part = 0;
        for (int k = 0; k < 3; ++k) {
          for (std::size_t i = begin; i < end; ++i) part += std::exp(raw(k)[i]);
        }
        return part;
      },
      [](double a, double b) { return a + b; });
  const auto mean = static_cast<float>(sum / (3.0 * static_cast<double>(size())));
  const float per_ratio = regularizers.isotropy / static_cast<float>(size());
  parallelFor(size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      int high = 0, low = 0;
      for (int k = 1; k < 3; ++k) {
        if (raw(k)[i] > raw(high)[i]) high = k;
        if (raw(k)[i] < raw(low)[i]) low = k;
      }
      const float largest = std::exp(raw(high)[i]), ratio = largest / std::exp(raw(low)[i]);
      float& d_high = gradients.plane(L::kScale + high)[i];
      if (ratio > 4) {
        d_high += per_ratio * ratio;
        gradients.plane(L::kScale + low)[i] -= per_ratio * ratio;
      }
      if (largest > 5 * mean) d_high += regularizers.size * largest;
      if (largest < 0.2f * mean) d_high -= regularizers.size * largest;
    }
  });
}

void GaussianModel::keepReference() {
  reference_.assign(values_.plane(L::kScale), values_.plane(L::kExtra - 1) + values_.stride);
  std::copy_n(raw_.data(), raw_.size(), reference_.data());
}

double GaussianModel::temporalEnergy(float shape_share) const {
  double energy = 0;
  for (int p = L::kScale; p < L::kExtra; ++p) {
    const bool shape = p <= L::kOpacity;
    const float* now = shape ? raw(p - L::kScale) : values_.plane(p);
    const float* then = reference_.data() + values_.stride * (p - L::kScale);
    double sum = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const double change = static_cast<double>(now[i]) - then[i];
      sum += change * change;
    }
    energy += shape ? shape_share * sum : sum;
  }
  return energy;
}

void GaussianModel::takeAppearance(const GaussianModel& other) {
  raw_ = other.raw_;
  std::copy_n(other.values_.plane(L::kSh), values_.stride * (L::kExtra - L::kSh), values_.plane(L::kSh));
}

void GaussianModel::place(const Pose& pose) { setPose(values_, pose); }

void GaussianModel::addTemporalGradient(GaussianBuffers& gradients, const Regularizers& regularizers) const {
  if (regularizers.temporal == 0 || reference_.empty()) return;
  parallelFor(size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (int p = L::kScale; p < L::kExtra; ++p) {
      const bool shape = p <= L::kOpacity;
      const float weight = 2 * regularizers.temporal * (shape ? regularizers.temporal_shape : 1);
      const float* now = shape ? raw(p - L::kScale) : values_.plane(p);
      const float* then = reference_.data() + values_.stride * (p - L::kScale);
      float* gradient = gradients.plane(p);
      for (std::size_t i = begin; i < end; ++i) gradient[i] += weight * (now[i] - then[i]);
    }
  });
}

void GaussianModel::step(GaussianBuffers& gradients, const LearningRates& rates, int sh_degree,
                         const Regularizers& regularizers, int step, TrainingOps& ops) {
  const float per_opacity = regularizers.opacity / static_cast<float>(size());
  const float per_scale = regularizers.scale / static_cast<float>(3 * size());
  parallelFor(size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      // With s = exp(raw), u = s^2 + f^2: d sqrt(u) / d raw = s^2 / sqrt(u), d log keep / d raw = f^2 / u.
      const float o = sigmoid(raw(3)[i]), o_used = values_.plane(L::kOpacity)[i];
      float& d_opacity = gradients.plane(L::kOpacity)[i];
      for (int k = 0; k < 3; ++k) {
        const float s = std::exp(raw(k)[i]), used = values_.plane(L::kScale + k)[i];
        float& d_scale = gradients.plane(L::kScale + k)[i];
        const float share = s * s / (used * used);
        d_scale = d_scale * used * share + d_opacity * o_used * (1 - share) + per_scale * s;
      }
      const float keep = o > 0 ? o_used / o : 0;
      d_opacity = (d_opacity * keep + per_opacity) * o * (1 - o);
    }
  });
  addShapeGradient(gradients, regularizers);
  addTemporalGradient(gradients, regularizers);
  std::array<AdamPlane, L::kExtra> planes{};
  for (int p = 0; p < L::kExtra; ++p) {
    planes[p].learning_rate = p < L::kRotation                      ? rates.position_m
                              : p < L::kScale                       ? rates.rotation
                              : p < L::kOpacity                     ? rates.log_scale
                              : p == L::kOpacity                    ? rates.opacity_logit
                              : p < L::kSh + 3                      ? rates.color_dc
                              : p < L::kSh + 3 * shCount(sh_degree) ? rates.color_rest
                                                                    : 0.0f;
  }
  // Adam works on the parameters: the raw planes take the place of the physical ones for its sweep.
  std::copy_n(raw_.data(), raw_.size(), values_.plane(L::kScale));
  ops.adam(values_, gradients, first_moment_, second_moment_, planes, AdamSettings{}, step);
  std::copy_n(values_.plane(L::kScale), raw_.size(), raw_.data());
}

float GaussianModel::opacity(std::size_t i) const { return sigmoid(raw(3)[i]); }

void GaussianModel::resize(std::size_t count) {
  const std::size_t old_stride = values_.stride, common = std::min(count, size());
  values_ = resized(values_, count);
  first_moment_ = resized(first_moment_, count);
  second_moment_ = resized(second_moment_, count);
  AlignedVector<float> raw_planes(values_.stride * 4, 0.0f);
  for (int k = 0; k < 4; ++k) {
    std::copy_n(raw_.data() + old_stride * k, common, raw_planes.data() + values_.stride * k);
  }
  raw_ = std::move(raw_planes);
  filter_.resize(values_.stride, 0.0f);
}

void GaussianModel::relocate(std::span<const std::uint32_t> source, std::span<const std::uint32_t> target,
                             std::size_t new_size) {
  if (new_size != size()) resize(new_size);
  std::vector<std::uint16_t> copies(size(), 1);
  for (const std::uint32_t s : source) copies[s] = static_cast<std::uint16_t>(std::min(51, copies[s] + 1));
  const auto clearMoments = [&](std::size_t i) {
    for (int p = 0; p < L::kExtra; ++p) first_moment_.plane(p)[i] = second_moment_.plane(p)[i] = 0;
  };
  for (std::size_t i = 0; i < size(); ++i) {
    if (copies[i] == 1) continue;
    const Relocation r = relocation(sigmoid(raw(3)[i]), copies[i]);
    for (int k = 0; k < 3; ++k) raw(k)[i] += std::log(r.scale);
    raw(3)[i] = logit(std::clamp(r.opacity, 0.005f, 1 - kMinOpacity));
    clearMoments(i);
  }
  for (std::size_t t = 0; t < target.size(); ++t) {
    for (int p = 0; p < L::kExtra; ++p) values_.plane(p)[target[t]] = values_.plane(p)[source[t]];
    for (int k = 0; k < 4; ++k) raw(k)[target[t]] = raw(k)[source[t]];
    filter_[target[t]] = filter_[source[t]];
    clearMoments(target[t]);
  }
}

void GaussianModel::addNoise(float amount, std::uint64_t seed, int step) {
  const RandomStream random(seed, step, 0x90155eu);
  parallelFor(size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float gate = sigmoid(-100 * (sigmoid(raw(3)[i]) - 0.005f));
      if (gate < 1e-6f) continue;
      const quat q =
          glm::normalize(quat(values_.plane(L::kRotation)[i], values_.plane(L::kRotation + 1)[i],
                              values_.plane(L::kRotation + 2)[i], values_.plane(L::kRotation + 3)[i]));
      vec3 eta;
      for (int k = 0; k < 3; ++k) eta[k] = random.normal(i * 3 + k);
      vec3 local = glm::conjugate(q) * eta;
      for (int k = 0; k < 3; ++k) local[k] *= std::exp(2 * raw(k)[i]);
      const vec3 move = (amount * gate) * (q * local);
      for (int k = 0; k < 3; ++k) values_.plane(L::kPosition + k)[i] += move[k];
    }
  });
}

void GaussianModel::keep(std::span<const std::uint8_t> flags) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (!flags[i]) continue;
    for (int p = 0; p < L::kExtra; ++p) {
      values_.plane(p)[kept] = values_.plane(p)[i];
      first_moment_.plane(p)[kept] = first_moment_.plane(p)[i];
      second_moment_.plane(p)[kept] = second_moment_.plane(p)[i];
    }
    for (int k = 0; k < 4; ++k) raw(k)[kept] = raw(k)[i];
    filter_[kept++] = filter_[i];
  }
  resize(kept);
}

GaussianCloud GaussianModel::cloud() const {
  GaussianModel copy = *this;
  copy.activate();
  GaussianCloud c = toCloud(copy.values_);
  for (std::size_t i = 0; i < c.size(); ++i)
    c.opacity[i] = std::clamp(c.opacity[i], kMinOpacity, 1 - kMinOpacity);
  return c;
}

Relocation relocation(float opacity, int copies) {
  const double o = opacity, o_new = 1 - std::pow(1 - o, 1.0 / copies);
  double sum = 0;
  for (int i = 1; i <= copies; ++i) {
    double binomial = 1;  // C(i - 1, k)
    double power = o_new;
    for (int k = 0; k < i; ++k) {
      sum += (k % 2 ? -1 : 1) * binomial * power / std::sqrt(k + 1.0);
      binomial = binomial * (i - 1 - k) / (k + 1);
      power *= o_new;
    }
  }
  return {static_cast<float>(o_new), sum > 1e-12 ? static_cast<float>(o / sum) : 1.0f};
}

}  // namespace beam
