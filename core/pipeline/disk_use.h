// SPDX-License-Identifier: Apache-2.0
// What the results of a project take on the disk, by stage: those that its settings refer to, and the others.
// `beam status` tells it, `beam clean` removes the others: there is one way to count.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/base/progress.h"
#include "core/pipeline/project.h"

namespace beam {

struct DiskAmount {
  std::int64_t count = 0;
  std::uint64_t bytes = 0;  // of the files; those that a copy of the project shares (hard links) count, too

  void add(std::uint64_t more) {
    ++count;
    bytes += more;
  }
  bool operator==(const DiskAmount&) const = default;
};

struct ResultUse {
  Digest key;
  std::string stage;        // empty: its record cannot be read
  std::string step, frame;  // of the record; a lead of a take has no frame here, for it is nobody's own
  std::uint64_t bytes = 0;
  bool in_force = false;
};

struct StageUse {
  std::string stage, title;  // no stage: results whose record cannot be read
  DiskAmount in_force, others;
  std::string blocked_reason;  // Project::blockedReason: all of its results count as in force
};

struct DiskUse {
  std::vector<ResultUse> results;       // finished and damaged ones, by key
  std::vector<StageUse> stages;         // in pipeline order, then what this program has no stage for
  std::set<Digest> keys_in_force;       // whether there is a result or not; none of blocked stages
  std::uint64_t checkpoints = 0;        // bytes of work that was cut off, from which it goes on
  std::vector<std::string> unreadable;  // pictures that are there and cannot be read; keys say so

  DiskAmount inForce() const;
  DiskAmount others() const;
};

// In force are the keys of all steps for each frame in the take that owns it and, of what later frames read,
// in takes that only build on it (leads, members that another take claims), and those of earlier takes. Looks
// enter no key. Further what
// results in force were made from, and all results of blocked stages with what these were made from: nothing
// tells which of them a panorama would bring back. Reads every picture of the capture once a process, for its
// digest, and of results the records alone. Throws what Project::capture does, Cancelled.
DiskUse diskUse(const Project& project, Progress& progress);

// Of all files below a folder; 0 when there is none.
std::uint64_t bytesBelow(const std::filesystem::path& folder);

// "12 kB", "3.4 MB", "210 MB", "1.2 GB" of 1000 MB; "0 kB" of nothing alone.
std::string sizeText(std::uint64_t bytes);

}  // namespace beam
