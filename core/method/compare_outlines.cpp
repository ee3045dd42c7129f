// SPDX-License-Identifier: Apache-2.0
#include "core/method/compare_outlines.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/base/parallel.h"
#include "core/method/visual_hull.h"

namespace beam {
namespace {

constexpr double kCellShare = 0.02;  // of the subject's size: how far a mask may be off
constexpr int kViewsPerWrong = 8;    // of so many views one may be wrong
constexpr int kMostWrong = 3;
constexpr std::uint8_t kNobody = 255;

// The least denials of the cells in front of a pixel, on a raster of blocks.
struct Raster {
  int block = 1, width = 0, height = 0;
  std::vector<std::uint8_t> denials;  // kNobody: no cell
  std::vector<std::int32_t> denier;   // of pixels that one view denies; -1: different views do, by the cell
};

int blockOf(const VisualHull& hull, const VisualHull::Cells& cells, int view) {
  for (const VisualHull::Cell& c : cells.cells) {
    if (const auto box = hull.footprint(view, c.center, cells.half_m))
      return std::max(1, (box->x1 - box->x0) / 2);
  }
  return 1;
}

Raster rasterOf(const VisualHull& hull, const VisualHull::Cells& cells, int view, const FrameView& picture) {
  Raster r;
  r.block = blockOf(hull, cells, view);
  r.width = (picture.mask.width + r.block - 1) / r.block;
  r.height = (picture.mask.height + r.block - 1) / r.block;
  r.denials.assign(static_cast<std::size_t>(r.width) * r.height, kNobody);
  r.denier.assign(r.denials.size(), -1);
  for (const VisualHull::Cell& c : cells.cells) {
    const auto box = hull.footprint(view, c.center, cells.half_m);
    if (!box || hull.insideCount(view, *box) == 0) continue;
    for (int y = box->y0 / r.block; y < (box->y1 + r.block - 1) / r.block; ++y) {
      for (int x = box->x0 / r.block; x < (box->x1 + r.block - 1) / r.block; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * r.width + x;
        if (c.denials == r.denials[i] && r.denier[i] != c.denier) r.denier[i] = -1;
        if (c.denials >= r.denials[i]) continue;
        r.denials[i] = static_cast<std::uint8_t>(c.denials);
        r.denier[i] = c.denier;
      }
    }
  }
  return r;
}

// Shares of one view's mask.
struct Shares {
  bool any = false;
  double denied = 0;
  std::vector<double> by;  // denied by that view alone
};

Shares sharesOf(const VisualHull& hull, const Raster& r, int view, const FrameView& picture, int views,
                int most_wrong) {
  Shares s;
  s.by.assign(static_cast<std::size_t>(views), 0);
  double area = 0;
  for (int y = 0; y < r.height; ++y) {
    for (int x = 0; x < r.width; ++x) {
      const VisualHull::PixelBox box{x * r.block, y * r.block,
                                     std::min((x + 1) * r.block, picture.mask.width),
                                     std::min((y + 1) * r.block, picture.mask.height)};
      const double inside = hull.insideCount(view, box);
      const std::size_t i = static_cast<std::size_t>(y) * r.width + x;
      area += inside;
      if (r.denials[i] > most_wrong) s.denied += inside;
      if (r.denials[i] == 1 && r.denier[i] >= 0) s.by[static_cast<std::size_t>(r.denier[i])] += inside;
    }
  }
  s.any = area > 0;
  if (!s.any) return s;
  s.denied /= area;
  for (double& share : s.by) share /= area;
  return s;
}

}  // namespace

std::vector<OutlineFit> compareOutlines(std::span<const FrameView> views, const Progress& progress) {
  std::vector<OutlineFit> fits(views.size());
  std::vector<std::size_t> with_mask;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].mask.empty()) with_mask.push_back(i);
  }
  const int count = static_cast<int>(with_mask.size());
  const int most_wrong = std::clamp(count / kViewsPerWrong, 1, kMostWrong);
  const VisualHull hull(views);
  const VisualHull::Cells cells = hull.cellsDeniedBy(most_wrong, kCellShare, progress);
  if (cells.cells.empty()) return fits;
  std::vector<Shares> shares(with_mask.size());
  parallelFor(with_mask.size(), 1, [&](std::size_t v, std::size_t) {
    if (progress.stopRequested()) return;
    const FrameView& picture = views[with_mask[v]];
    const int view = static_cast<int>(v);
    shares[v] = sharesOf(hull, rasterOf(hull, cells, view, picture), view, picture, count, most_wrong);
  });
  progress.check();
  for (std::size_t v = 0; v < with_mask.size(); ++v) {
    OutlineFit& fit = fits[with_mask[v]];
    fit.judged = true;
    fit.denied = shares[v].denied;
    double others = 0;
    for (std::size_t o = 0; o < with_mask.size(); ++o) {
      if (o == v || !shares[o].any) continue;
      fit.alone += shares[o].by[v];
      ++others;
    }
    if (others > 0) fit.alone /= others;
  }
  return fits;
}

}  // namespace beam
