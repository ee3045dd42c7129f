// SPDX-License-Identifier: Apache-2.0
// Before a scout run: every which frame, and what that will take.
#pragma once

#include <QString>

#include <optional>

#include "core/pipeline/take_survey.h"

class QWidget;

namespace beam {

inline constexpr int kScoutEvery = 10;

struct ScoutPlan {
  int frames = 0;              // of the range
  double seconds_a_frame = 0;  // of what was solved so far; 0: nothing was
  QString preset;
};

// Mean over the frames that have results with the settings in force; 0: there are none.
double secondsAFrame(const TakeSurvey& survey);
// How many frames are solved, how long that will take, what happens to the others.
QString scoutText(const ScoutPlan& plan, int every);
// None: the person thought better of it.
std::optional<int> askScout(QWidget* parent, const ScoutPlan& plan, int every);

}  // namespace beam
