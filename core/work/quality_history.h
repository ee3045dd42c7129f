// SPDX-License-Identifier: Apache-2.0
// What a project's records say of its frames over time: every score of every step, the views' scores, time,
// memory and warnings. Reads results, computes nothing.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/method/find_defects.h"
#include "core/method/left_out.h"
#include "core/pipeline/project.h"

namespace beam {

struct FrameQuality {
  FrameIndex frame;
  std::string name;
  std::map<std::string, double> scores;  // by full name: "surface.score.psnr_train"
  std::map<StepId, double> seconds;
  std::map<StepId, std::string> failures;
  std::vector<ViewScore> views;  // empty: not scored
};

struct QualityHistory {
  std::vector<FrameQuality> frames;   // with at least one result or failure, in order
  std::vector<std::string> warnings;  // of the capture and of the records, each once
  std::vector<Defect> defects;
  std::vector<LeftOutCamera> left_out;  // of the fit, by capture.screen
  LeftOutLoss loss;
  double seconds = 0;  // of all results, the project's own too
  double peak_memory_bytes = 0;
};

QualityHistory qualityHistory(const Project& project, const Progress& progress = Progress());
// Cameras that the frames screened so far go without; a screening that cannot be read is left out with a
// warning.
std::vector<LeftOutCamera> leftOutCameras(const Project& project, const Progress& progress = Progress());

// Scores of several frames, by name, in order of frames.
struct ScoreCurve {
  std::string name;
  std::vector<std::pair<std::size_t, double>> points;  // index in history.frames, value
};
std::vector<ScoreCurve> curvesOf(const QualityHistory& history);
// Frames by mean psnr of the training views, worst first; at most `count`. Frames without scores are left
// out.
std::vector<std::size_t> worstFrames(const QualityHistory& history, std::size_t count);

}  // namespace beam
