// SPDX-License-Identifier: Apache-2.0
#include "core/render/cpu/cpu_shadow_drawer.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/render/cpu/cpu_resident_scene.h"

namespace beam {
namespace {

constexpr int kBand = 16;           // rows
constexpr std::size_t kGrain = 64;  // packs of 16 Gaussians
constexpr float kReach = 3;         // standard deviations that a Gaussian reaches, at most
constexpr float kFaint = 0.1f;      // opacity of Gaussians that no sphere is drawn around
constexpr float kNothing = std::numeric_limits<float>::infinity();

const CpuResidentScene& ofCpu(const ResidentScene& scene) {
  const auto* mine = dynamic_cast<const CpuResidentScene*>(&scene);
  if (!mine) throw Error(Error::Kind::Bug, "shadow map: the scene is of another device");
  return *mine;
}

class CpuShadowDrawer final : public ShadowDrawer {
 public:
  Sphere boundsOf(const ResidentScene& scene) override {
    const GaussianBuffers& g = ofCpu(scene).gaussians();
    if (g.count == 0) return {};
    const auto at = [&](int plane, std::size_t i) {
      return vec3(g.plane(plane)[i], g.plane(plane + 1)[i], g.plane(plane + 2)[i]);
    };
    // Stray faint ones would make every texel larger; where all are faint, all count.
    const float* opacity = g.plane(PlaneLayout::kOpacity);
    const bool any = std::any_of(opacity, opacity + g.count, [](float o) { return o >= kFaint; });
    const auto counts = [&](std::size_t i) { return !any || opacity[i] >= kFaint; };
    vec3 low(kNothing), high(-kNothing);
    for (std::size_t i = 0; i < g.count; ++i) {
      if (!counts(i)) continue;
      low = glm::min(low, at(PlaneLayout::kPosition, i));
      high = glm::max(high, at(PlaneLayout::kPosition, i));
    }
    Sphere s{.center_m = 0.5f * (low + high)};
    for (std::size_t i = 0; i < g.count; ++i) {
      if (!counts(i)) continue;
      const vec3 scale = at(PlaneLayout::kScale, i);
      s.radius_m = std::max(s.radius_m, glm::length(at(PlaneLayout::kPosition, i) - s.center_m) +
                                            kReach * std::max({scale.x, scale.y, scale.z}));
    }
    return s;
  }

  void draw(const ResidentScene& scene, const ShadowView& view, ShadowTexels& texels) override {
    const CpuResidentScene& mine = ofCpu(scene);
    const GaussianBuffers& g = mine.gaussians();
    const std::array<std::string, 1> names = {kNormalSideName};
    const float* side = scene.has(kNormalSideName) ? mine.seenFrom(vec3(0), names, scratch_)[0] : nullptr;
    splats_.resize(g.stride);
    parallelFor(g.stride / 16, kGrain, [&](std::size_t begin, std::size_t end) {
      castSplats(g, side, view, 16 * begin, std::min(g.count, 16 * end), splats_.data());
    });
    clear(view.size);
    listBands(g.count, view.size);
    parallelFor(bands_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        const int first = static_cast<int>(b) * kBand;
        drawSplatRows(splats_.data(), bands_[b], first, std::min(first + kBand, view.size), planes_);
      }
    });
    resolve(texels);
  }

 private:
  void clear(int size) {
    planes_.size = size;
    planes_.stride = size + 16;  // a row is drawn over 16 texels at a time from anywhere in it
    const std::size_t texels = static_cast<std::size_t>(planes_.stride) * size;
    planes_.nearest.assign(texels, kNothing);
    planes_.through.assign(texels, 1.0f);
    planes_.weight.assign(texels, 0.0f);
    planes_.weighted.assign(texels, 0.0f);
  }

  // In the order of the Gaussians: what is added up in a texel is so in one order.
  void listBands(std::size_t count, int size) {
    bands_.resize(static_cast<std::size_t>((size + kBand - 1) / kBand));
    for (auto& band : bands_) band.clear();
    const auto last = static_cast<float>(size - 1);
    for (std::size_t i = 0; i < count; ++i) {
      const ShadowSplat& s = splats_[i];
      if (s.opacity == 0) continue;
      const auto top = static_cast<std::size_t>(std::max(0.0f, s.y - s.half_height)) / kBand;
      const auto bottom = static_cast<std::size_t>(std::clamp(s.y + s.half_height, 0.0f, last)) / kBand;
      for (std::size_t b = top; b <= bottom; ++b) bands_[b].push_back(static_cast<std::uint32_t>(i));
    }
  }

  // Where no Gaussian is dense enough to have a nearest depth, many thin ones shadow from their mean on.
  void resolve(ShadowTexels& texels) const {
    const auto n = static_cast<std::size_t>(planes_.size);
    texels.front.resize(n * n);
    texels.through.resize(n * n);
    parallelFor(n, kBand, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) {
        for (std::size_t x = 0; x < n; ++x) {
          const std::size_t from = y * planes_.stride + x, to = y * n + x;
          const float nearest = planes_.nearest[from], weight = planes_.weight[from];
          texels.through[to] = planes_.through[from];
          texels.front[to] = nearest < kNothing || weight == 0 ? nearest : planes_.weighted[from] / weight;
        }
      }
    });
  }

  AlignedVector<float> scratch_;
  AlignedVector<ShadowSplat> splats_;
  std::vector<std::vector<std::uint32_t>> bands_;
  ShadowPlanes planes_;
};

}  // namespace

std::unique_ptr<ShadowDrawer> makeCpuShadowDrawer() { return std::make_unique<CpuShadowDrawer>(); }

}  // namespace beam
