// SPDX-License-Identifier: Apache-2.0
#include "core/work/quality_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/stages/score_files.h"
#include "core/stages/screening_file.h"
#include "core/stages/step_ids.h"

namespace beam {
namespace {

class Collector {
 public:
  Collector(const Project& project, const Progress& progress) : project_(project), progress_(progress) {
    for (const std::string& w : project.imported().warnings) warn(w);
  }

  QualityHistory collect() {
    for (const StageInfo& stage : project_.setup().stages.infos()) {
      if (!project_.blockedReason(stage.id).empty()) continue;
      for (const StepInfo& step : stage.steps) {
        (step.per_frame ? frame_steps_ : project_steps_).emplace_back(stage.id, step.id);
      }
    }
    for (const StepId& step : project_steps_) {
      if (const auto record = project_.record(step, FrameIndex{})) count(*record);
    }
    for (std::size_t f = 0; f < project_.capture().frames.size(); ++f) {
      progress_.check();
      FrameQuality q = frame(FrameIndex{static_cast<std::int32_t>(f)});
      if (!q.seconds.empty() || !q.failures.empty()) history_.frames.push_back(std::move(q));
    }
    const std::vector<ScoredFrame> frames = scored();
    history_.defects = findDefects(frames);
    history_.left_out = leftOutCameras(project_, progress_);
    history_.loss = lossOf(frames);
    return std::move(history_);
  }

 private:
  void warn(const std::string& text) {
    if (told_.insert(text).second) history_.warnings.push_back(text);
  }

  void count(const ResultRecord& record) {
    history_.seconds += record.seconds;
    history_.peak_memory_bytes =
        std::max(history_.peak_memory_bytes, static_cast<double>(record.peak_memory_bytes));
    for (const std::string& w : record.warnings) warn(w);
  }

  FrameQuality frame(FrameIndex index) {
    FrameQuality q{index, project_.capture().frames[static_cast<std::size_t>(index.value)], {}, {}, {}, {}};
    for (const StepId& step : frame_steps_) {
      if (const auto record = project_.record(step, index)) {
        count(*record);
        q.seconds[step] = record->seconds;
        for (const auto& [name, value] : record->scores)
          q.scores[fmt::format("{}.{}", step.text(), name)] = value;
      } else if (std::string failure = project_.failureOf(step, index); !failure.empty()) {
        q.failures[step] = std::move(failure);
      }
    }
    if (q.seconds.contains(kScoreStep)) q.views = views(index);
    return q;
  }

  std::vector<ViewScore> views(FrameIndex index) const {
    try {
      if (const auto folder = project_.result(kScoreStep, index)) return readScores(*folder);
    } catch (const Error& e) {
      requireData(e);
      logWarning("{}; the frame is shown without its views", e.what());
    }
    return {};
  }

  // Test cameras of a data set have their photographs in its ground truth alone: they are not missing.
  bool hasPictures(ViewIndex view) const {
    for (std::size_t f = 0; f < project_.capture().frames.size(); ++f) {
      if (project_.capture().source->has(view, FrameIndex{static_cast<std::int32_t>(f)})) return true;
    }
    return false;
  }

  // Refers to the views of history_. A camera with pictures that was not scored had no readable one: nothing
  // else leaves it out.
  std::vector<ScoredFrame> scored() const {
    std::vector<const View*> expected;
    for (std::size_t v = 0; v < project_.capture().views.size(); ++v) {
      if (hasPictures(ViewIndex{static_cast<std::int32_t>(v)}))
        expected.push_back(&project_.capture().views[v]);
    }
    std::vector<ScoredFrame> frames;
    for (const FrameQuality& q : history_.frames) {
      if (q.views.empty()) continue;
      ScoredFrame s{q.name, q.frame.value, q.views, {}, 0};
      for (const View* view : expected) {
        const bool there = std::any_of(q.views.begin(), q.views.end(),
                                       [&](const ViewScore& v) { return v.camera == view->name; });
        if (there) continue;
        s.missing.push_back(view->name);
        s.missing_training += view->split == Split::Train;
      }
      frames.push_back(std::move(s));
    }
    return frames;
  }

  const Project& project_;
  const Progress& progress_;
  QualityHistory history_;
  std::vector<StepId> project_steps_, frame_steps_;
  std::set<std::string> told_;
};

}  // namespace

QualityHistory qualityHistory(const Project& project, const Progress& progress) {
  return Collector(project, progress).collect();
}

std::vector<LeftOutCamera> leftOutCameras(const Project& project, const Progress& progress) {
  std::vector<ScreenedFrame> frames;
  if (!project.setup().stages.has(kScreenStep)) return {};
  for (std::size_t f = 0; f < project.capture().frames.size(); ++f) {
    progress.check();
    const auto index = static_cast<std::int32_t>(f);
    try {
      if (const auto folder = project.result(kScreenStep, FrameIndex{index}))
        frames.push_back({project.capture().frames[f], index, readScreening(*folder).left_out});
    } catch (const Error& e) {
      requireData(e);
      logWarning("{}; what the frame was fitted without is not known", e.what());
    }
  }
  return collectLeftOut(frames);
}

std::vector<ScoreCurve> curvesOf(const QualityHistory& history) {
  std::map<std::string, ScoreCurve> curves;
  for (std::size_t f = 0; f < history.frames.size(); ++f) {
    for (const auto& [name, value] : history.frames[f].scores) {
      curves[name].name = name;
      curves[name].points.emplace_back(f, value);
    }
  }
  std::vector<ScoreCurve> list;
  list.reserve(curves.size());
  for (auto& [name, curve] : curves) list.push_back(std::move(curve));
  return list;
}

std::vector<std::size_t> worstFrames(const QualityHistory& history, std::size_t count) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t f = 0; f < history.frames.size(); ++f) {
    const SplitScore train = meanOf(history.frames[f].views, false);
    if (train.n > 0) order.emplace_back(train.mean.psnr, f);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> worst;
  for (std::size_t i = 0; i < std::min(count, order.size()); ++i) worst.push_back(order[i].second);
  return worst;
}

}  // namespace beam
