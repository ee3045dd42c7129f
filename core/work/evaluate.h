// SPDX-License-Identifier: Apache-2.0
// Scores of a project's solved frames: against a data set's ground truth, or of the held-out photographs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/pipeline/project.h"
#include "core/render/device.h"
#include "core/scene/capture.h"
#include "core/work/scores.h"

namespace beam {

// Whether a held-out camera has a photograph of any frame: there is something to score without ground truth.
bool hasHeldOutPhotographs(const CaptureSet& capture);

struct EvaluateRequest {
  Project project;
  std::string frames = "all";  // of selectSolvedFrames
  // Folder of a data set with dataset.json and gt/; empty: photographs of held-out cameras, at full size.
  std::filesystem::path ground_truth;
  // Folder of renderChannels whose pictures, of `frames` that need not be solved, are scored against the
  // ground truth; empty: new ones are drawn.
  std::filesystem::path pictures;
  bool strict = false;  // of WantedResults
};

struct EvaluateOutcome {
  ScoreTable table;    // means
  PictureScores each;  // every picture's and frame's own
  ScoreOrigin origin = {};
};

// Writes nothing. Throws, before anything is drawn, Error{Usage} for words that choose nothing and pictures
// without ground truth, Error{Data} when a frame is not solved, there is no held-out photograph, or the
// ground truth is none or not of this project's cameras and frames; Cancelled.
EvaluateOutcome evaluate(const EvaluateRequest& request, ComputeDevice& device, Progress& progress);

// kEvaluationFile and kEvaluationFramesFile in the project's folder; nothing where it is read-only, and
// nothing of pictures that were not drawn from the project. Throws Error{Storage}.
void keepEvaluation(const Project& project, const EvaluateOutcome& outcome);

}  // namespace beam
