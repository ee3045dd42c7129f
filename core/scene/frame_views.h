// SPDX-License-Identifier: Apache-2.0
// The photographs of one frame, loaded: what the method works on. 8-bit, so that 81 views stay in memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/scene/capture.h"

namespace beam {

inline constexpr std::uint8_t kInside = 128;  // a mask is inside from this value on

struct FrameView {
  std::string name;
  Camera camera;             // a pinhole: of the picture as decoded
  Image<u8vec3> photo;       // sRGB
  Image<std::uint8_t> mask;  // 255 inside; empty: the capture has none
};

// The views of `split` that hold a readable picture of the frame; a picture that cannot be read is left out
// with a warning. Pictures and cameras are scaled down by `downscale` (area average). Throws Error{Data} when
// fewer than two views remain.
std::vector<FrameView> loadFrameViews(const CaptureSet& capture, FrameIndex frame, Split split, int downscale,
                                      const Progress& progress);

// One of them; empty when a stop is requested. Throws Error{Data} when the picture or the mask cannot be
// read.
FrameView loadFrameView(const CaptureSet& capture, ViewIndex view, FrameIndex frame, int downscale,
                        const Progress& progress);
// Warns of each picture that could not be read, in the order of the views: `problems` says why, a text a
// view, empty for the others. Throws what loadFrameViews throws when only `readable` views are left.
void judgeFrameViews(const CaptureSet& capture, FrameIndex frame, Split split,
                     const std::vector<std::string>& problems, std::size_t readable);

// The view as a camera of `factor` times fewer pixels a side would have seen it (area average).
FrameView shrunk(const FrameView& view, int factor);

}  // namespace beam
