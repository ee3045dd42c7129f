// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/take_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/io/file.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kHexDigits = 32;

// Keys that name the entries of a folder, with or without an extension; anything else there is passed over.
std::set<Digest> keysIn(const fs::path& folder) {
  std::set<Digest> keys;
  for (const fs::directory_entry& entry : entriesOf(folder)) {
    const std::string stem = entry.path().stem().string();
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

Digest surfaceOf(const StepShown& shown, const KeyIngredients& made, const Digest& key) {
  if (made.step == shown.surface) return key;
  const auto surface = made.upstream.find(shown.surface);
  return surface == made.upstream.end() ? Digest{} : surface->second;
}

std::int64_t nanoseconds(const std::optional<fs::file_time_type>& time) {
  return time ? std::chrono::nanoseconds(time->time_since_epoch()).count() : 0;
}

std::string textOf(const Leftovers& leftovers) {
  std::string text;
  for (const Leftover& l : leftovers) text += " left " + l.key.hex();
  return text;
}

// Frames without results between two that have some, in the stages whose frames build on each other. `own`:
// stamps of the results of the settings in force.
void markInterpolated(const Project& project, const std::vector<Digest>& own, TakeSurvey& survey) {
  const std::vector<Take> takes = project.takes();
  for (std::size_t f = 0; f < own.size(); ++f) {
    const auto between = betweenOf(takes, FrameIndex{static_cast<std::int32_t>(f)});
    if (!between) continue;
    const auto a = static_cast<std::size_t>(between->before.value),
               b = static_cast<std::size_t>(between->after.value);
    if (own[a] == Digest{} || own[b] == Digest{}) continue;
    survey.stamps[f] = digestOf("between " + survey.stamps[f].hex() + own[a].hex() + own[b].hex());
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
  std::set<std::pair<StepId, std::string>> made;  // step and frame that have a result of any key
  std::map<std::string, std::vector<double>> curves;
  std::vector<std::string> stamps;  // by frame: keys of what is done
  std::set<std::size_t> complete;   // frames that have the last there is to show

  void draw(const StepId& step, const std::map<std::string, double>& scores, std::size_t frame) {
    for (const auto& [name, value] : scores) {
      auto& curve = curves[fmt::format("{}.{}", step.text(), name)];
      curve.resize(stamps.size(), std::numeric_limits<double>::quiet_NaN());
      curve[frame] = value;
    }
  }
  CellState stateOf(const Digest& key, const std::map<Digest, Record>& records) const {
    if (results.contains(key)) {
      const auto record = records.find(key);
      if (record != records.end() && record->second.whole) return CellState::Done;
    }
    if (leases.contains(key) && project.store().isLeased(key)) return CellState::Running;
    return failures.contains(key) ? CellState::Failed : CellState::Empty;
  }
};

const TakeSurveyor::Keys& TakeSurveyor::keysOf(const Project& project, const StepId& step, bool per_frame) {
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
      const StepShown shown = shownOf(project.setup().stages, found->ingredients.step);
      Record record{found->ingredients.step,
                    found->frame,
                    found->scores,
                    project.store().has(key),
                    found->lead,
                    shown.frame,
                    surfaceOf(shown, found->ingredients, key),
                    nanoseconds(project.store().publishedAt(key))};
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
            leads_.insert(project.key(StepId(info.id, step.id), take, f));
        }
      }
    }
  }
}

void TakeSurveyor::keepEarlierKeys(const Project& project) {
  earlier_.clear();
  std::vector<Take> takes = project.earlierTakes();
  const std::vector<Take> now = project.takes();
  takes.insert(takes.end(), now.begin(), now.end());
  const auto addKeys = [&](const StageInfo& info, const Take& take, FrameIndex f, std::vector<Digest>& keys) {
    if (!project.blockedReason(info.id).empty()) return;
    for (const StepInfo& step : info.steps)
      if (step.per_frame && applies(step, take, f))
        keys.push_back(project.key(StepId(info.id, step.id), take, f));
  };
  for (std::size_t f = 0; f < project.capture().frames.size(); ++f) {
    for (auto take = takes.rbegin(); take != takes.rend(); ++take) {
      const auto between = betweenOf(*take, FrameIndex{static_cast<std::int32_t>(f)});
      const auto holds = [&](FrameIndex member) { return project.takeOf(member) == *take; };
      if (!between || (holds(between->before) && holds(between->after))) continue;
      EarlierPair pair{f, {}};
      for (const StageInfo& info : project.setup().stages.infos()) {
        std::vector<Digest>& keys = pair.keys.emplace_back();
        addKeys(info, *take, between->before, keys);
        addKeys(info, *take, between->after, keys);
      }
      earlier_.push_back(std::move(pair));
    }
  }
}

// As markInterpolated, of frames that the takes of now have nothing of yet.
void TakeSurveyor::markEarlier(const Pass& pass, TakeSurvey& survey) const {
  const auto isWhole = [&](const Digest& key) {
    const auto record = records_.find(key);
    return pass.results.contains(key) && record != records_.end() && record->second.whole;
  };
  for (const EarlierPair& pair : earlier_) {
    if (!pass.stamps[pair.frame].empty()) continue;
    std::string stamp;
    for (std::size_t i = 0; i < survey.lanes.size(); ++i) {
      const std::vector<Digest>& keys = pair.keys[i];
      CellState& cell = survey.lanes[i].cells[pair.frame];
      const bool follows = followsFrames(pass.project.setup().stages.infos()[i]);
      const bool blank = cell == CellState::Empty || cell == CellState::NotNeeded;
      if (!follows || !blank || keys.empty() || !std::all_of(keys.begin(), keys.end(), isWhole)) continue;
      cell = CellState::Interpolated;
      for (const Digest& key : keys) stamp += key.hex();
    }
    if (!stamp.empty())
      survey.stamps[pair.frame] = digestOf("between " + survey.stamps[pair.frame].hex() + stamp);
  }
}

