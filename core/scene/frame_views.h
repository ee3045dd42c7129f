// SPDX-License-Identifier: Apache-2.0
// The photographs of one frame, loaded: what the method works on. 8-bit, so that 81 views stay in memory.
#pragma once

#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/scene/capture.h"

namespace beam {

struct FrameView {
  std::string name;
  Camera camera;
  Image<u8vec3> photo;       // sRGB
  Image<std::uint8_t> mask;  // 255 inside; empty: the capture has none
};

// The views of `split` that hold a readable picture of the frame; a picture that cannot be read is left out
// with a warning. Pictures and cameras are scaled down by `downscale` (area average). Throws Error{Data} when
// fewer than two views remain.
std::vector<FrameView> loadFrameViews(const CaptureSet& capture, FrameIndex frame, Split split, int downscale,
                                      const Progress& progress);

// The view as a camera of `factor` times fewer pixels a side would have seen it (area average).
FrameView shrunk(const FrameView& view, int factor);

}  // namespace beam
