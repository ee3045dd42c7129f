// SPDX-License-Identifier: Apache-2.0
// The photographs of a frame as training targets: cropped to the masks (with a margin), all of one size so
// that one rasteriser serves them, composited on any background.
#pragma once

#include <span>
#include <vector>

#include "core/scene/frame_views.h"

namespace beam {

struct TrainingView {
  Camera camera;               // of the crop
  Image<u8vec3> photo;         // sRGB
  Image<std::uint8_t> mask;    // empty: everything counts
  bool premultiplied = false;  // the photograph is black outside its mask: it already is value x coverage
  // Of the crop, from its first pixel on, the part that the photograph has; the rest tells nothing.
  int known_width = 0, known_height = 0;

  bool whole() const { return known_width == photo.width && known_height == photo.height; }
  bool knows(std::size_t pixel) const {
    const auto width = static_cast<std::size_t>(photo.width);
    return pixel % width < static_cast<std::size_t>(known_width) &&
           pixel / width < static_cast<std::size_t>(known_height);
  }
};

// Crops of one common size, a multiple of 16 where the pictures allow it.
std::vector<TrainingView> cropToMasks(std::span<const FrameView> views);

// What the view should look like on `background`, sRGB-encoded: p + (1 - a) b for premultiplied photographs,
// else a p + (1 - a) b. `target` is resized.
void compose(const TrainingView& view, vec3 background, Planes& target);

// Takes into `target` what was rendered where the photograph tells nothing: no loss, no gradient.
void acceptUnknown(const TrainingView& view, const Planes& rendered, Planes& target);

// weight * mean |A - mask| over the picture; `gradient` (1 plane, resized) receives its gradient. 0 without a
// mask.
double maskLoss(const Planes& alpha, const TrainingView& view, double weight, Planes& gradient);

// Metres that a pixel of these cameras spans at the middle of the points, mean over the cameras.
double pixelAtSubject(std::span<const Camera> cameras, std::span<const vec3> points_m);

}  // namespace beam
