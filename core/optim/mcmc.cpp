// SPDX-License-Identifier: Apache-2.0
#include "core/optim/mcmc.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/rng.h"

namespace beam {
namespace {

constexpr float kDeadOpacity = 0.005f;

// `count` draws with probability proportional to `weight`.
std::vector<std::uint32_t> draw(const std::vector<float>& weight, std::size_t count,
                                const RandomStream& random) {
  std::vector<double> cdf(weight.size());
  double sum = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) cdf[i] = sum += weight[i];
  std::vector<std::uint32_t> chosen;
  if (sum <= 0) return chosen;
  chosen.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double u = static_cast<double>(random.bits(i) >> 11) * 0x1p-53 * sum;
    const auto at = std::upper_bound(cdf.begin(), cdf.end(), u) - cdf.begin();
    chosen.push_back(static_cast<std::uint32_t>(std::min<std::ptrdiff_t>(at, std::ssize(cdf) - 1)));
  }
  return chosen;
}

std::vector<float> opacities(const GaussianModel& model) {
  std::vector<float> o(model.size());
  for (std::size_t i = 0; i < o.size(); ++i) o[i] = model.opacity(i);
  return o;
}

}  // namespace

std::size_t relocateDead(GaussianModel& model, std::uint64_t seed, int step) {
  std::vector<float> weight = opacities(model);
  std::vector<std::uint32_t> dead;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    if (weight[i] > kDeadOpacity) continue;
    dead.push_back(static_cast<std::uint32_t>(i));
    weight[i] = 0;
  }
  const std::vector<std::uint32_t> source = draw(weight, dead.size(), RandomStream(seed, step, 0xdeadu));
  if (!source.empty()) model.relocate(source, dead, model.size());
  return source.size();
}

std::size_t grow(GaussianModel& model, double factor, std::size_t cap, std::uint64_t seed, int step) {
  const std::size_t old_size = model.size();
  const auto new_size =
      std::min(cap, static_cast<std::size_t>(std::ceil(static_cast<double>(old_size) * factor)));
  if (new_size <= old_size) return 0;
  const std::vector<std::uint32_t> source =
      draw(opacities(model), new_size - old_size, RandomStream(seed, step, 0x96f0u));
  std::vector<std::uint32_t> target(source.size());
  for (std::size_t i = 0; i < target.size(); ++i) target[i] = static_cast<std::uint32_t>(old_size + i);
  if (!source.empty()) model.relocate(source, target, new_size);
  return source.size();
}

}  // namespace beam
