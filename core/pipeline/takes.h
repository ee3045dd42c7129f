// SPDX-License-Identifier: Apache-2.0
// Takes: stretches of frames of which each builds on the frame before. A project keeps a list of them; where
// two hold the same frame, the later one in the list owns it. A frame in no take is a take of its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/ids.h"

namespace beam {

// Every `step`-th frame from first to last, both of them members.
struct Take {
  FrameIndex first, last;
  int step = 1;

  bool holds(FrameIndex frame) const;
  int count() const { return (last.value - first.value) / step + 1; }
  // The frame that a member builds on; none for the first.
  std::optional<FrameIndex> before(FrameIndex frame) const;
  std::vector<FrameIndex> frames() const;
  bool operator==(const Take&) const = default;
};

// As project.json keeps it: by the capture's own frame names.
struct SavedTake {
  std::string first, last;
  int step = 1;
  bool operator==(const SavedTake&) const = default;
};

// `frames`: names of the capture. Takes of frames that it does not have are left out.
std::vector<Take> readTakes(const std::vector<SavedTake>& saved, const std::vector<std::string>& frames);
std::vector<SavedTake> saveTakes(const std::vector<Take>& takes, const std::vector<std::string>& frames);

// The take that owns `frame`.
Take takeOf(const std::vector<Take>& takes, FrameIndex frame);

// Where a frame stands between two members of a take with a stride: `share` of the way from one to the next.
struct Between {
  FrameIndex before, after;
  double share = 0;
  bool operator==(const Between&) const = default;
};
// Of the latest such take that owns both; none where `frame` stands in none.
std::optional<Between> betweenOf(const std::vector<Take>& takes, FrameIndex frame);

// What a run that names frames asks for: each run of consecutive ones, of which every `every`-th is taken.
// `frames` ascend.
std::vector<Take> takesOfFrames(const std::vector<FrameIndex>& frames, int every);
// The list with `wanted` as the owner of all its frames; earlier takes that it covers wholly are gone.
std::vector<Take> addTake(std::vector<Take> takes, const Take& wanted);
// The list of a run over all `frames` frames. Takes of one frame, with strides and inside of others are gone;
// frames in no take lengthen the take before them or make takes of their own, which get no longer than
// `segment_frames` (0: as long as they can).
std::vector<Take> joinTakes(std::vector<Take> takes, int frames, int segment_frames);
// The list in which `frame` is the first of its take; what stands before it in its take stays a take.
std::vector<Take> splitTake(std::vector<Take> takes, FrameIndex frame);

}  // namespace beam
