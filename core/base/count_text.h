// SPDX-License-Identifier: Apache-2.0
// A number with its noun, as a person says it: the one place that knows of one and many.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace beam {

// "1 frame", "2 frames", "1,200 frames". `many`: where an s at the end of `one` will not do; a verb may come
// along: countText(n, "frame was", "frames were").
std::string countText(std::int64_t n, std::string_view one, std::string_view many = {});
// The noun alone, before names: nounText(names.size(), "frame").
std::string nounText(std::int64_t n, std::string_view one, std::string_view many = {});

// For counts of containers.
template <class Integer>
requires(!std::is_same_v<Integer, std::int64_t> && std::is_integral_v<Integer>) std::string
    countText(Integer n, std::string_view one, std::string_view many = {}) {
  return countText(static_cast<std::int64_t>(n), one, many);
}
template <class Integer>
requires(!std::is_same_v<Integer, std::int64_t> && std::is_integral_v<Integer>) std::string
    nounText(Integer n, std::string_view one, std::string_view many = {}) {
  return nounText(static_cast<std::int64_t>(n), one, many);
}

}  // namespace beam
