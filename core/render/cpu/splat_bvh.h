// SPDX-License-Identifier: Apache-2.0
// Visibility through a tree of our own, the tracer of the CPU device: 16 children a node, each with a box and
// a slab along the mean thin axis of its Gaussians, leaves of up to 32 Gaussians tested 16 at a time.
// Occludes exactly the rays that the Embree tracer occludes, several times faster (performance.md 3).
#pragma once

#include <memory>
#include <span>

#include "core/render/aligned.h"
#include "core/render/cpu/ray_splats.h"

namespace beam {

std::unique_ptr<Tracer> makeSplatBvhTracer(const TracerDesc& desc, const GaussianCloud& cloud);

// 16 Gaussians, structure of arrays; unused lanes are never met.
struct alignas(64) SplatBlock {
  float canonical[9][16], center[3][16];
  float opacity[16], cut2[16];
};

// Children of a node. Unused ones have an empty box.
struct alignas(64) SplatNode {
  float bound[6][16];  // low x y z, high x y z
  float axis[3][16], axis_low[16], axis_high[16];
  std::int32_t child[16];  // >= 0: a node; else ~child = 2 * first block + (blocks - 1)
};

inline constexpr int kMaxTreeDepth = 64;

struct SplatBvh {
  AlignedVector<SplatNode> nodes;  // the first one is the root; none: no Gaussians
  AlignedVector<SplatBlock> blocks;
};

SplatBvh buildSplatBvh(const std::vector<RaySplat>& splats);

struct RayRules {
  std::uint64_t free_units;  // a ray is blocked above; UINT64_MAX: never
  bool ignore_containing;
};

// SIMD steps (one instruction set chosen at run time; all give the same bits).
void traceBlocked(const SplatBvh& tree, const RayRules& rules, std::span<const Ray> rays,
                  std::uint8_t* blocked);
std::uint64_t traceSum(const SplatBvh& tree, const RayRules& rules, const Ray& ray);

}  // namespace beam
