// SPDX-License-Identifier: Apache-2.0
// The size and place of a capture's subject, in whatever unit the capture came: from a coarse hull of the
// masks of one frame. Reads some pictures and is bounded in time and memory whatever the unit.
#pragma once

#include <optional>

#include "core/scene/capture.h"
#include "core/scene/rig_focus.h"

namespace beam {

struct SubjectBox {
  dvec3 low, high;
};

// How the seed points lie to the masks. Shares are of the points that two cameras see.
struct SeedFit {
  double share = 0;   // inside all masks that see them
  double factor = 1;  // about the capture's origin; not 1: only then do they fit
};

struct SubjectMeasure {
  std::optional<SubjectBox> subject;  // none without masks, or where they leave no body or are inverted
  std::optional<RigFocus> focus;      // of the training cameras
  std::optional<SeedFit> seeds;       // none without a hull or points
  // White all along the borders and black inside, in most of the pictures: the background was painted.
  bool masks_look_inverted = false;
};

// Of the first frame in which two training cameras have masks; a picture that cannot be read is passed over.
// The capture's +Y is up, its unit may be any.
SubjectMeasure measureSubject(const CaptureSet& capture);

}  // namespace beam
