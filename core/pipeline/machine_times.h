// SPDX-License-Identifier: Apache-2.0
// How long steps took on this machine, in any project, kept for this user: a hint for people, which may be
// lost.
#pragma once

#include <filesystem>

#include "core/pipeline/step_times.h"

namespace beam {

// $XDG_STATE_HOME/beam-studio/step-times.json, else under ~/.local/state; empty: there is no home.
std::filesystem::path machineTimesFile();

// What was kept; nothing where it is gone or cannot be read.
StepTimes readMachineTimes();

// Replaces what was kept. What hinders it is told to the log at debug level.
void keepMachineTimes(const StepTimes& times);

}  // namespace beam
