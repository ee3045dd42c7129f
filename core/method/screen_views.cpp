// SPDX-License-Identifier: Apache-2.0
#include "core/method/screen_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/math/statistics.h"
#include "core/method/compare_outlines.h"

namespace beam {
namespace {

constexpr std::size_t kFewestKept = 3, kViewsPerLeftOut = 4;
constexpr int kMostWrong = 2;  // cameras that deny one place together
constexpr std::size_t kCandidates = 3;
// The bright part is what one pixel in so many is brighter than; a small subject before black has few.
constexpr std::size_t kBrightPart = 20, kBrightPartOfAll = 1000;
constexpr double kFineShare = 0.01;  // of the subject's size, the square root of its area
constexpr int kCoarser = 4;
constexpr int kFewestSamples = 32;      // gradients that a mean needs
constexpr double kLeastContrast = 1.0;  // mean coarse gradient, grey levels: below there is no detail to lose

bool saysSomething(const Image<std::uint8_t>& mask) {
  return std::any_of(mask.pixels.begin(), mask.pixels.end(), [](std::uint8_t m) { return m >= kInside; });
}

double brightPart(const FrameView& v) {
  const bool masked = saysSomething(v.mask);
  std::vector<std::size_t> histogram(256, 0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < v.photo.pixels.size(); ++i) {
    if (masked && v.mask.pixels[i] < kInside) continue;
    ++histogram[static_cast<std::size_t>(std::lround(luma(v.photo.pixels[i])))];
    ++count;
  }
  const std::size_t part = masked ? kBrightPart : kBrightPartOfAll;
  std::size_t above = 0;
  for (int level = 255; level >= 0; --level) {
    above += histogram[static_cast<std::size_t>(level)];
    if (part * above >= count) return level / 255.0;
  }
  return 0;
}

// Mean length of luma's gradient where the neighbours are wholly inside, in grey levels a pixel; negative:
// too few pixels.
double meanGradient(const FrameView& v) {
  const auto inside = [&](int x, int y) { return v.mask(x, y) == 255; };
  double sum = 0;
  int n = 0;
  for (int y = 1; y + 1 < v.photo.height; ++y) {
    for (int x = 1; x + 1 < v.photo.width; ++x) {
      if (!inside(x - 1, y) || !inside(x + 1, y) || !inside(x, y - 1) || !inside(x, y + 1)) continue;
      sum += std::hypot(luma(v.photo(x + 1, y)) - luma(v.photo(x - 1, y)),
                        luma(v.photo(x, y + 1)) - luma(v.photo(x, y - 1))) /
             2;
      ++n;
    }
  }
  return n < kFewestSamples ? -1 : sum / n;
}

double detailInside(const FrameView& v) {
  const auto area =
      std::count_if(v.mask.pixels.begin(), v.mask.pixels.end(), [](std::uint8_t m) { return m >= kInside; });
  const int fine =
      std::max(1, static_cast<int>(std::lround(kFineShare * std::sqrt(static_cast<double>(area)))));
  const double near = meanGradient(shrunk(v, fine)), far = meanGradient(shrunk(v, fine * kCoarser));
  return near < 0 || far < kLeastContrast ? 0 : near / far;
}

double detailOf(const FrameView& v) {
  if (v.mask.empty()) {
    return detailInside({v.name, v.camera, v.photo, Image<std::uint8_t>(v.photo.width, v.photo.height, 255)});
  }
  return saysSomething(v.mask) ? detailInside(v) : 0;
}

class Screener {
 public:
  Screener(std::span<const FrameView> views, const ScreenLimits& limits, const Progress& progress)
      : views_(views), limits_(limits), progress_(progress), suspect_(views.size(), false) {
    found_.figures.resize(views.size());
  }

  Screening screen() {
    measure();
    if (views_.size() <= kFewestKept) return std::move(found_);
    black();
    outlines();
    const std::size_t worse = found_.suspects.size();
    blurred();
    const std::size_t all = found_.suspects.size();
    found_.to_leave_out = all <= mostLeftOut() ? all : worse <= mostLeftOut() ? worse : 0;
    return std::move(found_);
  }

 private:
  std::size_t mostLeftOut() const {
    return std::min(views_.size() / kViewsPerLeftOut, views_.size() - kFewestKept);
  }

  void measure() {
    parallelFor(views_.size(), 1, [&](std::size_t i, std::size_t) {
      if (progress_.stopRequested()) return;
      found_.figures[i] = {views_[i].name, brightPart(views_[i]), detailOf(views_[i]), 0};
    });
    progress_.check();
  }

  void accuse(std::size_t view, ScreenKind kind, double figure, std::string text) {
    suspect_[view] = true;
    found_.suspects.push_back({views_[view].name, kind, figure, std::move(text)});
  }

  void black() {
    std::vector<double> all;
    for (const ScreenFigures& f : found_.figures) all.push_back(f.bright);
    const double usual = median(all);
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const double bright = found_.figures[i].bright;
      if (bright > limits_.black_luma || bright >= limits_.black_share * usual) continue;
      accuse(i, ScreenKind::Black, bright,
             fmt::format("is black: the bright part of its picture has a luma of {:.3f}, that of the median "
                         "camera {:.2f}",
                         bright, usual));
    }
  }

