// SPDX-License-Identifier: Apache-2.0
// Blocks of 8 x 8 x 8 voxels, voxel v at voxel_m * v, and their order: layers of rising x, in them rising y,
// then z.
#pragma once

#include <array>
#include <cstdint>

#include "core/math/types.h"

namespace beam {

inline constexpr int kBlock = 8;  // voxels a side
inline constexpr int kBlockVoxels = kBlock * kBlock * kBlock;
inline constexpr int kBlockRange = 1 << 20;  // indices of blocks lie in [-kBlockRange, kBlockRange)

inline std::uint64_t keyOf(ivec3 block) {
  return (static_cast<std::uint64_t>(block.x + kBlockRange) << 42) |
         (static_cast<std::uint64_t>(block.y + kBlockRange) << 21) |
         static_cast<std::uint64_t>(block.z + kBlockRange);
}

inline ivec3 blockOf(std::uint64_t key) {
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  return {static_cast<int>(key >> 42) - kBlockRange, static_cast<int>((key >> 21) & kMask) - kBlockRange,
          static_cast<int>(key & kMask) - kBlockRange};
}

// False for what is no number.
inline bool isInRange(const dvec3& block) {
  return glm::all(glm::lessThan(glm::abs(block), dvec3(kBlockRange - 1)));
}
// Of numbers in that range; without the calls that std::floor is on plain x86-64.
inline ivec3 floorOf(const dvec3& block) {
  const ivec3 towards_zero(block);
  return towards_zero - ivec3(glm::lessThan(block, dvec3(towards_zero)));
}

// Of the voxel in its block, x fastest.
inline ivec3 voxelInBlock(int i) { return {i % kBlock, i / kBlock % kBlock, i / (kBlock * kBlock)}; }
inline int indexInBlock(ivec3 v) { return (v.z * kBlock + v.y) * kBlock + v.x; }

struct TsdfBlock {
  ivec3 index;
  std::array<float, kBlockVoxels> distance = {};  // of the truncation, [-1, 1]; negative: inside
  std::array<float, kBlockVoxels> weight = {};    // 0: nothing is known
};

}  // namespace beam
