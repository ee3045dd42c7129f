// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/disk_use.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/io/file.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

// Into the digests that keys are made of (InputDigests remembers them), so that a stop need not wait for all
// pictures of a frame.
void readPictures(const Project& project, DiskUse& use, Progress& progress) {
  const CaptureSet& capture = project.capture();
  progress.expect(static_cast<std::int64_t>(capture.views.size() * capture.frames.size()), "photographs");
  for (FrameIndex f{0}; f.value < static_cast<std::int32_t>(capture.frames.size()); ++f.value) {
    for (ViewIndex v{0}; v.value < static_cast<std::int32_t>(capture.views.size()); ++v.value) {
      progress.step();
      if (!capture.source->has(v, f)) continue;
      for (const std::string& file : capture.source->files(v, f)) {
        std::error_code out_of_reach;
        if (!fs::exists(file, out_of_reach) && !out_of_reach) continue;  // for keys it was never there
        try {
          project.inputs().file(file);
        } catch (const Error& e) {
          requireData(e);
          use.unreadable.push_back(file);
        }
      }
    }
  }
}

class KeysInForce {
 public:
  KeysInForce(const Project& project, std::set<Digest>& keys, Progress& progress)
      : project_(project), stages_(project.setup().stages), keys_(keys), progress_(progress) {
    for (const StageInfo& info : stages_.infos()) {
      if (!project.blockedReason(info.id).empty()) continue;
      for (const StepInfo& step : info.steps) steps_.emplace_back(info.id, step.id);
    }
  }

  void collect() {
    const std::set<StepId> read_later = stages_.readBefore({steps_.begin(), steps_.end()});
    const std::vector<Take> takes = project_.takes();
    const auto frames = static_cast<std::int32_t>(project_.capture().frames.size());
    progress_.expect(frames + static_cast<std::int64_t>(takes.size()), "frames");
    for (const StepId& id : steps_) {
      if (!stages_.step(id).per_frame) keys_.insert(project_.key(id, FrameIndex{}));
    }
    for (FrameIndex f{0}; f.value < frames; ++f.value) {
      for (const StepId& id : steps_) add(id, project_.takeOf(f), f);
      progress_.step();
    }
    for (const Take& take : takes) {
      addWhatOthersClaim(take, read_later);
      progress_.step();
    }
    // What is looked at until the takes of now are as far.
    for (const Take& take : project_.earlierTakes()) {
      for (const FrameIndex f : take.frames()) {
        progress_.check();
        for (const StepId& id : steps_)
          if (take.claims(f) || read_later.contains(id)) add(id, take, f);
      }
    }
  }

 private:
  // Of members that the take does not own, as far as it owns a later one.
  void addWhatOthersClaim(const Take& take, const std::set<StepId>& read_later) {
    const std::vector<FrameIndex> members = take.frames();
    const auto owned = [&](FrameIndex f) { return project_.takeOf(f) == take; };
    const auto behind_last = std::find_if(members.rbegin(), members.rend(), owned).base();
    for (auto f = members.begin(); f != behind_last; ++f) {
      progress_.check();
      if (owned(*f)) continue;
      for (const StepId& id : steps_) {
        if (read_later.contains(id)) add(id, take, *f);
      }
    }
    for (const FrameIndex f : take.claimed()) {
      progress_.check();
      if (owned(f) || !isLookedAt(take, f)) continue;
      for (const StepId& id : steps_) add(id, take, f);
    }
  }

  // Its owner has less of it, or frames beside it are shown between it and another.
  bool isLookedAt(const Take& take, FrameIndex frame) const {
    for (FrameIndex f{frame.value - take.step + 1}; f.value < frame.value + take.step; ++f.value)
      if (f.value >= 0 && project_.hasMore(take, f)) return true;
    return false;
  }

  void add(const StepId& id, const Take& take, FrameIndex frame) {
    const StepInfo& step = stages_.step(id);
    if (step.per_frame && applies(step, take, frame)) keys_.insert(project_.key(id, take, frame));
  }

  const Project& project_;
  const StageRegistry& stages_;
  std::set<Digest>& keys_;
  Progress& progress_;
  std::vector<StepId> steps_;  // of stages that can run, in order
};

struct Found {
  ResultUse use;
  std::vector<Digest> made_from;
};

