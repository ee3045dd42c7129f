// SPDX-License-Identifier: Apache-2.0
// Small pictures of solved frames: photograph, render, difference, base colour, AO, normal, as JPEG in
// memory.
#pragma once

#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/render/device.h"
#include "core/scene/capture.h"
#include "core/scene/gaussian_sequence.h"

namespace beam {

struct ContactRow {
  std::string frame, camera;
  bool held_out = false;
  std::vector<std::pair<std::string, std::vector<std::byte>>> cells;  // title, JPEG
};

// One row a frame and view that has a photograph. Cropped to the subject, about 200 pixels a side.
std::vector<ContactRow> contactSheet(const GaussianSequence& sequence, const CaptureSet& capture,
                                     const std::vector<FrameIndex>& frames,
                                     const std::vector<std::string>& cameras, ComputeDevice& device,
                                     Progress& progress);

}  // namespace beam
