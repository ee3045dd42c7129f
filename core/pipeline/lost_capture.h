// SPDX-License-Identifier: Apache-2.0
// What a project's results tell of a capture that is gone: enough to look at them, never to make a key from.
#pragma once

#include <string_view>

#include "core/io/capture_reader.h"

namespace beam {

class Project;

// Frames that have results, in natural order of their names; cameras and panorama as the newest import saw
// them; no pictures. `layout` says "results".
ImportedCapture captureFromResults(const Project& project);

// "frame_9" before "frame_10": runs of digits compare as numbers, the rest by character.
bool naturallyBefore(std::string_view a, std::string_view b);

}  // namespace beam