  void blurred() {
    std::vector<double> all;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (!suspect_[i] && found_.figures[i].detail > 0) all.push_back(found_.figures[i].detail);
    }
    if (all.size() <= kFewestKept) return;
    const double usual = median(all);
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const double share = found_.figures[i].detail / usual;
      if (suspect_[i] || share <= 0 || share > limits_.blurred_share) continue;
      accuse(i, ScreenKind::Blurred, share,
             fmt::format("is blurred: it has {:.0f} % of the fine detail of the median camera", 100 * share));
    }
  }

  bool isCompared(std::size_t view) const { return !suspect_[view] && !views_[view].mask.empty(); }

  // The views whose outlines are compared, without the suspects and `tried`; their photographs are not
  // looked at.
  struct Compared {
    std::vector<FrameView> views;
    std::vector<std::size_t> index;
  };
  Compared comparedWithout(const std::vector<std::size_t>& tried) const {
    Compared c;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (!isCompared(i) || std::find(tried.begin(), tried.end(), i) != tried.end()) continue;
      c.views.push_back({views_[i].name, views_[i].camera, {}, views_[i].mask});
      c.index.push_back(i);
    }
    return c;
  }

  // The share of the masks that is contradicted, mean over the views.
  double contradictedWithout(const std::vector<std::size_t>& tried) {
    const Compared c = comparedWithout(tried);
    const std::vector<OutlineFit> fits = compareOutlines(c.views, 0, progress_);
    double sum = 0;
    for (std::size_t i = 0; i < fits.size(); ++i) {
      sum += fits[i].contradicted;
      if (tried.empty()) found_.figures[c.index[i]].outline = fits[i].contradicted;
    }
    return sum / static_cast<double>(std::max<std::size_t>(1, fits.size()));
  }

  // Whether those who could be left out have half of it; `blamed` is sorted, negative.
  bool fewHaveTheBlame(const std::vector<std::pair<double, std::size_t>>& blamed) const {
    double all = 0, few = 0;
    for (std::size_t i = 0; i < blamed.size(); ++i) {
      all += blamed[i].first;
      if (i < mostLeftOut()) few += blamed[i].first;
    }
    return 2 * few <= all;
  }

  // By view, the most blamed first; blame is negative.
  std::vector<std::pair<double, std::size_t>> blameWithout(const std::vector<std::size_t>& tried,
                                                           int most_wrong) const {
    const Compared c = comparedWithout(tried);
    const std::vector<OutlineFit> fits = compareOutlines(c.views, most_wrong, progress_);
    std::vector<std::pair<double, std::size_t>> blamed;
    for (std::size_t i = 0; i < fits.size(); ++i) blamed.emplace_back(-fits[i].blame, c.index[i]);
    std::sort(blamed.begin(), blamed.end());
    return blamed;
  }

  // Nothing: everybody is to blame. Adds to `tried` the one of the most blamed views without which the least
  // contradiction remains: returned.
  std::optional<double> tryWorst(int most_wrong, std::vector<std::size_t>& tried) {
    const std::vector<std::pair<double, std::size_t>> blamed = blameWithout(tried, most_wrong);
    if (tried.empty() && !fewHaveTheBlame(blamed)) return std::nullopt;
    std::size_t best = blamed.front().second;
    double least = 2;
    for (std::size_t i = 0; i < std::min(kCandidates, blamed.size()); ++i) {
      std::vector<std::size_t> without = tried;
      without.push_back(blamed[i].second);
      const double share = contradictedWithout(without);
      if (share < least) least = share, best = blamed[i].second;
    }
    tried.push_back(best);
    return least;
  }

  // Takes the worst away one at a time and accuses them when little contradiction remains: ragged masks
  // accuse nobody. False: they do not explain the contradictions.
  bool explained(int most_wrong, double all) {
    std::vector<std::size_t> tried;
    std::vector<double> drop;
    for (double now = all; now > limits_.outline_rest * all;) {
      if (found_.suspects.size() + tried.size() >= mostLeftOut()) return false;
      const std::optional<double> next = tryWorst(most_wrong, tried);
      if (!next) return false;
      drop.push_back(now - *next);
      now = *next;
    }
    for (std::size_t i = 0; i < tried.size(); ++i) {
      accuse(
          tried[i], ScreenKind::Outline, drop[i],
          fmt::format("has an outline that the other cameras contradict ({:.1f} % of the masks' area is "
                      "contradicted, {:.0f} % of that through this camera): another moment, a moved camera "
                      "or a wrong mask",
                      100 * all, 100 * drop[i] / all));
    }
    return true;
  }

  // A camera of another moment disturbs the others' outlines too, and two of them hide each other's blame.
  void outlines() {
    std::size_t compared = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) compared += isCompared(i);
    if (compared <= kFewestKept) return;
    const double all = contradictedWithout({});
    if (all < limits_.outline_share) return;
    for (int most_wrong = 1; most_wrong <= kMostWrong; ++most_wrong) {
      if (explained(most_wrong, all)) return;
    }
  }

  std::span<const FrameView> views_;
  const ScreenLimits& limits_;
  const Progress& progress_;
  std::vector<bool> suspect_;
  Screening found_;
};

}  // namespace

const char* toText(ScreenKind kind) {
  switch (kind) {
    case ScreenKind::Black:
      return "black";
    case ScreenKind::Blurred:
      return "blurred";
    case ScreenKind::Outline:
      return "outline";
  }
  return "";
}

Screening screenViews(std::span<const FrameView> views, const ScreenLimits& limits,
                      const Progress& progress) {
  return Screener(views, limits, progress).screen();
}

}  // namespace beam
