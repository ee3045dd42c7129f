// SPDX-License-Identifier: Apache-2.0
// Visual hull of a frame's masks: the points that no view sees outside its mask.
#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/scene/frame_views.h"

namespace beam {

class VisualHull {
 public:
  // Views without masks say nothing. Masks count as inside from 128.
  explicit VisualHull(std::span<const FrameView> views);

  // How many views see the point inside their picture, and in how many of these it falls into the mask.
  struct Votes {
    int seen = 0, inside = 0;
  };
  Votes votes(vec3 x_in_world) const;
  // Seen by at least two views (or by all, if there are fewer) and outside no mask.
  bool contains(vec3 x_in_world) const;

  // Centres of the cells of about `cell_m` that the hull's surface passes through, in a fixed order. Empty
  // when no view has a mask or the hull is empty.
  std::vector<vec3> surfaceCells(float cell_m, const Progress& progress) const;

 private:
  struct MaskView {
    dmat3 rotation;
    dvec3 translation;
    Intrinsics intrinsics;
    int width, height;
    const Image<std::uint8_t>* mask;
    std::vector<std::uint32_t> integral;  // (width + 1) x (height + 1) counts of inside pixels
  };
  enum class Cover { Outside, Inside, Mixed };
  Cover classify(const dvec3& center, double half) const;
  void boundingCube(dvec3& center, double& half) const;

  std::vector<MaskView> views_;
};

}  // namespace beam
