// SPDX-License-Identifier: Apache-2.0
// The CPU rasteriser: exact 4x4 blocks, threads over tiles, gradients summed in key order. Chosen through the
// device.
#pragma once

#include <memory>

#include "core/render/rasterizer.h"

namespace beam {

std::unique_ptr<Rasterizer> makeCpuRasterizer(const RasterDesc& desc);

}  // namespace beam
