// SPDX-License-Identifier: Apache-2.0
// What the rail says of a stage: how far it is over all frames of the take, and the shown frame apart from
// that.
#pragma once

#include <QString>

#include <string>
#include <vector>

#include "core/pipeline/stage_registry.h"
#include "core/pipeline/take_survey.h"

namespace beam {

struct StageStatus {
  std::string id;
  QString title, summary;
  StepState state = StepState::Pending;  // of the shown frame
  bool stale = false;                    // the shown frame: to do, and there is a result of other settings
  bool open = true;                      // there is a take
  // Over the take. Frames that the stage is for, and how these stand; they add up.
  int frames = 0;
  int done = 0, stale_frames = 0, failed = 0, running = 0, interpolated = 0, blocked = 0, to_do = 0;
  QString detail = {};       // why it is blocked, or why the shown frame failed
  QString shown_name = {};   // of the shown frame; empty: the take has only that
  QString shown_words = {};  // "done", "stale: made with other settings", ...
};

// The one thing to be seen of a take; what asks for attention goes first.
enum class StageMark { Closed, Nothing, NotNeeded, Partly, Done, Stale, Running, Failed, Blocked };

std::vector<StageStatus> stageStatus(const TakeSurvey& survey, const std::vector<StageInfo>& infos,
                                     FrameIndex shown);
// Before anything is open: stages of which nothing is said.
std::vector<StageStatus> stagesWithoutTake(const std::vector<StageInfo>& infos);

StageMark markOf(const StageStatus& stage);
// "done", "2 of 3 done", "1 failed, 2 done", "2 stale of 3", "to do", "not needed"; empty: nothing is
// open.
QString stageWords(const StageStatus& stage);
// Summary, counts, the shown frame, what blocks; every line stands alone.
QString stageTip(const StageStatus& stage);

}  // namespace beam