// What was made as a lead comes last: the frame may have taken it over since, which no record tells.
void TakeSurveyor::listLeftovers(const Pass& pass, TakeSurvey& survey) const {
  using Age = std::pair<bool, std::int64_t>;
  std::map<std::string, std::vector<std::pair<Age, Leftover>>> found;
  for (const Digest& key : pass.results) {
    const auto known = records_.find(key);
    if (known == records_.end()) continue;
    const Record& r = known->second;
    if (r.whole && r.shown && !leads_.contains(key))
      found[r.frame].emplace_back(Age(!r.lead, r.published_ns), Leftover{r.step, key, r.surface});
  }
  survey.leftovers.resize(survey.frames.size());
  for (std::size_t f = 0; f < survey.frames.size(); ++f) {
    auto& dated = found[survey.frames[f]];
    std::stable_sort(dated.begin(), dated.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (auto& [age, leftover] : dated) survey.leftovers[f].push_back(std::move(leftover));
  }
}

void TakeSurveyor::surveyStep(const StepId& id, const StepInfo& step, Pass& pass, TakeSurvey& survey) {
  const Keys& keys = keysOf(pass.project, id, step.per_frame);
  SurveyLane& lane = survey.lanes.back();
  for (std::size_t f = 0; f < survey.frames.size(); ++f) {
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
      const std::optional<FailureNote> note = pass.project.store().failure(key);
      lane.notes[f] = note ? note->message : std::string();
    }
    if (state != CellState::Done || !step.per_frame) continue;
    pass.stamps[f] += key.hex();
    if (step.shown.last) pass.complete.insert(f);
    pass.draw(id, records_.at(key).scores, f);
  }
}

// What can be said of results without the keys of the settings in force.
void TakeSurveyor::surveyRecords(Pass& pass, TakeSurvey& survey) const {
  std::map<std::pair<StepId, std::string>, const Record*> newest;
  for (const Digest& key : pass.results) {
    const auto known = records_.find(key);
    if (known == records_.end() || !known->second.whole) continue;
    const Record& r = known->second;
    const Record*& best = newest[{r.step, r.frame}];
    if (best == nullptr || std::pair(!best->lead, best->published_ns) < std::pair(!r.lead, r.published_ns))
      best = &r;
  }
  for (const StageInfo& info : pass.project.setup().stages.infos()) {
    SurveyLane lane{info.id, info.title, pass.project.blockedReason(info.id), {}, {}};
    lane.cells.assign(survey.frames.size(), CellState::Empty);
    lane.notes.resize(survey.frames.size());
    for (const StepInfo& step : info.steps) {
      const StepId id(info.id, step.id);
      for (std::size_t f = 0; f < survey.frames.size(); ++f) {
        const auto made = newest.find({id, step.per_frame ? survey.frames[f] : std::string()});
        if (made == newest.end()) continue;
        lane.cells[f] = CellState::Stale;
        if (step.per_frame) pass.draw(id, made->second->scores, f);
      }
    }
    survey.lanes.push_back(std::move(lane));
  }
}

void TakeSurveyor::surveyStages(Pass& pass, TakeSurvey& survey) {
  for (const StageInfo& info : pass.project.setup().stages.infos()) {
    survey.lanes.push_back({info.id, info.title, pass.project.blockedReason(info.id), {}, {}});
    SurveyLane& lane = survey.lanes.back();
    const bool blocked = !lane.blocked_reason.empty();
    lane.cells.assign(survey.frames.size(), blocked ? CellState::Blocked : CellState::NotNeeded);
    lane.notes.resize(survey.frames.size());
    for (const StepInfo& step : info.steps) {
      if (!blocked) surveyStep(StepId(info.id, step.id), step, pass, survey);
    }
  }
}

TakeSurvey TakeSurveyor::survey(const Project& project) {
  const std::string now = fmt::format("{}\n{}\n{}", project.folder().string(), project.withoutCapture(),
                                      toJson(withoutLooks(project.document())));
  if (now != known_for_) {
    keys_.clear();
    leads_.clear();
    earlier_.clear();
    project.forgetKeys();
    if (!project.withoutCapture()) keepLeadKeys(project);
    if (!project.withoutCapture()) keepEarlierKeys(project);
    known_for_ = now;
  }
  const fs::path results = project.store().folderOf({}).parent_path();
  Pass pass{project,
            keysIn(results),
            keysIn(results.parent_path() / "failures"),
            keysIn(results.parent_path() / "leases"),
            {},
            {},
            {},
            {}};
  readRecords(project, pass);
  TakeSurvey survey;
  survey.frames = project.capture().frames;
  pass.stamps.resize(survey.frames.size());
  listLeftovers(pass, survey);
  project.withoutCapture() ? surveyRecords(pass, survey) : surveyStages(pass, survey);
  std::vector<Digest> own;
  for (std::size_t f = 0; f < survey.frames.size(); ++f) {
    const auto stampOf = [](const std::string& text) { return text.empty() ? Digest{} : digestOf(text); };
    own.push_back(stampOf(pass.stamps[f]));
    const bool settled = pass.complete.contains(f);
    survey.stamps.push_back(settled ? own[f] : stampOf(pass.stamps[f] + textOf(survey.leftovers[f])));
  }
  markInterpolated(project, own, survey);
  markEarlier(pass, survey);
  for (auto& [name, values] : pass.curves) survey.curves.push_back({name, std::move(values)});
  return survey;
}

}  // namespace beam
