// SPDX-License-Identifier: Apache-2.0
// The files of track.joints besides joints.ply.
#pragma once

#include <filesystem>

#include "core/scene/pose.h"

namespace beam {

struct TrackNote {
  bool restarted = false;  // the joints were fitted anew in this frame
  double reference_residual =
      0;  // of the frame after the last start: what a restart is judged by; 0: not yet
};

void writeTrackNote(const std::filesystem::path& folder, const TrackNote& note);
TrackNote readTrackNote(const std::filesystem::path& folder);

}  // namespace beam
