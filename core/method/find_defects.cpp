// SPDX-License-Identifier: Apache-2.0
#include "core/method/find_defects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/base/count_text.h"
#include "core/math/statistics.h"

namespace beam {
namespace {

constexpr std::size_t kFewestOthers = 3;  // cameras a median needs to say what is usual
constexpr int kFewestLagged = 2;          // photographs that a lag is read from
constexpr double kSmallest = 1e-4;
constexpr double kStill = 0.5;  // mean squared difference of thumbnails, grey levels: noise, no motion

using CameraScores = std::vector<const ViewScore*>;  // one a frame; null: none

std::map<std::string, CameraScores> byCamera(std::span<const ScoredFrame> frames) {
  std::map<std::string, CameraScores> cameras;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (const ViewScore& v : frames[f].views) {
      CameraScores& scores = cameras[v.camera];
      scores.resize(frames.size(), nullptr);
      scores[f] = &v;
    }
  }
  return cameras;
}

double meanSquaredDifference(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b) {
  if (a.pixels.size() != b.pixels.size() || a.empty()) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double d = static_cast<double>(a.pixels[i]) - b.pixels[i];
    sum += d * d;
  }
  return sum / static_cast<double>(a.pixels.size());
}

bool isBlack(const ViewScore& v, const DefectLimits& limits) {
  return v.photo_luma < limits.black_luma && v.render_luma > 3 * limits.black_luma;
}

class DefectFinder {
 public:
  DefectFinder(std::span<const ScoredFrame> frames, const DefectLimits& limits)
      : frames_(frames), limits_(limits), cameras_(byCamera(frames)) {
    for (std::size_t f = 0; f < frames.size(); ++f) at_.emplace(frames[f].index, f);
  }

  std::vector<Defect> find() {
    missing();
    for (const auto& [camera, scores] : cameras_) {
      black(camera, scores);
      frozen(camera, scores);
    }
    late();
    outliers(DefectKind::Blurred);
    outliers(DefectKind::Exposure);
    std::stable_sort(found_.begin(), found_.end(), [](const Defect& a, const Defect& b) {
      return std::pair(a.camera, a.kind) < std::pair(b.camera, b.kind);
    });
    return std::move(found_);
  }

 private:
  void add(DefectKind kind, const std::string& camera, const std::vector<std::size_t>& at, double figure,
           std::string text) {
    Defect d{kind, camera, {}, figure, std::move(text)};
    for (const std::size_t f : at) d.frames.push_back(frames_[f].name);
    addLoss(at, d);
    found_.push_back(std::move(d));
  }

  void addLoss(const std::vector<std::size_t>& at, Defect& d) const {
    double all = 0, others = 0, n = 0, n_others = 0;
    for (const std::size_t f : at) {
      for (const ViewScore& v : frames_[f].views) {
        if (v.held_out || (v.left_out && v.camera != d.camera)) continue;
        all += v.score.psnr, ++n;
        if (v.camera != d.camera) others += v.score.psnr, ++n_others;
      }
    }
    if (n_others == 0) return;
    d.psnr_with = all / n;
    d.psnr_without = others / n_others;
  }

