// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/clean_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/io/image_file.h"
#include "core/pipeline/input_digests.h"
#include "core/pipeline/project_document.h"
#include "core/pipeline/stage_registry.h"

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
    const std::vector<std::string> odd =
        takesNotUnderstood(project.document().takes, project.capture().frames);
    if (!odd.empty()) throw Error(Error::Kind::Data, fmt::format("{}", fmt::join(odd, "; ")));
  } catch (const Error& gone) {
    if (gone.kind() != Error::Kind::Data) throw;
    throw untold(gone.what());
  }
}

void requireReadable(const std::vector<std::string>& unreadable) {
  if (unreadable.empty()) return;
  const std::string more =
      unreadable.size() == 1 ? std::string() : fmt::format(" and {} more", unreadable.size() - 1);
  throw untold(fmt::format(
      "the picture \"{}\"{} is there and cannot be read; make it readable, or take it out of the capture",
      unreadable.front(), more));
}

// Of one capture: what results were made of and it does not have.
class GoneInputs {
 public:
  explicit GoneInputs(const Project& project) : project_(project), folder_(project.captureFolder()) {
    for (const View& view : project.capture().views) views_.insert(view.name);
    points_ = !project.capture().seed_points.position_m.empty();
    if (const std::string other = project.captureChange(); !other.empty())
      gone_.insert(fmt::format("the description of the capture as it was ({})", other));
  }

  void add(const ResultRecord& record) {
    for (const auto& [picture, digest] : record.pictures) {
      if (views_.contains(picture)) continue;  // a capture without files
      if (!isThere(picture))
        gone_.insert(fmt::format("the picture {}", picture));
      else if (digestNow(picture) != digest && !isWhole(picture))
        gone_.insert(fmt::format("the picture {} as it was (it is damaged)", picture));
    }
    const StepShown shown = shownOf(project_.setup().stages, record.ingredients.step);
    if (!shown.cameras_file.empty()) addCameras(project_.store().folderOf(record.key) / shown.cameras_file);
  }

  std::vector<std::string> words() const { return {gone_.begin(), gone_.end()}; }

 private:
  void addCameras(const fs::path& file) {
    try {
      const std::string text = readTextFile(file);
      for (const View& view : viewsOfCalibration(text))
        if (!views_.contains(view.name)) gone_.insert(fmt::format("the camera {}", view.name));
      if (!points_ && seedPointsOfCalibration(text) > 0) gone_.insert("the seed points");
    } catch (const Error& e) {
      requireData(e);  // a damaged result tells nothing
    }
  }

  bool isThere(const std::string& picture) {
    const auto [known, is_new] = there_.emplace(picture, false);
    std::error_code out_of_reach;
    if (is_new) known->second = fs::is_regular_file(folder_ / picture, out_of_reach);
    return known->second;
  }

  // Half copied, it is damaged for the moment.
  bool isWhole(const std::string& picture) {
    const auto [known, is_new] = whole_.emplace(picture, true);
    if (!is_new) return known->second;
    try {
      checkImageFile(folder_ / picture);
    } catch (const Error& e) {
      requireData(e);
      known->second = false;
    }
    return known->second;
  }

  std::string digestNow(const std::string& picture) const {
    try {
      return project_.inputs().file(folder_ / picture).hex();
    } catch (const Error& e) {
      requireData(e);
      return {};
    }
  }

  const Project& project_;
  fs::path folder_;
  std::set<std::string> views_, gone_;
  std::map<std::string, bool> there_, whole_;
  bool points_ = false;
};

std::vector<std::string> goneOf(const Project& project, const DiskUse& use, const Progress& progress) {
  if (use.others().count == 0) return {};
  GoneInputs gone(project);
  for (const ResultUse& result : use.results) {
    if (result.in_force) continue;
    progress.check();
    if (const std::optional<ResultRecord> record = project.store().record(result.key)) gone.add(*record);
  }
  return gone.words();
}

std::map<std::string, std::vector<std::string>> unsolvedBy(const Project& project, const DiskUse& use) {
  std::set<std::pair<std::string, std::string>> stay, go;
  for (const ResultUse& r : use.results)
    if (!r.step.empty()) (r.in_force ? stay : go).emplace(r.step, r.frame);
  std::map<std::string, std::set<std::string>> by_stage;
  const std::vector<std::string>& frames = project.capture().frames;
  for (const StageInfo& info : project.setup().stages.infos()) {
    for (const StepInfo& step : info.steps) {
      const StepId id(info.id, step.id);
      for (std::int32_t f = 0; step.per_frame && f < static_cast<std::int32_t>(frames.size()); ++f) {
        const std::string& name = frames[static_cast<std::size_t>(f)];
        const std::pair place(id.text(), name);
        if (go.contains(place) && !stay.contains(place) && project.applies(id, FrameIndex{f}))
          by_stage[info.id].insert(name);
      }
    }
  }
  std::map<std::string, std::vector<std::string>> unsolved;
  for (const auto& [stage, names] : by_stage) unsolved[stage].assign(names.begin(), names.end());
  return unsolved;
}

// A run that stands between two steps holds none for a moment: what it then misses, it says.
void requireIdle(const Project& project) {
  const ResultStore& store = project.store();
  for (const Digest& key : store.leases()) {
    if (!store.isLeased(key)) continue;
    throw Error(
        Error::Kind::Locked,
        fmt::format(
            "\"{}\" is being worked on: {} computes a result of it; wait until it is done, then clean again",
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

void removeCheckpoints(const ResultStore& store, const CleanPlan& plan, const Progress& progress) {
  for (const Digest& key : plan.checkpoints) {
    progress.check();
    if (const std::optional<FileLock> lease = store.tryLease(key)) store.clearCheckpoint(key);
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
  removeCheckpoints(project.store(), plan, rest);
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
  plan.unsolved = unsolvedBy(project, plan.use);
  plan.gone = goneOf(project, plan.use, progress);
  const ResultStore& store = project.store();
  const bool all_told = std::all_of(plan.use.stages.begin(), plan.use.stages.end(),
                                    [](const StageUse& stage) { return stage.blocked_reason.empty(); });
  const auto unwanted = [&](const Digest& key) { return all_told && !plan.use.keys_in_force.contains(key); };
  for (const Digest& key : store.failures()) {
    if (unwanted(key)) plan.failures.push_back(key);
  }
  for (const Digest& key : store.leases()) {
    if (!store.isLeased(key)) plan.leases.push_back(key);
  }
  std::vector<fs::path> half_built = store.stale();
  for (const Digest& key : store.checkpoints()) {
    if (store.isLeased(key) || !(unwanted(key) || store.has(key))) continue;
    plan.checkpoints.push_back(key);
    half_built.push_back(store.checkpointOf(key));
  }
  plan.half_built = amountOf(half_built, progress);
  plan.set_aside_folders = store.setAside();
  plan.set_aside = amountOf(plan.set_aside_folders, progress);
  return plan;
}

CleanPlan cleanResults(const fs::path& folder, std::shared_ptr<const PipelineSetup> setup, Progress& progress,
                       const AcceptPlan& accept) {
  Project project = Project::open(folder, setup);
  if (project.readOnly()) {
    throw Error(
        Error::Kind::Storage,
        fmt::format("\"{}\" is read-only: nothing can be removed from it; make the folder writable first",
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
