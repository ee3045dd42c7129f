// SPDX-License-Identifier: Apache-2.0
// ComputeDevice: makes the operations of the engine. The CPU device is the default and is always there.
#pragma once

#include <memory>
#include <string>

#include "core/render/rasterizer.h"
#include "core/render/resident_scene.h"
#include "core/render/shadow_drawer.h"
#include "core/render/tracer.h"
#include "core/render/training_ops.h"

namespace beam {

enum class SimdTarget { Auto, Avx512, Avx2, Scalar };

struct DeviceInfo {
  std::string id;     // "cpu"
  std::string title;  // with the instruction set in use
};

class ComputeDevice {
 public:
  virtual ~ComputeDevice() = default;
  virtual DeviceInfo info() const = 0;
  virtual std::unique_ptr<Rasterizer> newRasterizer(const RasterDesc& desc) = 0;
  virtual std::unique_ptr<ResidentScene> newResidentScene() = 0;
  virtual std::unique_ptr<Tracer> newTracer(const TracerDesc& desc, const GaussianCloud& cloud) = 0;
  virtual std::unique_ptr<ShadowDrawer> newShadowDrawer() = 0;
  virtual std::unique_ptr<TrainingOps> newTrainingOps() = 0;
};

// The CPU device on an instruction set; results do not depend on it. Throws Error{Usage} when the machine
// lacks it.
std::unique_ptr<ComputeDevice> makeCpuDevice(SimdTarget target = SimdTarget::Auto);

}  // namespace beam
