// SPDX-License-Identifier: Apache-2.0
// Rasterisers of the last descriptions that were asked for: making one for every view of one size again would
// allocate its state anew.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/render/device.h"

namespace beam {

// One thread at a time. `device` outlives it.
class RasterizerCache {
 public:
  explicit RasterizerCache(ComputeDevice& device, std::size_t kept = 1) : device_(device), kept_(kept) {}

  // Valid until `kept` others were asked for.
  Rasterizer& of(const RasterDesc& desc) {
    const auto found = std::find_if(rasterizers_.begin(), rasterizers_.end(),
                                    [&](const auto& r) { return r->desc() == desc; });
    if (found != rasterizers_.end()) {
      std::rotate(found, found + 1, rasterizers_.end());
    } else {
      if (rasterizers_.size() >= kept_) rasterizers_.erase(rasterizers_.begin());
      rasterizers_.push_back(device_.newRasterizer(desc));
    }
    return *rasterizers_.back();
  }

 private:
  ComputeDevice& device_;
  std::size_t kept_;
  std::vector<std::unique_ptr<Rasterizer>> rasterizers_;  // the newest last
};

}  // namespace beam
