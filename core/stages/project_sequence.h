// SPDX-License-Identifier: Apache-2.0
// The frames of a project as a sequence: a snapshot, which settings and takes that change afterwards do not
// reach.
#pragma once

#include <memory>

#include "core/pipeline/project.h"
#include "core/pipeline/take_survey.h"
#include "core/scene/gaussian_sequence.h"

namespace beam {

enum class Shows {
  Solved,  // results of the settings in force: for scores
  // Frames that a scout run left out, too, made from the solved ones beside them and kept nowhere: for
  // pictures and exports. The joints may start anew between two frames: then there is nothing.
  Between,
  // For viewers, which keep showing what was made with other settings, marked stale, until there is better:
  // materials in force; else the newest materials on the surface in force; else what Between gives; else the
  // newest of all. Of a project without its capture only the last.
  Newest,
};

// `survey`: what Newest knows of other settings, and its stamps; null: not known yet.
std::shared_ptr<const GaussianSequence> sequenceOf(const Project& project, Shows shows,
                                                   std::shared_ptr<const TakeSurvey> survey = nullptr);

// Whether Shows::Solved has Gaussians in any frame, as the survey knows it.
bool anySolved(const TakeSurvey& survey);

}  // namespace beam
