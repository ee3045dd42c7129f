// SPDX-License-Identifier: Apache-2.0
// Takes: stretches of frames of which each builds on the frame before. A project keeps a list of them; where
// two claim the same frame, the later one in the list owns it. A frame in no take is a take of its own.
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
  // That many members at its head are there to build on and are frames of other takes: the overlap with the
  // segment before, so that no segment begins with a frame that was fitted alone.
  int lead = 0;
  // Set where the frame before its first had no result to build on: it was cut from the take that ends there,
  // or lost so many members of its lead. A run over all frames puts it back and tries again.
  bool cut = false;
  int lost_lead = 0;

  bool holds(FrameIndex frame) const;
  bool claims(FrameIndex frame) const { return holds(frame) && frame >= begin(); }
  int count() const { return (last.value - first.value) / step + 1; }
  // The first frame it claims.
  FrameIndex begin() const { return {first.value + lead * step}; }
  // The frame that a member builds on; none for the first.
  std::optional<FrameIndex> before(FrameIndex frame) const;
  std::vector<FrameIndex> frames() const;
  std::vector<FrameIndex> claimed() const;
  bool operator==(const Take&) const = default;
};

// As project.json keeps it: by the capture's own frame names.
struct SavedTake {
  std::string first, last;
  int step = 1, lead = 0;
  bool cut = false;
  int lost_lead = 0;
  bool operator==(const SavedTake&) const = default;
};

// `frames`: names of the capture. Takes of frames that it does not have are left out.
std::vector<Take> readTakes(const std::vector<SavedTake>& saved, const std::vector<std::string>& frames);
// In words, those that readTakes leaves out: "the take a to b is left out: the capture has no frame b".
std::vector<std::string> takesNotUnderstood(const std::vector<SavedTake>& saved,
                                            const std::vector<std::string>& frames);
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

// The same of one take, whoever owns the two.
std::optional<Between> betweenOf(const Take& take, FrameIndex frame);

// What a run that names frames asks for: each run of consecutive ones, of which every `every`-th is taken.
// `frames` ascend.
std::vector<Take> takesOfFrames(const std::vector<FrameIndex>& frames, int every);
// With a lead of `overlap` frames, as far as there are so many before; takes with strides stay without.
Take withLead(Take take, int overlap);
// The list with `wanted` as the owner of all it claims; earlier takes that it covers wholly are gone.
std::vector<Take> addTake(std::vector<Take> takes, const Take& wanted);
// The list in which what was cut off or lost is put back, as far as what it was cut from is there.
std::vector<Take> healed(std::vector<Take> takes);
// The list of a run over all `frames` frames, healed. Takes of one frame, with strides and inside of others
// are gone; frames in no take lengthen the take before them or make takes of their own, which claim no more
// than `segment_frames` (0: as many as they can) and have a lead of `overlap`.
std::vector<Take> joinTakes(std::vector<Take> takes, int frames, int segment_frames, int overlap);
// `earlier` with those of `before` that are not among `after`, the newest last; at most kMostEarlierTakes.
inline constexpr std::size_t kMostEarlierTakes = 256;
std::vector<Take> withEarlier(std::vector<Take> earlier, const std::vector<Take>& before,
                              const std::vector<Take>& after);
// The list in which `frame` begins anew what was `take`, cut off; what that claims before it stays a take.
std::vector<Take> splitTake(std::vector<Take> takes, const Take& take, FrameIndex frame);

}  // namespace beam
