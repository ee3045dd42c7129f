// SPDX-License-Identifier: Apache-2.0
#include "core/render/cpu/splat_bvh.h"

#include "core/base/parallel.h"

namespace beam {
namespace {

constexpr std::size_t kRayGrain = 1024;
constexpr float kWornOut = 1.15f;  // times the cost when built: build anew

std::shared_ptr<const SplatBvh> build(const std::vector<RaySplat>& splats) {
  return std::make_shared<const SplatBvh>(buildSplatBvh(splats));
}

// The last tree around these Gaussians; null where it does not serve.
std::shared_ptr<const SplatBvh> moved(const SplatBvh* last, const std::vector<RaySplat>& splats) {
  if (!last || last->splats != splats.size()) return nullptr;
  auto tree = std::make_shared<SplatBvh>(*last);
  refitSplatBvh(*tree, splats);
  return costOf(*tree) <= kWornOut * tree->built_cost ? tree : nullptr;
}

class SplatBvhTracer final : public Tracer {
 public:
  SplatBvhTracer(const TracerDesc& desc, const GaussianCloud& cloud, std::shared_ptr<const SplatBvh> tree)
      : rules_{freeAlphaUnits(desc), desc.ignore_containing},
        tree_(std::move(tree)),
        met_(metSplats(desc, cloud)) {}

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const override {
    parallelFor(rays.size(), kRayGrain, [&](std::size_t begin, std::size_t end) {
      traceBlocked(*tree_, rules_, rays.subspan(begin, end - begin), blocked.data() + begin);
    });
  }

  float transmittance(const Ray& ray, const BlendRules& rules) const override {
    return transmittanceOf(traceAbsorbance(blended(rules), ray));
  }
  std::optional<SplatHit> drawn(const Ray& ray, std::uint64_t draw, const BlendRules& rules) const override {
    return traceDrawn(blended(rules), ray, draw);
  }

  std::uint64_t alphaSum(const Ray& ray) const override {
    return traceSum(*tree_, {UINT64_MAX, rules_.ignore_containing}, ray);
  }

  std::size_t memoryBytes() const override {
    return tree_->nodes.capacity() * sizeof(SplatNode) + tree_->blocks.capacity() * sizeof(SplatBlock) +
           tree_->splat.capacity() * sizeof(tree_->splat[0]) + met_.capacity() * sizeof(met_[0]);
  }

 private:
  BlendedRays blended(const BlendRules& rules) const {
    return {*tree_, met_, rules_.ignore_containing, rules};
  }

  RayRules rules_;
  std::shared_ptr<const SplatBvh> tree_;
  std::vector<std::uint32_t> met_;  // indices in the cloud of the tree's Gaussians
};

}  // namespace

std::unique_ptr<Tracer> makeSplatBvhTracer(const TracerDesc& desc, const GaussianCloud& cloud) {
  return std::make_unique<SplatBvhTracer>(desc, cloud, build(raySplats(desc, cloud)));
}

std::unique_ptr<Tracer> makeFollowingTracer(const TracerDesc& desc, const GaussianCloud& cloud,
                                            std::shared_ptr<const SplatBvh>& last) {
  const std::vector<RaySplat> splats = raySplats(desc, cloud);
  std::shared_ptr<const SplatBvh> tree = moved(last.get(), splats);
  last = std::move(tree);
  if (!last) last = build(splats);
  return std::make_unique<SplatBvhTracer>(desc, cloud, last);
}

}  // namespace beam
