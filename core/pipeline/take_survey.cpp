// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/take_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kHexDigits = 32;

// Keys that name the entries of a folder, with or without an extension; anything else there is passed over.
std::set<Digest> keysIn(const fs::path& folder) {
  std::set<Digest> keys;
  std::error_code failed;
  for (fs::directory_iterator i(folder, failed), end; !failed && i != end; i.increment(failed)) {
    const std::string stem = i->path().stem().string();
    if (stem.size() != kHexDigits) continue;
    try {
      keys.insert(parseDigest(stem));
    } catch (const Error&) {
      continue;
    }
  }
  return keys;
}

bool followsFrames(const StageInfo& stage) {
  return std::any_of(stage.steps.begin(), stage.steps.end(),
                     [](const StepInfo& step) { return !step.later.previous.empty(); });
}

// Frames without results between two that have some, in the stages whose frames build on each other.
void markInterpolated(const Project& project, TakeSurvey& survey) {
  const std::vector<Take> takes = project.takes();
  const std::vector<Digest> own = survey.stamps;
  for (std::size_t f = 0; f < own.size(); ++f) {
    const auto between = betweenOf(takes, FrameIndex{static_cast<std::int32_t>(f)});
    if (!between) continue;
    const auto a = static_cast<std::size_t>(between->before.value),
               b = static_cast<std::size_t>(between->after.value);
    if (own[a] == Digest{} || own[b] == Digest{}) continue;
    survey.stamps[f] = digestOf("between " + own[f].hex() + own[a].hex() + own[b].hex());
    for (std::size_t i = 0; i < survey.lanes.size(); ++i) {
      std::vector<CellState>& cells = survey.lanes[i].cells;
      // Seen as a take of its own, a frame between is in no need of joints.
      const bool blank = cells[f] == CellState::Empty || cells[f] == CellState::NotNeeded;
      if (blank && cells[a] == CellState::Done && cells[b] == CellState::Done &&
          followsFrames(project.setup().stages.infos()[i]))
        cells[f] = CellState::Interpolated;
    }
  }
}

}  // namespace

const SurveyCurve* TakeSurvey::curve(std::string_view name) const {
  const auto found =
      std::find_if(curves.begin(), curves.end(), [&](const auto& c) { return c.name == name; });
  return found == curves.end() ? nullptr : &*found;
}

// What the folders say in this pass.
struct TakeSurveyor::Pass {
  const Project& project;
  std::set<Digest> results, failures, leases;
  std::set<std::pair<std::string, std::string>> made;  // step and frame that have a result of any key
  std::map<std::string, std::vector<double>> curves;

  CellState stateOf(const Digest& key, const std::map<Digest, Record>& records) const {
    if (results.contains(key)) {
      const auto record = records.find(key);
      if (record != records.end() && record->second.whole) return CellState::Done;
    }
    if (leases.contains(key) && project.store().isLeased(key)) return CellState::Running;
    return failures.contains(key) ? CellState::Failed : CellState::Empty;
  }
};

const TakeSurveyor::Keys& TakeSurveyor::keysOf(const Project& project, const std::string& step,
                                               bool per_frame) {
  const auto [entry, fresh] = keys_.try_emplace(step);
  if (!fresh) return entry->second;
  try {
    const int frames = per_frame ? static_cast<int>(project.capture().frames.size()) : 1;
    for (FrameIndex f{0}; f.value < frames; ++f.value) {
      entry->second.push_back(project.applies(step, f) ? std::optional(project.key(step, f)) : std::nullopt);
    }
  } catch (...) {
    keys_.erase(entry);
    throw;
  }
  return entry->second;
}

void TakeSurveyor::readRecords(const Project& project, Pass& pass) {
  std::erase_if(records_, [&](const auto& known) { return !pass.results.contains(known.first); });
  for (const Digest& key : pass.results) {
    auto known = records_.find(key);
    if (known == records_.end() || !known->second.whole) {
      const std::optional<ResultRecord> found = project.store().record(key);
      if (!found) continue;
      Record record{found->ingredients.step, found->frame, found->scores, project.store().has(key)};
      record.scores["seconds"] = found->seconds;
      known = records_.insert_or_assign(key, std::move(record)).first;
    }
    if (!leads_.contains(key)) pass.made.emplace(known->second.step, known->second.frame);
  }
}

void TakeSurveyor::keepLeadKeys(const Project& project) {
  leads_.clear();
  for (const Take& take : project.takes()) {
    for (FrameIndex f = take.first; f < take.begin(); f.value += take.step) {
      for (const StageInfo& info : project.setup().stages.infos()) {
        if (!project.blockedReason(info.id).empty()) continue;
        for (const StepInfo& step : info.steps) {
          if (step.per_frame && applies(step, take, f))
            leads_.insert(project.key(info.id + "." + step.id, take, f));
        }
      }
    }
  }
}

TakeSurvey TakeSurveyor::survey(const Project& project) {
  const std::string now = project.folder().string() + "\n" + toJson(project.document());
  if (now != known_for_) {
    keys_.clear();
    project.forgetKeys();
    keepLeadKeys(project);
    known_for_ = now;
  }
  const fs::path results = project.store().folderOf({}).parent_path();
  Pass pass{project,
            keysIn(results),
            keysIn(results.parent_path() / "failures"),
            keysIn(results.parent_path() / "leases"),
            {},
            {}};
  readRecords(project, pass);
  TakeSurvey survey;
  survey.frames = project.capture().frames;
  const std::size_t frames = survey.frames.size();
  std::vector<std::string> stamps(frames);
  for (const StageInfo& info : project.setup().stages.infos()) {
    SurveyLane lane{info.id, info.title, project.blockedReason(info.id), {}, {}};
    lane.cells.assign(frames, lane.blocked_reason.empty() ? CellState::NotNeeded : CellState::Blocked);
    lane.notes.resize(frames);
    for (const StepInfo& step : info.steps) {
      if (!lane.blocked_reason.empty()) break;
      const std::string id = info.id + "." + step.id;
      const Keys& keys = keysOf(project, id, step.per_frame);
      for (std::size_t f = 0; f < frames; ++f) {
        if (!keys[step.per_frame ? f : 0]) continue;
        const Digest& key = *keys[step.per_frame ? f : 0];
        const CellState state = pass.stateOf(key, records_);
        const bool stale = state == CellState::Empty &&
                           pass.made.contains({id, step.per_frame ? survey.frames[f] : std::string()});
        CellState& cell = lane.cells[f];
        const bool so_far_done = cell == CellState::Done || cell == CellState::NotNeeded;
        if (so_far_done) cell = stale ? CellState::Stale : state;
        if (cell == CellState::Empty && stale) cell = CellState::Stale;
        if (state == CellState::Failed && lane.notes[f].empty()) {
          const std::optional<FailureNote> note = project.store().failure(key);
          lane.notes[f] = note ? note->message : std::string();
        }
        if (state != CellState::Done || !step.per_frame) continue;
        stamps[f] += key.hex();
        for (const auto& [name, value] : records_.at(key).scores) {
          auto& curve = pass.curves[fmt::format("{}.{}", id, name)];
          curve.resize(frames, std::numeric_limits<double>::quiet_NaN());
          curve[f] = value;
        }
      }
    }
    survey.lanes.push_back(std::move(lane));
  }
  for (const std::string& stamp : stamps) survey.stamps.push_back(stamp.empty() ? Digest{} : digestOf(stamp));
  markInterpolated(project, survey);
  for (auto& [name, values] : pass.curves) survey.curves.push_back({name, std::move(values)});
  return survey;
}

}  // namespace beam