std::map<Digest, Found> readRecords(const ResultStore& store, Progress& progress) {
  std::map<Digest, Found> found;
  const std::vector<Digest> keys = store.keys();
  progress.expect(static_cast<std::int64_t>(keys.size()), "results");
  for (const Digest& key : keys) {
    Found result;
    result.use.key = key;
    result.use.bytes = bytesBelow(store.folderOf(key));
    if (const std::optional<ResultRecord> record = store.record(key)) {
      result.use.stage = record->ingredients.step.stage();
      result.use.step = record->ingredients.step.text();
      if (!record->lead) result.use.frame = record->frame;
      for (const auto& [name, read] : namedResults(record->ingredients)) result.made_from.push_back(read);
    }
    found.emplace(key, std::move(result));
    progress.step();
  }
  return found;
}

// Those in force, those of `blocked` stages, and all that these were made from.
void markInForce(std::map<Digest, Found>& found, const std::set<Digest>& keys,
                 const std::set<std::string>& blocked) {
  std::vector<Digest> todo;
  for (const auto& [key, result] : found) {
    if (keys.contains(key) || blocked.contains(result.use.stage)) todo.push_back(key);
  }
  while (!todo.empty()) {
    const auto result = found.find(todo.back());
    todo.pop_back();
    if (result == found.end() || std::exchange(result->second.use.in_force, true)) continue;
    const std::vector<Digest>& more = result->second.made_from;
    todo.insert(todo.end(), more.begin(), more.end());
  }
}

std::vector<StageUse> stagesOf(const Project& project) {
  std::vector<StageUse> stages;
  for (const StageInfo& info : project.setup().stages.infos()) {
    if (!info.steps.empty()) stages.push_back({info.id, info.title, {}, {}, project.blockedReason(info.id)});
  }
  return stages;
}

void sumUp(DiskUse& use) {
  for (const ResultUse& result : use.results) {
    auto stage = std::find_if(use.stages.begin(), use.stages.end(),
                              [&](const StageUse& s) { return s.stage == result.stage; });
    if (stage == use.stages.end()) {
      const std::string title = result.stage.empty() ? "not readable" : result.stage;
      stage = use.stages.insert(use.stages.end(), {result.stage, title, {}, {}, {}});
    }
    (result.in_force ? stage->in_force : stage->others).add(result.bytes);
  }
}

DiskAmount sumOf(const std::vector<StageUse>& stages, DiskAmount StageUse::*part) {
  DiskAmount sum;
  for (const StageUse& stage : stages) {
    sum.count += (stage.*part).count;
    sum.bytes += (stage.*part).bytes;
  }
  return sum;
}

}  // namespace

DiskAmount DiskUse::inForce() const { return sumOf(stages, &StageUse::in_force); }
DiskAmount DiskUse::others() const { return sumOf(stages, &StageUse::others); }

DiskUse diskUse(const Project& project, Progress& progress) {
  DiskUse use;
  use.checkpoints = bytesBelow(project.folder() / "checkpoints");
  Progress pictures = progress.part(0.7, "looking at the photographs");
  readPictures(project, use, pictures);
  Progress keys = progress.part(0.1, "looking for results in force");
  KeysInForce(project, use.keys_in_force, keys).collect();
  Progress records = progress.part(0.2, "looking at results");
  std::map<Digest, Found> found = readRecords(project.store(), records);
  use.stages = stagesOf(project);
  std::set<std::string> blocked;
  for (const StageUse& stage : use.stages) {
    if (!stage.blocked_reason.empty()) blocked.insert(stage.stage);
  }
  markInForce(found, use.keys_in_force, blocked);
  for (auto& [key, result] : found) use.results.push_back(std::move(result.use));
  sumUp(use);
  return use;
}

std::uint64_t bytesBelow(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const fs::directory_entry& entry : entriesBelow(folder)) {
    std::error_code gone;
    const bool is_file = entry.symlink_status(gone).type() == fs::file_type::regular;
    const std::uint64_t size = is_file ? entry.file_size(gone) : 0;
    if (!gone) bytes += size;
  }
  return bytes;
}

std::string sizeText(std::uint64_t bytes) {
  constexpr double kKilo = 1e3, kMega = 1e6, kGiga = 1e9;
  const auto size = static_cast<double>(bytes);
  if (size >= 0.9995 * kGiga) return fmt::format("{:.1f} GB", size / kGiga);
  if (size >= 99.95 * kMega) return fmt::format("{:.0f} MB", size / kMega);
  if (size >= 0.9995 * kMega) return fmt::format("{:.1f} MB", size / kMega);
  return fmt::format("{:.0f} kB", std::max(size / kKilo, bytes > 0 ? 1.0 : 0.0));
}

}  // namespace beam
