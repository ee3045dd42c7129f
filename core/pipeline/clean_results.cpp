// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/clean_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/pipeline/project_document.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

Error untold(const std::string& why) {
  return Error(Error::Kind::Data,
               fmt::format("what of the results is in force cannot be told, so none is removed: {}", why));
}

// What is away for the moment would make every result that needs it one of other settings.
void requireInputs(const Project& project) {
  try {
    project.requireCapture();
    project.capture();
    project.environmentFile();
  } catch (const Error& gone) {
    if (gone.kind() != Error::Kind::Data) throw;
    throw untold(gone.what());
  }
}

void requireReadable(const std::vector<std::string>& unreadable) {
  if (unreadable.empty()) return;
  const std::string more =
      unreadable.size() == 1 ? std::string() : fmt::format(" and {} more", unreadable.size() - 1);
  throw untold(
      fmt::format("the picture \"{}\"{} is there and cannot be read; make it readable, or take it "
                  "out of the capture",
                  unreadable.front(), more));
}

// A run that stands between two steps holds none for a moment: what it then misses, it says.
void requireIdle(const Project& project) {
  const ResultStore& store = project.store();
  for (const Digest& key : store.leases()) {
    if (!store.isLeased(key)) continue;
    throw Error(Error::Kind::Locked,
                fmt::format("\"{}\" is being worked on: {} computes a result of it; wait until it is done, "
                            "then clean again",
                            project.folder().string(), store.leaseHolder(key)));
  }
}

DiskAmount amountOf(const std::vector<fs::path>& folders, const Progress& progress) {
  DiskAmount sum;
  for (const fs::path& folder : folders) {
    progress.check();
    sum.add(bytesBelow(folder));
  }
  return sum;
}

// Out of sight, one after the other, each under its own lease.
void discardOthers(const Project& project, const CleanPlan& plan, Progress& progress) {
  progress.expect(plan.use.others().count, "results");
  for (const ResultUse& result : plan.use.results) {
    if (result.in_force) continue;
    requireIdle(project);
    const std::optional<FileLock> lease = project.store().tryLease(result.key);
    if (!lease) continue;  // somebody has just begun to compute it: it is wanted
    std::error_code failed;
    if (fs::exists(project.store().folderOf(result.key), failed)) project.store().discard(result.key);
    progress.step();
  }
}

void removeSetAside(const CleanPlan& plan, Progress& progress) {
  progress.expect(static_cast<std::int64_t>(plan.set_aside_folders.size()), "damaged results");
  for (const fs::path& folder : plan.set_aside_folders) {
    progress.step();
    fs::remove_all(folder);
  }
}

void removeNotes(const ResultStore& store, const CleanPlan& plan) {
  for (const Digest& key : plan.failures) store.clearFailure(key);
  for (const Digest& key : plan.leases) {
    if (store.isLeased(key)) continue;
    store.tryLease(key);  // its file goes with it
  }
}

void carryOut(const Project& project, const CleanPlan& plan, Progress& progress) {
  Progress discarding = progress.part(0.05, "putting results aside");
  discardOthers(project, plan, discarding);
  Progress removing = progress.part(0.35, "removing results");
  project.store().removeStale(removing);
  Progress rest = progress.part(0.1, "removing damaged results");
  removeSetAside(plan, rest);
  removeNotes(project.store(), plan);
}

}  // namespace

std::uint64_t CleanPlan::freedBytes() const {
  return use.others().bytes + half_built.bytes + set_aside.bytes;
}

CleanPlan planClean(const Project& project, Progress& progress) {
  requireInputs(project);
  CleanPlan plan;
  plan.use = diskUse(project, progress);
  requireReadable(plan.use.unreadable);
  const ResultStore& store = project.store();
  const bool all_told = std::all_of(plan.use.stages.begin(), plan.use.stages.end(),
                                    [](const StageUse& stage) { return stage.blocked_reason.empty(); });
  for (const Digest& key : store.failures()) {
    if (all_told && !plan.use.keys_in_force.contains(key)) plan.failures.push_back(key);
  }
  for (const Digest& key : store.leases()) {
    if (!store.isLeased(key)) plan.leases.push_back(key);
  }
  plan.half_built = amountOf(store.stale(), progress);
  plan.set_aside_folders = store.setAside();
  plan.set_aside = amountOf(plan.set_aside_folders, progress);
  return plan;
}

CleanPlan cleanResults(const fs::path& folder, std::shared_ptr<const PipelineSetup> setup, Progress& progress,
                       const AcceptPlan& accept) {
  Project project = Project::open(folder, setup);
  if (project.readOnly()) {
    throw Error(Error::Kind::Storage,
                fmt::format("\"{}\" is read-only: nothing can be removed from it; make the folder writable "
                            "first",
                            folder.string()));
  }
  requireIdle(project);
  // Photographs are looked at before the lock is taken, which keeps others from starting.
  Progress planning = progress.part(0.5, "");
  CleanPlan plan = planClean(project, planning);
  const FileLock lock = lockProject(folder);
  requireIdle(project);
  if (Project now = Project::open(folder, setup); toJson(now.document()) != toJson(project.document())) {
    project = std::move(now);
    Progress once_more = progress.part(0, "");
    plan = planClean(project, once_more);
  }
  if (accept) accept(plan);
  carryOut(project, plan, progress);
  return plan;
}

}  // namespace beam
