// SPDX-License-Identifier: Apache-2.0
#include "core/scene/measure_subject.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/statistics.h"
#include "core/scene/transform.h"
#include "core/scene/visual_hull.h"

namespace beam {
namespace {

constexpr double kDistance_m = 3;       // at which the hull is carved: its constants are for metres
constexpr std::size_t kMostViews = 16;  // more cut off little that counts for a height
constexpr std::size_t kMostFrames = 8;  // looked at for masks
constexpr int kLongestSide_px = 512;
constexpr double kCellShare = 1.0 / 40;  // of the subject's size
constexpr double kReachesEnds = 0.96;    // of the cube that is carved: there it is cut, not seen

std::vector<ViewIndex> trainingViews(const CaptureSet& capture, FrameIndex frame) {
  std::vector<ViewIndex> views;
  for (std::size_t i = 0; i < capture.views.size(); ++i) {
    const ViewIndex view{static_cast<std::int32_t>(i)};
    if (capture.views[i].split != Split::Train || !capture.source->has(view, frame)) continue;
    // Of masks in files the list tells which pictures have one.
    if (capture.masks == MaskKind::Files && capture.source->files(view, frame).size() == 1) continue;
    views.push_back(view);
  }
  return views;
}

// At most kMostViews, evenly from all.
std::vector<ViewIndex> someOf(const std::vector<ViewIndex>& views) {
  const std::size_t count = std::min(views.size(), kMostViews);
  std::vector<ViewIndex> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(views[i * views.size() / count]);
  return some;
}

FrameView maskView(const CaptureSet& capture, ViewIndex view, FrameIndex frame, const Similarity3& to_hull) {
  const View& v = capture.views[static_cast<std::size_t>(view.value)];
  FrameView full{v.name, transformed(v.camera, to_hull), {}, {}};
  try {
    full.mask = capture.source->mask(view, frame);
  } catch (const Error& e) {
    requireData(e);
    return full;  // whoever needs the picture says so
  }
  const int side = std::max(full.mask.width, full.mask.height);
  return shrunk(full, (side + kLongestSide_px - 1) / kLongestSide_px);
}

bool hasBody(const FrameView& view) {
  return std::any_of(view.mask.pixels.begin(), view.mask.pixels.end(), [](auto m) { return m >= kInside; });
}

std::vector<FrameView> maskViews(const CaptureSet& capture, const Similarity3& to_hull) {
  const std::size_t frames = std::min(capture.frames.size(), kMostFrames);
  for (std::size_t f = 0; f < frames; ++f) {
    const FrameIndex frame{static_cast<std::int32_t>(f)};
    const std::vector<ViewIndex> some = someOf(trainingViews(capture, frame));
    std::vector<FrameView> views(some.size());
    parallelFor(some.size(), 1,
                [&](std::size_t i, std::size_t) { views[i] = maskView(capture, some[i], frame, to_hull); });
    std::erase_if(views, [](const FrameView& v) { return !hasBody(v); });
    if (views.size() >= 2) return views;
  }
  return {};
}

// A subject that fills its pictures leaves nothing black; one that is cut by a border is not white on all
// four.
bool looksInverted(const Image<std::uint8_t>& mask) {
  constexpr double kBorder = 0.95, kHole = 0.005;  // shares: white of the border, black of the picture
  std::size_t border = 0, white = 0, black = 0;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      const bool inside = mask(x, y) >= kInside;
      black += !inside;
      if (x != 0 && y != 0 && x + 1 != mask.width && y + 1 != mask.height) continue;
      ++border;
      white += inside;
    }
  }
  return static_cast<double>(white) >= kBorder * static_cast<double>(border) &&
         static_cast<double>(black) >= kHole * static_cast<double>(mask.pixels.size());
}

// The cells that half of the views see at all: what two alone see, nobody else could carve.
std::vector<VisualHull::Cell> bodyOf(const VisualHull& hull, std::size_t views) {
  VisualHull::Cells found;
  // A camera of another moment or with a wrong mask denies what the others see.
  for (int denials = 0; denials <= VisualHull::kMostDenials && found.cells.empty(); ++denials) {
    found = hull.cellsDeniedBy(denials, kCellShare, Progress());
    std::erase_if(found.cells, [&](const auto& c) { return 2 * static_cast<std::size_t>(c.seen) < views; });
  }
  return found.cells;
}

