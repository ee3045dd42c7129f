// SPDX-License-Identifier: Apache-2.0
#include "ui/stage_status.h"

#include <QStringList>

#include <algorithm>

#include "ui/words.h"

namespace beam {
namespace {

StepState stateOf(CellState cell) {
  switch (cell) {
    case CellState::Done:
      return StepState::Done;
    case CellState::Running:
      return StepState::Running;
    case CellState::Failed:
      return StepState::Failed;
    case CellState::Blocked:
      return StepState::Blocked;
    case CellState::NotNeeded:
      return StepState::NotNeeded;
    case CellState::Empty:
    case CellState::Stale:
    case CellState::Interpolated:
      break;
  }
  return StepState::Pending;
}

QString cellWords(CellState cell) {
  switch (cell) {
    case CellState::Empty:
      return "to do";
    case CellState::Running:
      return "being computed by another process";
    case CellState::Done:
      return "done";
    case CellState::Stale:
      return "stale: its result was made with other settings";
    case CellState::Failed:
      return "failed";
    case CellState::Blocked:
      return "cannot run";
    case CellState::Interpolated:
      return "interpolated between solved frames of a scout run";
    case CellState::NotNeeded:
      return "not needed";
  }
  return {};
}

void showFrame(StageStatus& status, const TakeSurvey& survey, const SurveyLane& lane, FrameIndex shown) {
  const auto f = static_cast<std::size_t>(shown.value);
  if (f >= lane.cells.size()) return;
  status.state = stateOf(lane.cells[f]);
  status.stale = lane.cells[f] == CellState::Stale;
  status.shown_words = cellWords(lane.cells[f]);
  if (lane.cells.size() > 1) status.shown_name = QString::fromStdString(survey.frames[f]);
  if (!lane.notes[f].empty()) status.detail = QString::fromStdString(lane.notes[f]);
}

}  // namespace

std::vector<StageStatus> stageStatus(const TakeSurvey& survey, const std::vector<StageInfo>& infos,
                                     FrameIndex shown) {
  std::vector<StageStatus> all;
  for (std::size_t i = 0; i < survey.lanes.size(); ++i) {
    const SurveyLane& lane = survey.lanes[i];
    const auto count = [&](CellState state) {
      return static_cast<int>(std::count(lane.cells.begin(), lane.cells.end(), state));
    };
    StageStatus status{.id = lane.stage,
                       .title = QString::fromStdString(lane.title),
                       .summary = QString::fromStdString(infos[i].summary),
                       .frames = static_cast<int>(lane.cells.size()) - count(CellState::NotNeeded),
                       .done = count(CellState::Done),
                       .stale_frames = count(CellState::Stale),
                       .failed = count(CellState::Failed),
                       .running = count(CellState::Running),
                       .interpolated = count(CellState::Interpolated),
                       .blocked = count(CellState::Blocked),
                       .to_do = count(CellState::Empty),
                       .detail = QString::fromStdString(lane.blocked_reason)};
    showFrame(status, survey, lane, shown);
    status.detail = withStepTitles(infos, status.detail);
    all.push_back(std::move(status));
  }
  return all;
}

std::vector<StageStatus> stagesWithoutTake(const std::vector<StageInfo>& infos) {
  std::vector<StageStatus> all;
  for (const StageInfo& info : infos) {
    all.push_back({.id = info.id,
                   .title = QString::fromStdString(info.title),
                   .summary = QString::fromStdString(info.summary),
                   .open = false});
  }
  return all;
}

StageMark markOf(const StageStatus& stage) {
  if (!stage.open) return StageMark::Closed;
  if (stage.failed > 0) return StageMark::Failed;
  if (stage.running > 0) return StageMark::Running;
  if (stage.stale_frames > 0) return StageMark::Stale;
  if (stage.blocked > 0) return StageMark::Blocked;
  if (stage.done > 0 && stage.done == stage.frames) return StageMark::Done;
  if (stage.done > 0) return StageMark::Partly;
  return stage.frames == 0 ? StageMark::NotNeeded : StageMark::Nothing;
}

QString stageWords(const StageStatus& stage) {
  const auto share = [&](int n, const QString& what) {
    if (stage.frames == 1) return what;
    return n == stage.frames ? "all " + what : QString("%1 %2").arg(numberText(n), what);
  };
  switch (markOf(stage)) {
    case StageMark::Failed:
      if (stage.done > 0)
        return share(stage.failed, "failed") + QString(", %1 done").arg(numberText(stage.done));
      return stage.failed == stage.frames
                 ? share(stage.failed, "failed")
                 : QString("%1 failed of %2").arg(numberText(stage.failed), numberText(stage.frames));
    case StageMark::Running:
      return "running elsewhere";
    case StageMark::Stale:
      return stage.stale_frames == stage.frames
                 ? share(stage.stale_frames, "stale")
                 : QString("%1 stale of %2").arg(numberText(stage.stale_frames), numberText(stage.frames));
    case StageMark::Blocked:
      return "needs a panorama";
    case StageMark::Done:
      return "done";
    case StageMark::Partly:
      return QString("%1 of %2 done").arg(numberText(stage.done), numberText(stage.frames));
    case StageMark::NotNeeded:
      return "not needed";
    case StageMark::Closed:
      return {};
    case StageMark::Nothing:
      break;
  }
  return "to do";
}

QString stageTip(const StageStatus& stage) {
  QStringList lines{stage.title};
  if (!stage.summary.isEmpty()) lines << stage.summary;
  if (stage.frames > 1) {
    QStringList counts;
    const auto add = [&](int n, const char* what) {
      if (n > 0) counts << numberText(n) + " " + what;
    };
    add(stage.done, "done");
    add(stage.failed, "failed");
    add(stage.running, "being computed by another process");
    add(stage.stale_frames, "stale (made with other settings)");
    add(stage.interpolated, "interpolated");
    add(stage.blocked, "blocked");
    add(stage.to_do, "to do");
    lines << "Of " + countText(stage.frames, "frame") + ": " + counts.join(", ");
  } else if (markOf(stage) == StageMark::NotNeeded) {
    lines << "Not needed: it is for frames that belong to a take of two and more, and none does.";
  }
  if (!stage.shown_words.isEmpty())
    lines << (stage.shown_name.isEmpty() ? "This frame: " : "Frame " + stage.shown_name + ", in view: ") +
                 stage.shown_words;
  if (!stage.detail.isEmpty()) lines << stage.detail;
  return lines.join("\n");
}

}  // namespace beam
