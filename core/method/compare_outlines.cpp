// SPDX-License-Identifier: Apache-2.0
#include "core/method/compare_outlines.h"

#include <algorithm>
#include <cstdint>

#include "core/base/parallel.h"
#include "core/scene/visual_hull.h"

namespace beam {
namespace {

// Cells of the subject's size: how far a mask may be off. For blame that two share coarse ones do.
constexpr double kCellShare = 0.02, kCoarseShare = 0.03;
constexpr std::int32_t kNoCell = -1;

// The least denied cell on the rays through a pixel, on a raster of blocks.
struct Raster {
  int block = 1, width = 0, height = 0;
  std::vector<std::int32_t> cell;
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
  r.cell.assign(static_cast<std::size_t>(r.width) * r.height, kNoCell);
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    const auto box = hull.footprint(view, cells.cells[c].center, cells.half_m);
    if (!box || hull.insideCount(view, *box) == 0) continue;
    for (int y = box->y0 / r.block; y < (box->y1 + r.block - 1) / r.block; ++y) {
      for (int x = box->x0 / r.block; x < (box->x1 + r.block - 1) / r.block; ++x) {
        std::int32_t& known = r.cell[static_cast<std::size_t>(y) * r.width + x];
        const bool better =
            known == kNoCell || cells.cells[c].denials < cells.cells[static_cast<std::size_t>(known)].denials;
        if (better) known = static_cast<std::int32_t>(c);
      }
    }
  }
  return r;
}

// Where the subject is on a view's rays, by the least denied places that most views look at; far from them
// the rays of two views meet too.
struct DepthRange {
  double nearest = 0, farthest = -1;  // empty: nobody knows
};

std::vector<dvec3> subjectOf(const VisualHull::Cells& cells) {
  int least = VisualHull::kMostDenials, most_seen = 0;
  for (const VisualHull::Cell& c : cells.cells) least = std::min(least, c.denials);
  for (const VisualHull::Cell& c : cells.cells) {
    if (c.denials == least) most_seen = std::max(most_seen, c.seen);
  }
  std::vector<dvec3> subject;
  for (const VisualHull::Cell& c : cells.cells) {
    if (c.denials == least && 2 * c.seen > most_seen) subject.push_back(c.center);
  }
  return subject;
}

DepthRange rangeOf(const VisualHull& hull, const std::vector<dvec3>& subject, int view) {
  if (subject.empty()) return {};
  DepthRange range{hull.depth(view, subject.front()), hull.depth(view, subject.front())};
  for (const dvec3& x : subject) {
    const double z = hull.depth(view, x);
    range = {std::min(range.nearest, z), std::max(range.farthest, z)};
  }
  return range;
}

// What one view's mask says: its contradicted share, and the blame for it by view.
struct Verdict {
  double contradicted = 0;
  std::vector<double> blame;
};

// What no other view pictures nobody contradicts: one full-length camera among portraits.
Verdict verdictOf(const VisualHull& hull, const VisualHull::Cells& cells, const std::vector<dvec3>& subject,
                  int view, const FrameView& picture, int views) {
  const DepthRange range = rangeOf(hull, subject, view);
  const Raster r = rasterOf(hull, cells, view, picture);
  Verdict v;
  v.blame.assign(static_cast<std::size_t>(views), 0);
  double area = 0;
  for (int y = 0; y < r.height; ++y) {
    for (int x = 0; x < r.width; ++x) {
      const double inside =
          hull.insideCount(view, {x * r.block, y * r.block, std::min((x + 1) * r.block, picture.mask.width),
                                  std::min((y + 1) * r.block, picture.mask.height)});
      area += inside;
      const std::int32_t index = r.cell[static_cast<std::size_t>(y) * r.width + x];
      const int denials = index == kNoCell ? 0 : cells.cells[static_cast<std::size_t>(index)].denials;
      if (inside == 0 || (index != kNoCell && denials == 0)) continue;
      const dvec2 middle((x + 0.5) * r.block, (y + 0.5) * r.block);
      if (hull.leavesOtherPictures(view, middle, range.nearest, range.farthest, 2 * cells.half_m)) continue;
      v.contradicted += inside;
      v.blame[static_cast<std::size_t>(view)] += inside / (1 + denials);
      for (int d = 0; d < denials; ++d) {
        const int denier = cells.cells[static_cast<std::size_t>(index)].deniers[static_cast<std::size_t>(d)];
        v.blame[static_cast<std::size_t>(denier)] += inside / (1 + denials);
      }
    }
  }
  if (area == 0) return v;
  v.contradicted /= area;
  for (double& b : v.blame) b /= area;
  return v;
}

}  // namespace

std::vector<OutlineFit> compareOutlines(std::span<const FrameView> views, int most_wrong,
                                        const Progress& progress) {
  std::vector<OutlineFit> fits(views.size());
  std::vector<std::size_t> with_mask;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].mask.empty()) with_mask.push_back(i);
  }
  const int count = static_cast<int>(with_mask.size());
  const VisualHull hull(views);
  const VisualHull::Cells cells =
      hull.cellsDeniedBy(most_wrong, most_wrong < 2 ? kCellShare : kCoarseShare, progress);
  const std::vector<dvec3> subject = subjectOf(cells);
  std::vector<Verdict> verdicts(with_mask.size());
  parallelFor(with_mask.size(), 1, [&](std::size_t v, std::size_t) {
    if (progress.stopRequested()) return;
    verdicts[v] = verdictOf(hull, cells, subject, static_cast<int>(v), views[with_mask[v]], count);
  });
  progress.check();
  for (std::size_t v = 0; v < with_mask.size(); ++v) {
    fits[with_mask[v]].contradicted = verdicts[v].contradicted;
    for (std::size_t o = 0; o < with_mask.size(); ++o) fits[with_mask[o]].blame += verdicts[v].blame[o];
  }
  return fits;
}

}  // namespace beam
