// SPDX-License-Identifier: Apache-2.0
// Rays through the tree of splat_bvh.h: 16 children or 16 Gaussians at a time.
#define BEAM_KERNELS_SIMD
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/render/cpu/splat_bvh_simd.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include <bit>
#include <cmath>

#include "core/render/cpu/splat_bvh.h"
#include "core/render/kernels/response.h"

HWY_BEFORE_NAMESPACE();
namespace beam {
namespace HWY_NAMESPACE {

constexpr int kStackSize = 15 * kMaxTreeDepth + 16;

// A ray as the boxes need it: t of a plane = plane * inverse + offset.
struct RaySlopes {
  float inverse[3], offset[3];
  int near[3], far[3];  // rows of SplatNode::bound

  explicit RaySlopes(const Ray& ray) {
    for (int k = 0; k < 3; ++k) {
      // Keeps the reciprocal finite: no infinity minus infinity below.
      const float d =
          std::abs(ray.direction[k]) < 1e-18f ? std::copysign(1e-18f, ray.direction[k]) : ray.direction[k];
      inverse[k] = 1 / d;
      offset[k] = -ray.origin[k] * inverse[k];
      near[k] = d < 0 ? 3 + k : k;
      far[k] = d < 0 ? k : 3 + k;
    }
  }
};

// Bit i: child i may hold Gaussians that the ray meets, from `enter` on.
HWY_INLINE unsigned reachedChildren(const SplatNode& node, const RaySlopes& r, const RayLine<Lanes>& line,
                                    Lanes& enter) {
  const auto at = [&](const int* side, int k) HWY_ATTR {
    return fma(load(node.bound[side[k]]), Lanes(r.inverse[k]), Lanes(r.offset[k]));
  };
  enter = max(max(at(r.near, 0), at(r.near, 1)), max(at(r.near, 2), Lanes(0.0f)));
  Lanes leave = min(min(at(r.far, 0), at(r.far, 1)), at(r.far, 2));
  const Vec3<Lanes> axis = {load(node.axis[0]), load(node.axis[1]), load(node.axis[2])};
  const Lanes slope = dot(axis, line.direction), height = dot(axis, line.origin), least(1e-18f);
  const Lanes inverse = Lanes(1.0f) / select(abs(slope) < least, least, slope);
  const Lanes a = (load(node.axis_low) - height) * inverse, b = (load(node.axis_high) - height) * inverse;
  enter = max(enter, min(a, b));
  leave = min(leave, max(a, b));
  return bitsOf(enter <= leave);
}

HWY_INLINE RayTarget<Lanes> targetsOf(const SplatBlock& b) {
  RayTarget<Lanes> t;
  for (int k = 0; k < 3; ++k)
    t.canonical.r[k] = {load(b.canonical[3 * k]), load(b.canonical[3 * k + 1]), load(b.canonical[3 * k + 2])};
  t.center = {load(b.center[0]), load(b.center[1]), load(b.center[2])};
  t.opacity = load(b.opacity);
  t.cut2 = load(b.cut2);
  return t;
}

// Sum of the block's alphas, whole units: exact, at most 2^24.
HWY_INLINE float blockUnits(const SplatBlock& block, const RayLine<Lanes>& line, bool ignore_containing) {
  const RayTarget<Lanes> targets = targetsOf(block);
  const Encounter<Lanes> e = encounter(targets, line);
  Mask met = meets(targets, e) & isAhead(e);
  if (!any(met)) return 0;
  if (ignore_containing) met = met & !holdsOrigin(targets, line);
  const Lanes zero(0.0f);
  float sum[4];
  sum4(keepIf(met, alphaUnits(targets, e)), zero, zero, zero, sum);
  return sum[0];
}

std::uint64_t sumAlong(const SplatBvh& tree, const RayRules& rules, const Ray& ray) {
  if (tree.nodes.empty()) return 0;
  const RaySlopes slopes(ray);
  const RayLine<Lanes> line = {{Lanes(ray.origin.x), Lanes(ray.origin.y), Lanes(ray.origin.z)},
                               {Lanes(ray.direction.x), Lanes(ray.direction.y), Lanes(ray.direction.z)}};
  std::int32_t stack[kStackSize];
  int size = 0;
  stack[size++] = 0;
  std::uint64_t sum = 0;
  while (size > 0) {
    const std::int32_t at = stack[--size];
    if (at >= 0) {
      const SplatNode& node = tree.nodes[static_cast<std::size_t>(at)];
      Lanes enter;
      for (unsigned bits = reachedChildren(node, slopes, line, enter); bits != 0; bits &= bits - 1)
        stack[size++] = node.child[std::countr_zero(bits)];
      continue;
    }
    const std::size_t first = static_cast<std::size_t>(~at) / 2,
                      last = first + static_cast<std::size_t>(~at) % 2;
    for (std::size_t b = first; b <= last; ++b)
      sum += static_cast<std::uint64_t>(blockUnits(tree.blocks[b], line, rules.ignore_containing));
    if (sum > rules.free_units) return sum;
  }
  return sum;
}

void blockedRays(const SplatBvh& tree, const RayRules& rules, std::span<const Ray> rays,
                 std::uint8_t* blocked) {
  for (std::size_t i = 0; i < rays.size(); ++i)
    blocked[i] = sumAlong(tree, rules, rays[i]) > rules.free_units;
}

// A node or leaf that is still to be looked at.
struct Waiting {
  float enter;
  std::int32_t at;
};

// on_hit(index among the tree's Gaussians, alpha units, ray parameter) of everything ahead and nearer than
// `reach`, which it may lower: near nodes come first, so that little behind it is looked at.
template <class OnHit>
HWY_INLINE void forHits(const SplatBvh& tree, bool ignore_containing, const Ray& ray, float& reach,
                        OnHit&& on_hit) {
  if (tree.nodes.empty()) return;
  const RaySlopes slopes(ray);
  const RayLine<Lanes> line = {{Lanes(ray.origin.x), Lanes(ray.origin.y), Lanes(ray.origin.z)},
                               {Lanes(ray.direction.x), Lanes(ray.direction.y), Lanes(ray.direction.z)}};
  Waiting stack[kStackSize];
  int size = 0;
  stack[size++] = {0, 0};
  alignas(64) float enters[16], units[16], maxima[16];
  while (size > 0) {
    const Waiting next = stack[--size];
    if (!(next.enter < reach)) continue;
    if (next.at >= 0) {
      const SplatNode& node = tree.nodes[static_cast<std::size_t>(next.at)];
      Lanes enter;
      unsigned bits = reachedChildren(node, slopes, line, enter) & bitsOf(enter < Lanes(reach));
      store(enter, enters);
      const int first = size;
      for (; bits != 0; bits &= bits - 1) {
        const int child = std::countr_zero(bits);
        int place = size++;
        for (; place > first && stack[place - 1].enter < enters[child]; --place)
          stack[place] = stack[place - 1];
        stack[place] = {enters[child], node.child[child]};
      }
      continue;
    }
    const std::size_t begin = static_cast<std::size_t>(~next.at) / 2,
                      last = begin + static_cast<std::size_t>(~next.at) % 2;
    for (std::size_t b = begin; b <= last; ++b) {
      const RayTarget<Lanes> targets = targetsOf(tree.blocks[b]);
      const Encounter<Lanes> e = encounter(targets, line);
      Mask met = meets(targets, e) & isAhead(e);
      if (!any(met)) continue;
      const Lanes maximum = maximumAt(e);
      met = met & (maximum < Lanes(reach));
      if (ignore_containing) met = met & !holdsOrigin(targets, line);
      store(alphaUnits(targets, e), units);
      store(maximum, maxima);
      for (unsigned bits = bitsOf(met); bits != 0; bits &= bits - 1) {
        const int lane = std::countr_zero(bits);
        if (maxima[lane] < reach) on_hit(tree.splat[16 * b + lane], units[lane], maxima[lane]);
      }
    }
  }
}

std::uint64_t absorbanceAlong(const BlendedRays& r, const Ray& ray) {
  std::uint64_t sum = 0;
  float reach = r.rules.reach_m;
  forHits(r.tree, r.ignore_containing, ray, reach, [&](std::uint32_t index, float units, float) {
    if (!r.rules.counts(r.met[index], ray.direction)) return;
    sum += absorbanceUnits(units);
    if (sum > kOpaqueUnits) reach = -1;
  });
  return sum;
}

std::optional<SplatHit> drawnAlong(const BlendedRays& r, const Ray& ray, std::uint64_t draw) {
  std::optional<SplatHit> hit;
  float reach = r.rules.reach_m;
  forHits(r.tree, r.ignore_containing, ray, reach, [&](std::uint32_t index, float units, float maximum) {
    const std::uint32_t splat = r.met[index];
    if (!endsIn(splat, units, draw) || !r.rules.counts(splat, ray.direction)) return;
    reach = maximum;
    hit = SplatHit{splat, maximum};
  });
  return hit;
}

}  // namespace HWY_NAMESPACE
}  // namespace beam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beam {

HWY_EXPORT(blockedRays);
HWY_EXPORT(sumAlong);
HWY_EXPORT(absorbanceAlong);
HWY_EXPORT(drawnAlong);

void traceBlocked(const SplatBvh& tree, const RayRules& rules, std::span<const Ray> rays,
                  std::uint8_t* blocked) {
  HWY_DYNAMIC_DISPATCH(blockedRays)(tree, rules, rays, blocked);
}
std::uint64_t traceAbsorbance(const BlendedRays& rays, const Ray& ray) {
  return HWY_DYNAMIC_DISPATCH(absorbanceAlong)(rays, ray);
}
std::optional<SplatHit> traceDrawn(const BlendedRays& rays, const Ray& ray, std::uint64_t draw) {
  return HWY_DYNAMIC_DISPATCH(drawnAlong)(rays, ray, draw);
}
std::uint64_t traceSum(const SplatBvh& tree, const RayRules& rules, const Ray& ray) {
  return HWY_DYNAMIC_DISPATCH(sumAlong)(tree, rules, ray);
}

}  // namespace beam
#endif
