// SPDX-License-Identifier: Apache-2.0
// StrongId<Tag>: an index that converts to no other index. Absent is std::optional, never -1.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>

namespace beam {

template <class Tag>
struct StrongId {
  std::int32_t value = 0;
  auto operator<=>(const StrongId&) const = default;
};

}  // namespace beam

template <class Tag>
struct std::hash<beam::StrongId<Tag>> {
  std::size_t operator()(beam::StrongId<Tag> id) const noexcept {
    return std::hash<std::int32_t>()(id.value);
  }
};
