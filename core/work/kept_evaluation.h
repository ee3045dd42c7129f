// SPDX-License-Identifier: Apache-2.0
// What the last evaluation left in a project, and whether it is of the results that are looked at now.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/pipeline/project.h"
#include "core/scene/gaussian_sequence.h"
#include "core/scene/lighting.h"
#include "core/work/scores.h"

namespace beam {

// GaussianSequence::stamp of each of the frames, by name, as text: another where a frame was solved anew or
// further, or where it is relit in another way than is usual.
ScoredResults resultsOf(const GaussianSequence& sequence, const std::vector<FrameIndex>& frames,
                        const Lighting& lighting);

struct KeptEvaluation {
  ScoreTable table;                      // means; empty: there is none
  std::map<std::string, Scores> frames;  // by name, means over the cameras
  ScoredResults results;                 // that were scored; empty: written before they were kept
};

// Empty where `beam evaluate` never ran; a file that cannot be understood is left out with a warning.
KeptEvaluation keptEvaluation(const Project& project);

// Whether what was scored of a frame is what `shown` has of it.
bool isOf(const KeptEvaluation& evaluation, const ScoredResults& shown, const std::string& frame);

// A sentence that says of which frames other results were scored than those shown; empty: of none, or there
// is no evaluation.
std::string otherResultsText(const KeptEvaluation& evaluation, const ScoredResults& shown);

}  // namespace beam
