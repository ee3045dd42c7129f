// SPDX-License-Identifier: Apache-2.0
#include "core/render/cpu/cpu_training_ops.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace beam {
namespace {

constexpr std::size_t kRowGrain = 32;
constexpr std::size_t kAdamGrain = 16384;

SsimRows rowsOf(int width) {
  SsimRows s{width, (width + 15) / 16 * 16 + 2 * kSsimPad + 16, {}};
  double sum = 0;
  for (int i = -kSsimReach; i <= kSsimReach; ++i) sum += std::exp(-i * i / 4.5);
  for (int i = 0; i <= kSsimReach; ++i) s.window[i] = static_cast<float>(std::exp(-i * i / 4.5) / sum);
  return s;
}

class CpuTrainingOps final : public TrainingOps {
 public:
  PhotometricLoss photometric(const Planes& image, const Planes& target, float lambda,
                              Planes& gradient) override {
    prepare(image, gradient);
    const double values = static_cast<double>(image.planeSize()) * image.channels;
    const float l1_scale = static_cast<float>((1 - lambda) / values),
                ssim_scale = static_cast<float>(-lambda / values);
    PhotometricLoss loss;
    for (int c = 0; c < image.channels; ++c) {
      channel(image.plane(c), target.plane(c), l1_scale, ssim_scale, gradient.plane(c));
      for (int y = 0; y < image.height; ++y) loss.ssim += row_ssim_[y], loss.l1 += row_l1_[y];
    }
    loss.ssim /= values;
    loss.l1 /= values;
    loss.total = (1 - lambda) * loss.l1 + lambda * (1 - loss.ssim);
    return loss;
  }

  void adam(GaussianBuffers& parameters, const GaussianBuffers& gradients, GaussianBuffers& first_moment,
            GaussianBuffers& second_moment, std::span<const AdamPlane> planes, const AdamSettings& settings,
            int step) override {
    const double correction1 = 1 - std::pow(static_cast<double>(settings.beta1), step);
    const double correction2 = 1 - std::pow(static_cast<double>(settings.beta2), step);
    const std::size_t pieces = (parameters.stride + kAdamGrain - 1) / kAdamGrain;
    parallelFor(planes.size() * pieces, 1, [&](std::size_t piece, std::size_t) {
      const int p = static_cast<int>(piece / pieces);
      if (planes[p].learning_rate == 0) return;
      const std::size_t begin = piece % pieces * kAdamGrain;
      adamStep({.parameter = parameters.plane(p) + begin,
                .first = first_moment.plane(p) + begin,
                .second = second_moment.plane(p) + begin,
                .gradient = gradients.plane(p) + begin,
                .count = std::min(kAdamGrain, parameters.stride - begin),
                .beta1 = settings.beta1,
                .beta2 = settings.beta2,
                .epsilon = settings.epsilon,
                .rate = static_cast<float>(planes[p].learning_rate / correction1),
                .inverse_root = static_cast<float>(1 / std::sqrt(correction2))});
    });
  }

 private:
  void prepare(const Planes& image, Planes& gradient) {
    if (gradient.width != image.width || gradient.height != image.height ||
        gradient.channels != image.channels) {
      gradient = Planes(image.width, image.height, image.channels);
    }
    if (rows_.width == image.width && height_ == image.height) return;
    rows_ = rowsOf(image.width);
    height_ = image.height;
    const std::size_t plane = static_cast<std::size_t>(rows_.stride) * (height_ + 2 * kSsimReach);
    for (auto& p : blurred_) p.assign(plane, 0.0f);
    for (auto& p : maps_) p.assign(plane, 0.0f);
    const std::size_t bands = (static_cast<std::size_t>(height_) + kRowGrain - 1) / kRowGrain;
    scratch_.assign(bands * 5 * rows_.stride, 0.0f);
    row_ssim_.assign(height_, 0);
    row_l1_.assign(height_, 0);
  }

  template <class P>
  auto* rowOf(P& plane, int y) const {
    return plane.data() + static_cast<std::size_t>(y + kSsimReach) * rows_.stride + kSsimPad;
  }

  void channel(const float* image, const float* target, float l1_scale, float ssim_scale, float* gradient) {
    const int w = rows_.width;
    const auto rows = static_cast<std::size_t>(height_);
    const auto scratchOf = [&](std::size_t y) { return &scratch_[y / kRowGrain * 5 * rows_.stride]; };
    parallelFor(rows, kRowGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) {
        float* out[5];
        for (int i = 0; i < 5; ++i) out[i] = rowOf(blurred_[i], static_cast<int>(y));
        ssimBlurProducts(rows_, image + y * w, target + y * w, scratchOf(y), out);
      }
    });
    parallelFor(rows, kRowGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) {
        const float* in[5];
        float* out[3];
        for (int i = 0; i < 5; ++i) in[i] = rowOf(blurred_[i], static_cast<int>(y));
        for (int i = 0; i < 3; ++i) out[i] = rowOf(maps_[i], static_cast<int>(y));
        row_ssim_[y] = ssimRow(rows_, in, scratchOf(y), out);
      }
    });
    parallelFor(rows, kRowGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) {
        const float* in[3];
        for (int i = 0; i < 3; ++i) in[i] = rowOf(maps_[i], static_cast<int>(y));
        row_l1_[y] =
            ssimGradientRow(rows_, in, image + y * w, target + y * w, l1_scale, ssim_scale, gradient + y * w);
      }
    });
  }

  SsimRows rows_{};
  int height_ = 0;
  AlignedVector<float> blurred_[5], maps_[3], scratch_;
  std::vector<double> row_ssim_, row_l1_;
};

}  // namespace

std::unique_ptr<TrainingOps> makeCpuTrainingOps() { return std::make_unique<CpuTrainingOps>(); }

}  // namespace beam
