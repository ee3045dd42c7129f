// SPDX-License-Identifier: Apache-2.0
#include "core/render/cpu/splat_bvh.h"

#include "core/base/parallel.h"

namespace beam {
namespace {

constexpr std::size_t kRayGrain = 1024;

class SplatBvhTracer final : public Tracer {
 public:
  SplatBvhTracer(const TracerDesc& desc, const GaussianCloud& cloud)
      : rules_{freeAlphaUnits(desc), desc.ignore_containing}, tree_(buildSplatBvh(raySplats(desc, cloud))) {}

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const override {
    parallelFor(rays.size(), kRayGrain, [&](std::size_t begin, std::size_t end) {
      traceBlocked(tree_, rules_, rays.subspan(begin, end - begin), blocked.data() + begin);
    });
  }

  std::uint64_t alphaSum(const Ray& ray) const override {
    return traceSum(tree_, {UINT64_MAX, rules_.ignore_containing}, ray);
  }

  std::size_t memoryBytes() const override {
    return tree_.nodes.capacity() * sizeof(SplatNode) + tree_.blocks.capacity() * sizeof(SplatBlock);
  }

 private:
  RayRules rules_;
  SplatBvh tree_;
};

}  // namespace

std::unique_ptr<Tracer> makeSplatBvhTracer(const TracerDesc& desc, const GaussianCloud& cloud) {
  return std::make_unique<SplatBvhTracer>(desc, cloud);
}

}  // namespace beam
