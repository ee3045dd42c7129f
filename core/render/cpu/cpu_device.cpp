// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <mutex>

#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/render/cpu/cpu_rasterizer.h"
#include "core/render/cpu/cpu_resident_scene.h"
#include "core/render/cpu/cpu_shadow_drawer.h"
#include "core/render/cpu/cpu_training_ops.h"
#include "core/render/cpu/splat_bvh.h"
#include "core/render/device.h"
#include "hwy/highway.h"

namespace beam {
namespace {

std::int64_t targetBits(SimdTarget target) {
  switch (target) {
    case SimdTarget::Auto:
      return 0;
    case SimdTarget::Avx512:
      return HWY_AVX3;
    case SimdTarget::Avx2:
      return HWY_AVX2;
    case SimdTarget::Scalar:
      return HWY_STATIC_TARGET;
  }
  return 0;
}

const char* nameOf(SimdTarget target) {
  switch (target) {
    case SimdTarget::Avx512:
      return "avx512";
    case SimdTarget::Avx2:
      return "avx2";
    case SimdTarget::Scalar:
      return "scalar";
    case SimdTarget::Auto:
      break;
  }
  return "auto";
}

// The kernels' dispatch is a property of the process, as Highway keeps it.
void chooseTarget(SimdTarget target) {
  hwy::SetSupportedTargetsForTest(0);
  const std::int64_t bits = targetBits(target), supported = hwy::SupportedTargets();
  if (target != SimdTarget::Auto && target != SimdTarget::Scalar && (supported & bits) == 0) {
    throw Error(Error::Kind::Usage,
                fmt::format("this machine lacks the instruction set \"{}\"; use auto", nameOf(target)));
  }
  if (target != SimdTarget::Auto) hwy::SetSupportedTargetsForTest(bits);
}

class CpuDevice final : public ComputeDevice {
 public:
  DeviceInfo info() const override {
    const std::int64_t supported = hwy::SupportedTargets();
    const char* set = (supported & HWY_AVX3) ? "AVX-512" : (supported & HWY_AVX2) ? "AVX2" : "scalar";
    return {"cpu", fmt::format("CPU, {}, {}", countText(threadCount(), "thread"), set)};
  }
  std::unique_ptr<Rasterizer> newRasterizer(const RasterDesc& desc) override {
    return makeCpuRasterizer(desc);
  }
  std::unique_ptr<ResidentScene> newResidentScene() override { return std::make_unique<CpuResidentScene>(); }
  std::unique_ptr<Tracer> newTracer(const TracerDesc& desc, const GaussianCloud& cloud) override {
    const std::lock_guard lock(mutex_);
    return makeFollowingTracer(desc, cloud, tree_);
  }
  std::unique_ptr<ShadowDrawer> newShadowDrawer() override { return makeCpuShadowDrawer(); }
  std::unique_ptr<TrainingOps> newTrainingOps() override { return makeCpuTrainingOps(); }

 private:
  std::mutex mutex_;
  std::shared_ptr<const SplatBvh> tree_;  // of the last tracer: the next frame's Gaussians are near
};

}  // namespace

std::unique_ptr<ComputeDevice> makeCpuDevice(SimdTarget target) {
  chooseTarget(target);
  return std::make_unique<CpuDevice>();
}

}  // namespace beam
