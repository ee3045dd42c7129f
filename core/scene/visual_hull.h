// SPDX-License-Identifier: Apache-2.0
// Visual hull of a frame's masks: the points that no view sees outside its mask.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/scene/frame_views.h"

namespace beam {

class VisualHull {
 public:
  // Views without masks say nothing. Masks count as inside from 128. Throws Error{Bug} for a camera with a
  // lens.
  explicit VisualHull(std::span<const FrameView> views);

  // How many views see the point inside their picture, and in how many of these it falls into the mask.
  struct Votes {
    int seen = 0, inside = 0;
  };
  Votes votes(vec3 x_in_world) const;
  // Seen by at least two views (or by all, if there are fewer) and outside no mask.
  bool contains(vec3 x_in_world) const;

  // Centres of the cells of about `cell_m` that the hull's surface passes through, in a fixed order. Empty
  // when no view has a mask or the hull is empty. Throws Error{Data} for a subject that is too large for the
  // cells, which one in another unit than the metre is.
  std::vector<vec3> surfaceCells(float cell_m, const Progress& progress) const;

  // A view denies a cell that it sees inside its picture with no pixel of its mask on it.
  static constexpr int kMostDenials = 3;
  struct Cell {
    dvec3 center;
    int seen = 0;  // by how many views
    int denials = 0;
    std::array<std::int16_t, kMostDenials> deniers = {};  // the first `denials` are views
  };
  struct Cells {
    double half_m = 0;
    std::vector<Cell> cells;
  };
  // The cells that two views see and at most `most_denials` (to kMostDenials) deny, in a fixed order; about
  // `share` of the subject's size, by the median view's mask, and not below a pixel.
  Cells cellsDeniedBy(int most_denials, double share, const Progress& progress) const;

  // Around the point nearest to all optical axes, half way and more to the nearest camera: what is carved.
  struct Cube {
    dvec3 center;
    double half_m;
  };
  Cube boundingCube() const;

  // Half-open, inside the picture.
  struct PixelBox {
    int x0, y0, x1, y1;
  };
  // Pixels that the cell's surrounding ball may touch; nothing: none, or the camera stands in it. `view`
  // counts the views with masks.
  std::optional<PixelBox> footprint(int view, const dvec3& center, double half) const;
  std::uint32_t insideCount(int view, const PixelBox& box) const;
  double depth(int view, const dvec3& x_in_world) const;
  // Whether one of the places at every `step` of depth on the ray through a pixel position of `view` lies in
  // no other view's picture.
  bool leavesOtherPictures(int view, const dvec2& pixel, double nearest, double farthest, double step) const;

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
  static bool pictures(const MaskView& v, const dvec3& x_in_world);
  static std::optional<PixelBox> boxOf(const MaskView& v, const dvec3& in_camera, double radius);
  static std::uint32_t insideCount(const MaskView& v, const PixelBox& box);
  int halvings(const dvec3& center, double half, double share) const;
  std::optional<Cell> votedCell(const dvec3& center, double half, int most_denials) const;
  Cover classify(const dvec3& center, double half) const;

  std::vector<MaskView> views_;
};

}  // namespace beam