  void missing() {
    std::map<std::string, std::vector<std::size_t>> gone;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      for (const std::string& camera : frames_[f].missing) gone[camera].push_back(f);
    }
    for (const auto& [camera, at] : gone) {
      add(DefectKind::Missing, camera, at, static_cast<double>(at.size()),
          fmt::format("has no readable picture in {} of {}; {} solved without it. Copy the missing pictures "
                      "from the camera, or leave it",
                      at.size(), countText(frames_.size(), "frame"),
                      nounText(at.size(), "the frame was", "the frames were")));
    }
  }

  void black(const std::string& camera, const CameraScores& scores) {
    std::vector<std::size_t> at;
    double luma = 0;
    for (std::size_t f = 0; f < scores.size(); ++f) {
      if (scores[f] && isBlack(*scores[f], limits_)) at.push_back(f), luma = scores[f]->photo_luma;
    }
    if (at.empty()) return;
    add(DefectKind::Black, camera, at, luma,
        fmt::format("is black in {} (mean luma {:.3f} where the render has more than {:.2f}). Remove "
                    "those pictures from the capture and run the frames again",
                    countText(at.size(), "frame"), luma, 3 * limits_.black_luma));
  }

  // The same picture twice while most other cameras saw something move.
  void frozen(const std::string& camera, const CameraScores& scores) {
    std::vector<std::size_t> at;
    for (std::size_t f = 1; f < scores.size(); ++f) {
      if (stoodStill(scores, f) != true || isBlack(*scores[f], limits_)) continue;
      std::size_t moved = 0, others = 0;
      for (const auto& [name, other] : cameras_) {
        const std::optional<bool> still = stoodStill(other, f);
        if (name == camera || !still) continue;
        ++others;
        moved += !*still;
      }
      if (others >= kFewestOthers && 2 * moved > others) at.push_back(f);
    }
    if (at.empty()) return;
    add(DefectKind::Frozen, camera, at, static_cast<double>(at.size()),
        fmt::format("repeats the picture before in {} while the others moved. Remove the repeated "
                    "pictures from the capture and run the frames again",
                    countText(at.size(), "frame")));
  }

  // Nothing: the frame before has no picture.
  std::optional<bool> stoodStill(const CameraScores& scores, std::size_t f) const {
    if (!scores[f] || !scores[f - 1] || frames_[f].index != frames_[f - 1].index + 1) return std::nullopt;
    const ViewScore &a = *scores[f - 1], &b = *scores[f];
    return a.photo_luma == b.photo_luma && a.photo_sharpness == b.photo_sharpness &&
           a.photo_thumb.pixels == b.photo_thumb.pixels;
  }

  // A photograph that says something of its moment: neither black nor a repetition; and its mean squared
  // difference to the render of that moment.
  struct Telling {
    std::size_t frame;
    double own;
  };
  std::vector<Telling> tellingOf(const CameraScores& scores) const {
    std::vector<Telling> telling;
    for (std::size_t f = 0; f < scores.size(); ++f) {
      if (!scores[f] || isBlack(*scores[f], limits_) || (f > 0 && stoodStill(scores, f) == true)) continue;
      telling.push_back({f, meanSquaredDifference(scores[f]->photo_thumb, scores[f]->render_thumb)});
    }
    return telling;
  }

  // Mean difference between the photographs and the renders `lag` frames before, and for the same photographs
  // at no lag; nothing where too few photographs have such a render: one alone tells that its own render is
  // poor, and a take of two frames has no more.
  std::optional<std::pair<double, double>> differences(const CameraScores& scores,
                                                       const std::vector<Telling>& telling, int lag) const {
    double lagged = 0, own = 0;
    int n = 0;
    for (const Telling& t : telling) {
      const auto other = at_.find(frames_[t.frame].index - lag);
      const ViewScore* there = other == at_.end() ? nullptr : scores[other->second];
      if (!there) continue;
      lagged += meanSquaredDifference(scores[t.frame]->photo_thumb, there->render_thumb);
      own += t.own;
      ++n;
    }
    if (n < kFewestLagged) return std::nullopt;
    return std::pair(lagged / n, own / n);
  }

  // By how many frames, and what the difference to the renders of that moment is of that to its own.
  struct Lag {
    int frames = 0;  // 0: none
    double share = 1;
  };
  Lag lagOf(const CameraScores& scores) const {
    Lag best{0, limits_.late_gain};
    const std::vector<Telling> telling = tellingOf(scores);
    for (int lag = -limits_.most_late; lag <= limits_.most_late; ++lag) {
      if (lag == 0) continue;
      const auto found = differences(scores, telling, lag);
      if (!found || found->second < kStill || found->first >= best.share * found->second) continue;
      best = {lag, found->first / found->second};
    }
    return best;
  }

  // Renders follow what most cameras saw: where most seem to be off, it is the renders that are.
  void late() {
    std::vector<std::pair<const std::string*, Lag>> accused;
    for (const auto& [camera, scores] : cameras_) {
      if (const Lag lag = lagOf(scores); lag.frames != 0) accused.emplace_back(&camera, lag);
    }
    if (2 * accused.size() > cameras_.size()) return;
    for (const auto& [camera, lag] : accused) addLate(*camera, cameras_.at(*camera), lag);
  }

  void addLate(const std::string& camera, const CameraScores& scores, const Lag& lag) {
    std::vector<std::size_t> at;
    for (std::size_t f = 0; f < scores.size(); ++f) {
      if (scores[f]) at.push_back(f);
    }
    // A camera that took part in the fit has drawn the renders towards its own moment.
    const bool fitted = std::any_of(
        at.begin(), at.end(), [&](std::size_t f) { return !scores[f]->held_out && !scores[f]->left_out; });
    add(DefectKind::Late, camera, at, lag.frames,
        fmt::format("is {}{} {}: its photographs differ {:.0f} % less from the renders of that moment "
                    "than from their own. {}",
                    fitted ? "at least " : "", countText(std::abs(lag.frames), "frame"),
                    lag.frames > 0 ? "late" : "early", 100 * (1 - lag.share),
                    fitted
                        ? "It took part in the fit, which hides a part: hold it out with --hold-out, which "
                          "also gives the whole number"
                        : "Shift its pictures by as many"));
  }

  // What a camera's photograph has of the render's sharpness or brightness, against the median camera.
  void outliers(DefectKind kind) {
    std::map<std::string, std::vector<std::pair<std::size_t, double>>> flagged;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      std::vector<std::pair<const ViewScore*, double>> shares;
      std::vector<double> values;
      for (const ViewScore& v : frames_[f].views) {
        if (isBlack(v, limits_)) continue;
        const double share = kind == DefectKind::Blurred
                                 ? v.photo_sharpness / std::max(kSmallest, v.render_sharpness)
                                 : v.photo_luma / std::max(kSmallest, v.render_luma);
        shares.emplace_back(&v, share);
        values.push_back(share);
      }
      if (shares.size() <= kFewestOthers) continue;
      const double usual = std::max(kSmallest, median(values));
      for (const auto& [view, share] : shares) {
        const double factor = share / usual;
        const bool out = kind == DefectKind::Blurred
                             ? factor < limits_.blurred_share
                             : std::max(factor, 1 / std::max(kSmallest, factor)) > limits_.exposure_factor;
        if (out) flagged[view->camera].emplace_back(f, factor);
      }
    }
    for (const auto& [camera, list] : flagged) addOutlier(kind, camera, list);
  }

  void addOutlier(DefectKind kind, const std::string& camera,
                  const std::vector<std::pair<std::size_t, double>>& list) {
    std::vector<std::size_t> at;
    std::vector<double> factors;
    for (const auto& [f, factor] : list) at.push_back(f), factors.push_back(factor);
    const double factor = median(factors);
    const std::string where = fmt::format("in {} of {}", at.size(), countText(frames_.size(), "frame"));
    add(kind, camera, at, factor,
        kind == DefectKind::Blurred
            ? fmt::format("is blurred {}: {:.0f} % of the sharpness that the other cameras have against the "
                          "render. Check its focus and exposure time; leave it out with --hold-out",
                          where, 100 * factor)
            : fmt::format("is exposed {:.2f} times as bright as the other cameras {}. Match its exposure in "
                          "the pictures; leave it out with --hold-out",
                          factor, where));
  }

  std::span<const ScoredFrame> frames_;
  const DefectLimits& limits_;
  std::map<std::string, CameraScores> cameras_;
  std::map<int, std::size_t> at_;  // of frames, by index in the capture
  std::vector<Defect> found_;
};

}  // namespace

const char* toText(DefectKind kind) {
  switch (kind) {
    case DefectKind::Missing:
      return "missing pictures";
    case DefectKind::Black:
      return "black";
    case DefectKind::Frozen:
      return "frozen";
    case DefectKind::Blurred:
      return "blurred";
    case DefectKind::Late:
      return "late";
    case DefectKind::Exposure:
      return "exposure";
  }
  return "";
}

std::vector<Defect> findDefects(std::span<const ScoredFrame> frames, const DefectLimits& limits) {
  return DefectFinder(frames, limits).find();
}

}  // namespace beam
