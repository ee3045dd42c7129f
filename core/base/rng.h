// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers: a value is a function of (seed, stream, index), so no order of calls and no
// number of threads changes it. PCG-style output hash over a 64-bit Weyl counter.
#pragma once

#include <cmath>
#include <cstdint>

namespace beam {

// splitmix64 finaliser (Steele et al. 2014): a bijection of 64 bits.
inline std::uint64_t mixBits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

// One stream of numbers. Key it by what the numbers are for: RandomStream(seed, stage, frame, view,
// iteration).
class RandomStream {
 public:
  template <class... Keys>
  explicit RandomStream(std::uint64_t seed, Keys... keys) : state_(mixBits(seed)) {
    ((state_ = mixBits(state_ ^ mixBits(static_cast<std::uint64_t>(keys) + 0x632be59bd9b4e019ull))), ...);
  }
  std::uint64_t bits(std::uint64_t index) const { return mixBits(state_ + index * 0x9e3779b97f4a7c15ull); }
  // Uniform in [0, 1), 24 bits.
  float uniform(std::uint64_t index) const { return static_cast<float>(bits(index) >> 40) * 0x1p-24f; }
  // Uniform integer in [0, count); 0 < count < 2^32.
  std::uint64_t below(std::uint64_t index, std::uint64_t count) const {
    return (bits(index) >> 32) * (count & 0xffffffffull) >> 32;
  }
  // Standard normal (Box-Muller on both halves of one draw).
  float normal(std::uint64_t index) const {
    const std::uint64_t b = bits(index);
    const float u = (static_cast<float>(b >> 40) + 0.5f) * 0x1p-24f;
    const float v = static_cast<float>((b >> 8) & 0xffffff) * 0x1p-24f;
    return std::sqrt(-2.0f * std::log(u)) * std::cos(6.28318530718f * v);
  }

 private:
  std::uint64_t state_;
};

}  // namespace beam
