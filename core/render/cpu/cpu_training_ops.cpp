// SPDX-License-Identifier: Apache-2.0
#include "core/render/cpu/cpu_training_ops.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace beam {
namespace {

constexpr int kBandRows = 96;  // 21 rows of overlap against cores that wait
constexpr std::size_t kAdamGrain = 16384;

class CpuTrainingOps final : public TrainingOps {
 public:
  PhotometricLoss photometric(const Planes& image, const Planes& target, float lambda,
                              Planes& gradient) override {
    if (image.width != target.width || image.height != target.height || image.channels != target.channels ||
        image.empty()) {
      throw Error(
          Error::Kind::Bug,
          fmt::format("the loss compares pictures of one size, not {}x{}x{} with {}x{}x{}", image.width,
                      image.height, image.channels, target.width, target.height, target.channels));
    }
    prepare(image, gradient);
    const double values = static_cast<double>(image.planeSize()) * image.channels;
    const auto bands = static_cast<std::size_t>((image.height + kBandRows - 1) / kBandRows);
    parallelFor(bands * static_cast<std::size_t>(image.channels), 1, [&](std::size_t piece, std::size_t) {
      const int c = static_cast<int>(piece / bands), begin = static_cast<int>(piece % bands) * kBandRows;
      SsimChannel channel{.image = image.plane(c),
                          .target = target.plane(c),
                          .gradient = gradient.plane(c),
                          .width = image.width,
                          .height = image.height,
                          .window = {},
                          .l1_scale = static_cast<float>((1 - lambda) / values),
                          .ssim_scale = static_cast<float>(-lambda / values),
                          .row_ssim = &row_ssim_[static_cast<std::size_t>(c) * image.height],
                          .row_l1 = &row_l1_[static_cast<std::size_t>(c) * image.height]};
      std::copy(window_.begin(), window_.end(), channel.window);
      ssimBand(channel, begin, std::min(begin + kBandRows, image.height), &scratch_[piece * piece_floats_]);
    });
    PhotometricLoss loss;
    for (const double v : row_ssim_) loss.ssim += v;
    for (const double v : row_l1_) loss.l1 += v;
    loss.ssim /= values;
    loss.l1 /= values;
    loss.total = (1 - lambda) * loss.l1 + lambda * (1 - loss.ssim);
    return loss;
  }

  void adam(GaussianBuffers& parameters, const GaussianBuffers& gradients, GaussianBuffers& first_moment,
            GaussianBuffers& second_moment, std::span<const AdamPlane> planes, const AdamSettings& settings,
            int step) override {
    if (static_cast<int>(planes.size()) != parameters.planes() ||
        gradients.values.size() != parameters.values.size() ||
        first_moment.values.size() != parameters.values.size() ||
        second_moment.values.size() != parameters.values.size()) {
      throw Error(Error::Kind::Bug, fmt::format("Adam needs four buffers of one size and {} planes, not {}",
                                                parameters.planes(), planes.size()));
    }
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
  // Eleven taps of a Gaussian of standard deviation 1.5, normalised.
  static std::array<float, 6> windowOf() {
    std::array<float, 6> w{};
    double sum = 0;
    for (int i = -5; i <= 5; ++i) sum += std::exp(-i * i / 4.5);
    for (int i = 0; i <= 5; ++i) w[i] = static_cast<float>(std::exp(-i * i / 4.5) / sum);
    return w;
  }

  void prepare(const Planes& image, Planes& gradient) {
    const auto same = [&](const Planes& p) {
      return p.width == image.width && p.height == image.height && p.channels == image.channels;
    };
    if (!same(gradient)) gradient = Planes(image.width, image.height, image.channels);
    if (width_ == image.width && height_ == image.height && channels_ == image.channels) return;
    width_ = image.width, height_ = image.height, channels_ = image.channels;
    const std::size_t bands = (height_ + kBandRows - 1) / kBandRows;
    piece_floats_ = ssimScratchFloats(width_);
    scratch_.assign(bands * channels_ * piece_floats_, 0.0f);
    row_ssim_.assign(static_cast<std::size_t>(height_) * channels_, 0);
    row_l1_.assign(row_ssim_.size(), 0);
  }

  const std::array<float, 6> window_ = windowOf();
  int width_ = 0, height_ = 0, channels_ = 0;
  std::size_t piece_floats_ = 0;
  AlignedVector<float> scratch_;
  std::vector<double> row_ssim_, row_l1_;
};

}  // namespace

std::unique_ptr<TrainingOps> makeCpuTrainingOps() { return std::make_unique<CpuTrainingOps>(); }

}  // namespace beam