std::optional<SubjectBox> boxOf(const VisualHull& hull, std::size_t views) {
  const std::vector<VisualHull::Cell> cells = bodyOf(hull, views);
  if (cells.empty()) return std::nullopt;
  constexpr double kFar = std::numeric_limits<double>::max();
  SubjectBox box{dvec3(kFar), dvec3(-kFar)};
  for (const VisualHull::Cell& cell : cells)
    box.low = glm::min(box.low, cell.center), box.high = glm::max(box.high, cell.center);
  const VisualHull::Cube cube = hull.boundingCube();
  if (box.high.y - box.low.y > kReachesEnds * 2 * cube.half_m) return std::nullopt;
  return box;
}

struct Inside {
  double share = 0;
  double tall = 0;  // from the lowest to the highest of them
};

Inside insideOf(const VisualHull& hull, const std::vector<dvec3>& points, const Similarity3& to_hull,
                double factor) {
  std::size_t seen = 0, inside = 0;
  double low = std::numeric_limits<double>::max(), high = -low;
  for (const dvec3& p : points) {
    const vec3 x(to_hull * (factor * p));
    const VisualHull::Votes votes = hull.votes(x);
    if (votes.seen < 2) continue;
    ++seen;
    if (votes.inside < votes.seen) continue;
    ++inside;
    low = std::min<double>(low, x.y), high = std::max<double>(high, x.y);
  }
  if (inside == 0) return {};
  return {static_cast<double>(inside) / static_cast<double>(seen), high - low};
}

// A cloud that is made much smaller lies in the subject as one speck: that is no fit.
SeedFit seedFit(const VisualHull& hull, const PointCloud& seeds, const Similarity3& to_hull, double height) {
  constexpr double kFits = 0.25, kFitsAfter = 0.5;
  constexpr std::size_t kMostPoints = 2000;
  std::vector<dvec3> some;
  const std::size_t all = seeds.position_m.size(), count = std::min(all, kMostPoints);
  for (std::size_t i = 0; i < count; ++i) some.push_back(seeds.position(i * all / count));
  SeedFit fit{insideOf(hull, some, to_hull, 1).share, 1};
  if (fit.share >= kFits) return fit;
  double best = kFitsAfter;
  for (const double unit : {0.001, 0.01, 0.0254, 0.1, 0.3048}) {
    for (const double factor : {unit, 1 / unit}) {
      const Inside then = insideOf(hull, some, to_hull, factor);
      if (then.share < best || then.tall < 0.25 * height) continue;
      best = then.share;
      fit.factor = factor;
    }
  }
  return fit;
}

}  // namespace

SubjectMeasure measureSubject(const CaptureSet& capture) {
  SubjectMeasure measure;
  std::vector<Camera> cameras;
  for (const View& v : capture.views) {
    if (v.split == Split::Train) cameras.push_back(v.camera);
  }
  measure.focus = focusOf(cameras);
  if (!measure.focus || capture.masks == MaskKind::None || !capture.source) return measure;
  const double scale = kDistance_m / measure.focus->distance_m;
  const Similarity3 to_hull{dmat3(1.0), scale, -scale * measure.focus->point};
  const std::vector<FrameView> views = maskViews(capture, to_hull);
  if (views.empty()) return measure;
  const auto inverted =
      std::count_if(views.begin(), views.end(), [](const FrameView& v) { return looksInverted(v.mask); });
  measure.masks_look_inverted = 2 * static_cast<std::size_t>(inverted) > views.size();
  if (measure.masks_look_inverted) return measure;
  const VisualHull hull(views);
  const std::optional<SubjectBox> box = boxOf(hull, views.size());
  if (!box) return measure;
  const Similarity3 back = inverse(to_hull);
  measure.subject = SubjectBox{back * box->low, back * box->high};
  if (!capture.seed_points.position_m.empty())
    measure.seeds = seedFit(hull, capture.seed_points, to_hull, box->high.y - box->low.y);
  return measure;
}

}  // namespace beam
