// SPDX-License-Identifier: Apache-2.0
// Takes out of a project what none of its settings refers to: results of settings that were tried and left,
// and what kills and failures leave behind.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/base/progress.h"
#include "core/pipeline/disk_use.h"
#include "core/pipeline/project.h"

namespace beam {

// What goes and what stays, each of it as it was found.
struct CleanPlan {
  DiskUse use;                   // others() go, inForce() stays
  std::vector<Digest> failures;  // notes of keys that are not in force; none while a stage is blocked
  std::vector<Digest> leases;    // files that nobody holds: their holders were killed
  // Of results that are there or that nobody wants any more; kept as failures are.
  std::vector<Digest> checkpoints;
  DiskAmount half_built;  // these, and folders of builders that were killed, of a clean that was as well
  DiskAmount set_aside;   // damaged results in quarantine/
  std::vector<std::filesystem::path> set_aside_folders;
  // What results that go were made of and the capture does not have now, in words: "the picture
  // cam00/000.png", "the camera cam05". Away for the moment, perhaps: `accept` decides.
  std::vector<std::string> gone;
  // By stage, the frames of which a step is pending whose last results go: what is drawn and exported now.
  std::map<std::string, std::vector<std::string>> unsolved;

  // Of the results that go, half-built folders and quarantine/; failures and leases are some bytes.
  std::uint64_t freedBytes() const;
};

// What cleanResults would remove now; writes nothing, takes no lock. Throws Error{Data} where it cannot be
// told what is in force, with what to do: the capture, its pictures or the panorama that was named are gone
// or cannot be read.
CleanPlan planClean(const Project& project, Progress& progress);

// May refuse a plan by throwing; nothing is removed then.
using AcceptPlan = std::function<void(const CleanPlan& plan)>;

// Removes it, by the settings and takes that are in project.json, whose lock it holds meanwhile so that
// nobody saves others; says what it removed. A result is first renamed out of sight under its own lease, then
// deleted: after a stop or a kill each is whole or gone, and the next time finishes. Throws as planClean
// does and what `accept` throws of the plan, which is asked when nothing can change it any more;
// Error{Locked} that names the holder while a lease is held, Error{Storage} for a project that cannot be
// written.
CleanPlan cleanResults(const std::filesystem::path& folder, std::shared_ptr<const PipelineSetup> setup,
                       Progress& progress, const AcceptPlan& accept = {});

}  // namespace beam
