// SPDX-License-Identifier: Apache-2.0
#include "core/work/evaluate_over_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/ply_file.h"
#include "core/method/evaluate_motion.h"
#include "core/render/deferred.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

std::optional<TrueSkin> readTracks(const fs::path& file, const Similarity3& world_from_capture) {
  if (!fs::exists(file)) return std::nullopt;
  const std::vector<PlyElement> elements = readPly(file);
  const PlyElement* vertex = findElement(elements, "vertex");
  std::vector<std::size_t> columns;
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    const auto column = vertex ? vertex->column(name) : std::nullopt;
    if (!column) {
      throw Error(Error::Kind::Data, fmt::format("\"{}\": expected vertices with x y z nx ny nz, found no {}",
                                                 file.string(), name));
    }
    columns.push_back(*column);
  }
  TrueSkin skin;
  for (std::size_t i = 0; i < vertex->count; ++i) {
    const float* row = vertex->row(i);
    const dvec3 p(row[columns[0]], row[columns[1]], row[columns[2]]);
    const dvec3 n(row[columns[3]], row[columns[4]], row[columns[5]]);
    skin.position_m.emplace_back(world_from_capture * p);
    skin.normal.emplace_back(world_from_capture.rotation * n);
  }
  return skin;
}

// A frame with what its successor is compared to.
struct Moment {
  FrameIndex frame;
  std::shared_ptr<const GaussianFrame> result;
  std::optional<TrueSkin> skin;
  std::vector<SeenPoints> views;  // of the test cameras; only with a skin
};

class MotionScorer {
 public:
  MotionScorer(const GaussianSequence& sequence, const std::vector<View>& test_views,
               const GroundTruth* truth, ComputeDevice& device, const Progress& progress, PictureScores& each)
      : sequence_(sequence),
        truth_(truth),
        device_(device),
        progress_(progress),
        renderer_(device),
        each_(each) {
    for (const View& view : test_views) cameras_.push_back(view.camera);
  }

  void frame(FrameIndex index) {
    std::optional<Moment> now = momentOf(index);
    if (!now) return before_.reset();
    const bool follows = before_ && before_->frame.value + 1 == index.value;
    const bool tracked = follows && isTracked(before_->result->cloud, now->result->cloud);
    progress_.check();
    if (!tracked) startTake(*now);
    progress_.check();
    if (follows && sameSkin(before_->skin, *now)) alongPoints(*now);
    if (tracked) alongGaussians(*now);
    before_ = std::move(now);
  }

 private:
  std::optional<Moment> momentOf(FrameIndex index) {
    std::shared_ptr<const GaussianFrame> result = sequence_.load(index);
    if (!result) return std::nullopt;
    Moment m{index, std::move(result), std::nullopt, {}};
    progress_.check();
    if (!truth_) return m;
    m.skin = readTracks(truth_->folder / "gt/tracks" / (name(index) + ".ply"),
                        inverse(truth_->truth_from_capture * sequence_.captureFromWorld()));
    if (!m.skin) return m;
    const auto resident = residentOf(device_, *m.result);
    for (const Camera& camera : cameras_) {
      progress_.check();
      m.views.push_back(seenPoints(renderer_.render(*resident, camera), camera, *m.skin));
    }
    return m;
  }

  bool sameSkin(const std::optional<TrueSkin>& before, const Moment& now) {
    if (!before || !now.skin) return false;
    const std::size_t a = before->position_m.size(), b = now.skin->position_m.size();
    if (a != b && !std::exchange(warned_, true)) {
      logWarning(
          "the true tracks have {} points in frame {} and {} before it: expected the same in all "
          "frames; drift and flicker between such frames are left out",
          b, name(now.frame), a);
    }
    return a == b;
  }

  void startTake(const Moment& m) {
    first_ = m.result->cloud;
    first_skin_ = m.skin;
    nearest_.clear();
    if (m.skin) nearest_ = nearestPoints(first_, *m.skin);
  }

  void alongGaussians(const Moment& now) {
    Scores& s = scores(now);
    s["flicker.gaussian_radiance"] = radianceFlicker(before_->result->cloud, now.result->cloud);
    const auto &a = before_->result->materials, &b = now.result->materials;
    if (a && b) s["flicker.gaussian_base_color"] = baseColorFlicker(before_->result->cloud, *a, *b);
    if (nearest_.empty() || !sameSkin(first_skin_, now)) return;
    const Spread drift = drift_mm(first_, now.result->cloud, *first_skin_, *now.skin, nearest_);
    s["drift.median_mm"] = drift.median;
    s["drift.p95_mm"] = drift.p95;
  }

  void alongPoints(const Moment& now) {
    ViewFlicker sum;
    double n = 0;
    for (std::size_t v = 0; v < cameras_.size(); ++v) {
      const auto f = viewFlicker(before_->views[v], now.views[v]);
      if (!f) continue;
      sum.radiance += f->radiance, sum.base_color += f->base_color, ++n;
    }
    if (n == 0) return;
    scores(now)["flicker.radiance"] = sum.radiance / n;
    if (before_->result->materials && now.result->materials)
      scores(now)["flicker.base_color"] = sum.base_color / n;
  }

  const std::string& name(FrameIndex f) const { return nameOf(sequence_, f); }
  Scores& scores(const Moment& m) { return each_[name(m.frame)][""]; }

  const GaussianSequence& sequence_;
  const GroundTruth* truth_;
  ComputeDevice& device_;
  const Progress& progress_;
  GBufferRenderer renderer_;
  PictureScores& each_;
  std::vector<Camera> cameras_;
  std::optional<Moment> before_;
  GaussianCloud first_;
  std::optional<TrueSkin> first_skin_;
  std::vector<std::uint32_t> nearest_;
  bool warned_ = false;  // of tracks that do not match
};

}  // namespace

void scoreMotion(const GaussianSequence& sequence, const std::vector<View>& test_views,
                 const std::vector<FrameIndex>& frames, const GroundTruth* truth, ComputeDevice& device,
                 Progress& progress, PictureScores& each) {
  progress.expect(static_cast<std::int64_t>(frames.size()));
  MotionScorer scorer(sequence, test_views, truth, device, progress, each);
  for (const FrameIndex frame : frames) {
    scorer.frame(frame);
    progress.step();
  }
}

ScoreTable motionTable(const PictureScores& each) {
  ScoreTable table;
  for (const std::string row : {"drift", "flicker"}) {
    std::map<std::string, Scores> by_frame;
    for (const auto& [frame, cameras] : each) {
      const auto whole = cameras.find("");
      if (whole == cameras.end()) continue;
      for (const auto& [name, value] : whole->second) {
        if (name.starts_with(row + ".")) by_frame[frame][name.substr(row.size() + 1)] = value;
      }
    }
    if (!by_frame.empty()) table.emplace_back(row, meanOfCameras(by_frame));
  }
  return table;
}

}  // namespace beam
