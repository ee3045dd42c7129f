// SPDX-License-Identifier: Apache-2.0
// Visibility through a tree of our own, the tracer of the CPU device: 16 children a node, each with a box and
// a slab along the mean thin axis of its Gaussians, leaves of up to 32 Gaussians tested 16 at a time.
// Occludes exactly the rays that the Embree tracer occludes, about 6 times as fast.
#pragma once

#include <memory>
#include <span>

#include "core/render/aligned.h"
#include "core/render/cpu/ray_splats.h"

namespace beam {

struct SplatBvh;

std::unique_ptr<Tracer> makeSplatBvhTracer(const TracerDesc& desc, const GaussianCloud& cloud);
// Takes over `last`, the tree of an earlier cloud (may be null), where it still serves, else builds; `last`
// becomes the tree in use. What is occluded does not depend on it.
std::unique_ptr<Tracer> makeFollowingTracer(const TracerDesc& desc, const GaussianCloud& cloud,
                                            std::shared_ptr<const SplatBvh>& last);

// 16 Gaussians, structure of arrays; unused lanes are never met.
struct alignas(64) SplatBlock {
  float canonical[9][16], center[3][16];
  float opacity[16], cut2[16];
};

// Children of a node. Unused ones have an empty box and child 0.
struct alignas(64) SplatNode {
  float bound[6][16];  // low x y z, high x y z
  float axis[3][16], axis_low[16], axis_high[16];
  std::int32_t child[16];  // >= 0: a node; else ~child = 2 * first block + (blocks - 1)
};

inline constexpr int kMaxTreeDepth = 64;

inline constexpr std::uint32_t kNoSplat = ~0u;

struct SplatBvh {
  AlignedVector<SplatNode> nodes;  // the first one is the root; none: no Gaussians
  AlignedVector<SplatBlock> blocks;
  std::vector<std::uint32_t> splat;  // of every lane of every block; kNoSplat: unused
  std::size_t splats = 0;
  float built_cost = 0;  // what costOf() was when it was built
};

SplatBvh buildSplatBvh(const std::vector<RaySplat>& splats);

// Lays the tree around `splats`, of which there are as many as when it was built; each keeps its place.
void refitSplatBvh(SplatBvh& tree, const std::vector<RaySplat>& splats);

// Surface areas of all children, in root areas: how many of them a ray through the root meets.
float costOf(const SplatBvh& tree);

struct RayRules {
  std::uint64_t free_units;  // a ray is blocked above; UINT64_MAX: never
  bool ignore_containing;
};

// SIMD steps (one instruction set chosen at run time; all give the same bits).
void traceBlocked(const SplatBvh& tree, const RayRules& rules, std::span<const Ray> rays,
                  std::uint8_t* blocked);
// `met`: indices in the cloud of the Gaussians that the tree was built of.
struct BlendedRays {
  const SplatBvh& tree;
  std::span<const std::uint32_t> met;
  bool ignore_containing;
  BlendRules rules;
};
std::uint64_t traceAbsorbance(const BlendedRays& rays, const Ray& ray);
std::optional<SplatHit> traceDrawn(const BlendedRays& rays, const Ray& ray, std::uint64_t draw);
std::uint64_t traceSum(const SplatBvh& tree, const RayRules& rules, const Ray& ray);

}  // namespace beam
