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
  SplatBvhTracer(const TracerDesc& desc, std::shared_ptr<const SplatBvh> tree)
      : rules_{freeAlphaUnits(desc), desc.ignore_containing}, tree_(std::move(tree)) {}

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const override {
    parallelFor(rays.size(), kRayGrain, [&](std::size_t begin, std::size_t end) {
      traceBlocked(*tree_, rules_, rays.subspan(begin, end - begin), blocked.data() + begin);
    });
  }

  std::uint64_t alphaSum(const Ray& ray) const override {
    return traceSum(*tree_, {UINT64_MAX, rules_.ignore_containing}, ray);
  }

  std::size_t memoryBytes() const override {
    return tree_->nodes.capacity() * sizeof(SplatNode) + tree_->blocks.capacity() * sizeof(SplatBlock) +
           tree_->splat.capacity() * sizeof(tree_->splat[0]);
  }

 private:
  RayRules rules_;
  std::shared_ptr<const SplatBvh> tree_;
};

}  // namespace

std::unique_ptr<Tracer> makeSplatBvhTracer(const TracerDesc& desc, const GaussianCloud& cloud) {
  return std::make_unique<SplatBvhTracer>(desc, build(raySplats(desc, cloud)));
}

std::unique_ptr<Tracer> makeFollowingTracer(const TracerDesc& desc, const GaussianCloud& cloud,
                                            std::shared_ptr<const SplatBvh>& last) {
  const std::vector<RaySplat> splats = raySplats(desc, cloud);
  std::shared_ptr<const SplatBvh> tree = moved(last.get(), splats);
  last = std::move(tree);
  if (!last) last = build(splats);
  return std::make_unique<SplatBvhTracer>(desc, last);
}

}  // namespace beam
