// SPDX-License-Identifier: Apache-2.0
// A tracer whose occluders are a formula: closed-form tests of the light integrals without any Gaussian.
#pragma once

#include <functional>

#include "core/render/tracer.h"

namespace beam {

class FunctionTracer final : public Tracer {
 public:
  explicit FunctionTracer(std::function<bool(const Ray&)> blocked) : blocked_(std::move(blocked)) {}
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = blocked_(rays[i]);
  }
  float transmittance(const Ray& ray, const BlendRules&) const override {
    return blocked_(ray) ? 0.0f : 1.0f;
  }
  std::optional<SplatHit> drawn(const Ray& ray, std::uint64_t, const BlendRules&) const override {
    return blocked_(ray) ? std::optional<SplatHit>(SplatHit{}) : std::nullopt;
  }
  std::uint64_t alphaSum(const Ray& ray) const override { return blocked_(ray) ? 1u << 20 : 0; }
  std::size_t memoryBytes() const override { return 0; }

 private:
  std::function<bool(const Ray&)> blocked_;
};

}  // namespace beam
