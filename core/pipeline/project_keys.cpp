// SPDX-License-Identifier: Apache-2.0
// Project: takes, keys, and the states that follow from them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "core/base/error.h"
#include "core/pipeline/project.h"
#include "core/pipeline/project_history.h"

namespace beam {
namespace fs = std::filesystem;
// --- Takes ---

std::vector<Take> Project::takes() const { return readTakes(document_.takes, capture().frames); }

std::vector<Take> Project::earlierTakes() const {
  return readTakes(document_.earlier_takes, capture().frames);
}

Take Project::takeOf(FrameIndex frame) const {
  std::vector<Take>& owners = memo_.owners;
  if (owners.empty()) {
    for (std::int32_t f = 0; f < static_cast<std::int32_t>(capture().frames.size()); ++f)
      owners.push_back({{f}, {f}, 1});
    for (const Take& take : takes()) {
      for (const FrameIndex f : take.claimed()) owners[static_cast<std::size_t>(f.value)] = take;
    }
  }
  const bool known = frame.value >= 0 && frame.value < static_cast<int>(owners.size());
  return known ? owners[static_cast<std::size_t>(frame.value)] : Take{frame, frame, 1};
}

bool Project::savesTakes() const { return !sketch_ && !readOnly() && isProject(folder_); }

Project Project::sketch() const {
  Project copy = *this;
  copy.sketch_ = true;
  return copy;
}

void Project::changeSaved(const ChangeTakes& change) {
  setTakes(document_, savesTakes() ? changeSavedTakes(folder_, change) : change(takesOf(document_)));
  memo_.clear();
}

void Project::changeTakes(const std::function<std::vector<Take>(std::vector<Take>)>& change) {
  const std::vector<std::string>& frames = capture().frames;
  changeSaved([&](const SavedTakes& saved) -> SavedTakes {
    const std::vector<Take> before = readTakes(saved.now, frames);
    const std::vector<Take> after = change(before);
    if (after == before) return saved;
    return {saveTakes(after, frames),
            saveTakes(withEarlier(readTakes(saved.earlier, frames), before, after), frames)};
  });
}

void Project::dropOutdoneTakes(const Progress& progress) {
  std::vector<Take> outdone = earlierTakes();
  std::erase_if(outdone, [&](const Take& take) {
    for (FrameIndex f = take.begin(); f <= take.last; ++f.value) {
      progress.check();
      if (hasMore(take, f) || isUnseen(take, f)) return true;
    }
    return false;
  });
  if (outdone.empty()) return;
  const std::vector<SavedTake> dropped = saveTakes(outdone, capture().frames);
  changeSaved([&](SavedTakes saved) {
    std::erase_if(saved.earlier, [&](const SavedTake& take) {
      return std::find(dropped.begin(), dropped.end(), take) != dropped.end();
    });
    return saved;
  });
}

std::set<StepId> Project::shownIn(const Take& take, FrameIndex frame) const {
  std::set<StepId> shown;
  for (const StageInfo& info : setup_->stages.infos()) {
    if (!blockedReason(info.id).empty()) continue;
    for (const StepInfo& step : info.steps) {
      const StepId id(info.id, step.id);
      if (step.shown.frame && beam::applies(step, take, frame) && store_->has(key(id, take, frame)))
        shown.insert(id);
    }
  }
  return shown;
}

std::set<StepId> Project::shownBetween(const Take& take, const Between& between) const {
  const std::set<StepId> a = shownIn(take, between.before), b = shownIn(take, between.after);
  std::set<StepId> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(both, both.end()));
  return both;
}

std::set<StepId> Project::shownOf(const Take& take, FrameIndex frame) const {
  if (const std::optional<Between> between = betweenOf(take, frame)) return shownBetween(take, *between);
  return take.claims(frame) ? shownIn(take, frame) : std::set<StepId>{};
}

std::set<StepId> Project::shownNow(FrameIndex frame) const {
  std::set<StepId> shown = shownIn(takeOf(frame), frame);
  if (const std::optional<Between> between = betweenOf(takes(), frame))
    shown.merge(shownBetween(takeOf(between->before), *between));
  return shown;
}

bool Project::hasMore(const Take& take, FrameIndex frame) const {
  const std::set<StepId> here = shownOf(take, frame);
  if (here.empty()) return false;
  const std::set<StepId> others = shownNow(frame);
  const Take owner = takeOf(frame);
  return std::any_of(here.begin(), here.end(), [&](const StepId& id) {
    return !others.contains(id) && beam::applies(setup_->stages.step(id), owner, frame);
  });
}

// Neither it nor the others have anything there by the settings in force: it may by others, which come back.
bool Project::isUnseen(const Take& take, FrameIndex frame) const {
  const bool its_own = betweenOf(take, frame) || take.claims(frame);
  const auto& stages = setup_->stages.infos();
  const bool shows_any = std::any_of(stages.begin(), stages.end(), [](const StageInfo& stage) {
    return std::any_of(stage.steps.begin(), stage.steps.end(),
                       [](const StepInfo& s) { return s.shown.frame; });
  });
  return its_own && shows_any && shownOf(take, frame).empty() && shownNow(frame).empty();
}

void Project::splitTake(const Take& take, FrameIndex frame) {
  const std::vector<Take> own = beam::splitTake(takes(), take, frame);
  changeTakes([&](std::vector<Take> others) { return beam::splitTake(std::move(others), take, frame); });
  document_.takes = saveTakes(own, capture().frames);
  memo_.clear();
}

void Project::readTakesAgain() {
  if (!savesTakes()) return;
  setTakes(document_, takesOf(readProjectDocument(folder_)));
  memo_.clear();
}

void Project::adoptTakes(const Project& other) {
  setTakes(document_, takesOf(other.document_));
  memo_.clear();
}

// --- Keys ---

bool Project::applies(const StepId& step, FrameIndex frame) const {
  const StepInfo& info = setup_->stages.step(step);
  return info.frames == Frames::Every || beam::applies(info, takeOf(frame), frame);
}

const std::map<std::string, std::string>& Project::parametersOf(const StepId& step, bool later) const {
  const std::pair<StepId, bool> name(step, later);
  if (const auto known = memo_.parameters.find(name); known != memo_.parameters.end()) return known->second;
  std::map<std::string, std::string> parameters;
  const std::string stage(step.stage());
  const std::vector<Field> defaults = fieldsOf(*setup_->stages.make(stage));
  const std::vector<Field> in_force = fieldsOf(*makeStage(stage));
  for (std::size_t i = 0; i < in_force.size(); ++i) {
    if (in_force[i].value == defaults[i].value || !entersKey(in_force[i].info, step.name(), later)) continue;
    parameters[stage + "." + in_force[i].info.name] = toText(in_force[i].value);
  }
  return memo_.parameters.emplace(name, std::move(parameters)).first->second;
}

double Project::workOf(const StepId& step, bool later) const {
  const std::pair<StepId, bool> name(step, later);
  if (const auto known = memo_.works.find(name); known != memo_.works.end()) return known->second;
  const auto number = [&](const std::string& setting) {
    const FieldValue value = this->value(setting);
    const int* whole = std::get_if<int>(&value);
    return whole ? *whole : std::get<double>(value);
  };
  const StepWork& by = setup_->stages.step(step).work;
  const std::vector<View>& views = capture().views;
  double work = by.photographs ? static_cast<double>(views.size()) : 1;
  if (by.pixels && !views.empty()) {
    double pixels = 0;
    for (const View& view : views) pixels += static_cast<double>(view.camera.width) * view.camera.height;
    work *= pixels / static_cast<double>(views.size());
  }
  if (!by.downscale.empty()) work /= std::pow(number(by.downscale), 2);
  if (const std::string& times = later ? by.later_times : by.times; !times.empty()) work *= number(times);
  return memo_.works.emplace(name, work).first->second;
}

// Per-frame steps, in order, whose results of earlier frames enter `step`.
const std::vector<StepId>& Project::chainOf(const StepId& step) const {
  if (const auto known = memo_.chains.find(step); known != memo_.chains.end()) return known->second;
  const StageRegistry& stages = setup_->stages;
  std::set<StepId> now;
  std::vector<StepId> chain;
  stages.addWithReads(step, now);
  const std::set<StepId> before = stages.readBefore(now);
  for (const StageInfo& info : stages.infos()) {
    for (const StepInfo& s : info.steps) {
      const StepId id(info.id, s.id);
      if (s.per_frame && before.contains(id)) chain.push_back(id);
    }
  }
  return memo_.chains.emplace(step, std::move(chain)).first->second;
}

// Walks up the take from the last frame whose keys are known, so that no key recurses further than a frame.
void Project::keepKeysBefore(const StepId& step, const Take& take, FrameIndex frame) const {
  const std::vector<StepId>& chain = chainOf(step);
  if (chain.empty()) return;
  const auto toDo = [&](const StepId& id, FrameIndex f) {
    return beam::applies(setup_->stages.step(id), take, f) &&
           !memo_.keys.contains(KeyMemo::placeOf(id, take, f));
  };
  FrameIndex start = frame;
  while (const std::optional<FrameIndex> before = take.before(start)) {
    if (std::none_of(chain.begin(), chain.end(), [&](const auto& id) { return toDo(id, *before); })) break;
    start = *before;
  }
  for (; start < frame; start.value += take.step) {
    for (const StepId& id : chain) {
      if (!toDo(id, start)) continue;
      const Digest key = keyOf(ingredients(id, take, start));
      memo_.keys.emplace(KeyMemo::placeOf(id, take, start), key);
    }
  }
}

Digest Project::keyAt(const StepId& step, const Take& take, FrameIndex frame) const {
  const KeyMemo::Place place = setup_->stages.step(step).per_frame ? KeyMemo::placeOf(step, take, frame)
                                                                   : KeyMemo::placeOf(step, {}, {});
  if (const auto known = memo_.keys.find(place); known != memo_.keys.end()) return known->second;
  const Digest key = keyOf(ingredients(step, take, frame));
  memo_.keys.emplace(place, key);
  return key;
}

KeyIngredients Project::ingredients(const StepId& step, const Take& take, FrameIndex frame) const {
  requireCapture();  // a key made from what results tell of it would promise something else
  const StageRegistry& stages = setup_->stages;
  const StepInfo& info = stages.step(step);
  if (!beam::applies(info, take, frame))
    throw Error(Error::Kind::Bug,
                fmt::format("{} is not for frame {} of its take", step.text(), frame.value));
  const std::optional<FrameIndex> before = info.per_frame ? take.before(frame) : std::nullopt;
  const bool later = before && !info.later.empty();
  const int version = info.version + (capture().masks == MaskKind::None ? info.unmasked_version : 0);
  KeyIngredients key{step, version, parametersOf(step, later), {}, {}, {}, later};
  for (const Reads reads : info.reads) {
    switch (reads) {
      case Reads::Calibration:
        if (!memo_.calibration) memo_.calibration = inputs_->calibration(capture());
        key.inputs["calibration"] = *memo_.calibration;
        break;
      case Reads::Pictures:
        key.inputs["pictures"] = inputs_->pictures(capture(), frame, Split::Train);
        break;
      case Reads::HeldOut:
        key.inputs["held_out"] = inputs_->pictures(capture(), frame, Split::Test);
        break;
      case Reads::Environment:
        if (const auto file = environmentFile()) key.inputs["environment"] = inputs_->file(*file);
        break;
    }
  }
  keepKeysBefore(step, take, frame);
  const auto add = [&](const std::vector<StepId>& ids, FrameIndex f, std::map<StepId, Digest>& to) {
    for (const StepId& id : ids) {
      if (beam::applies(stages.step(id), take, f)) to[id] = keyAt(id, take, f);
    }
  };
  add(info.inputs, frame, key.upstream);
  if (!later) return key;
  add(info.later.inputs, frame, key.upstream);
  add(info.later.previous, *before, key.previous);
  return key;
}

KeyIngredients Project::ingredients(const StepId& step, FrameIndex frame) const {
  return ingredients(step, takeOf(frame), frame);
}

Digest Project::key(const StepId& step, FrameIndex frame) const { return key(step, takeOf(frame), frame); }

Digest Project::key(const StepId& step, const Take& take, FrameIndex frame) const {
  const KeyMemo::Place place = setup_->stages.step(step).per_frame ? KeyMemo::placeOf(step, take, frame)
                                                                   : KeyMemo::placeOf(step, {}, {});
  const Digest key = keyOf(ingredients(step, take, frame));
  const auto [known, fresh] = memo_.keys.try_emplace(place, key);
  if (fresh || known->second == key) return key;
  memo_.clear();  // its input files are others now: so is the key of all that builds on them
  return keyAt(step, take, frame);
}

bool Project::lacksAny(const std::vector<StepId>& steps, const Take& take, FrameIndex frame) const {
  const std::map<KeyMemo::Place, Digest> kept = memo_.keys;
  const bool lacks = std::any_of(steps.begin(), steps.end(), [&](const StepId& step) {
    return beam::applies(setup_->stages.step(step), take, frame) &&
           !store_->has(keyOf(ingredients(step, take, frame)));
  });
  memo_.keys = kept;
  return lacks;
}

// --- States ---

std::string Project::blockedReason(std::string_view stage) const {
  const StageInfo& info = setup_->stages.info(stage);
  if (without_capture_) return lostCaptureText();
  std::set<StepId> all;
  for (const StepInfo& step : info.steps) setup_->stages.addWithReads(StepId(info.id, step.id), all);
  const bool needs_environment = std::any_of(all.begin(), all.end(), [&](const StepId& id) {
    const std::vector<Reads>& reads = setup_->stages.step(id).reads;
    return std::find(reads.begin(), reads.end(), Reads::Environment) != reads.end();
  });
  if (!needs_environment) return {};
  try {
    if (environmentFile()) return {};
  } catch (const Error& gone) {
    return gone.what();
  }
  return fmt::format(
      "{} needs a panorama of the light (.exr or .hdr, latitude-longitude), which the capture does not have: "
      "give one with --environment FILE, or in the studio by File > Light of the capture",
      info.title);
}

StepState Project::state(const StepId& step, FrameIndex frame) const {
  const bool blocked = !blockedReason(step.stage()).empty();  // then the capture may be gone
  return blocked ? StepState::Blocked : state(step, takeOf(frame), frame);
}

StepState Project::state(const StepId& step, const Take& take, FrameIndex frame) const {
  if (!blockedReason(step.stage()).empty()) return StepState::Blocked;
  if (!beam::applies(setup_->stages.step(step), take, frame)) return StepState::NotNeeded;
  const Digest digest = key(step, take, frame);
  if (store_->has(digest)) return StepState::Done;
  if (store_->isLeased(digest)) return StepState::Running;
  return store_->failure(digest) ? StepState::Failed : StepState::Pending;
}

StepState Project::stageState(std::string_view stage, FrameIndex frame) const {
  const StageInfo& info = setup_->stages.info(stage);
  for (const StepInfo& step : info.steps) {
    const StepState found = state(StepId(info.id, step.id), frame);
    if (found != StepState::Done && found != StepState::NotNeeded) return found;
  }
  return StepState::Done;
}

std::string Project::failureOf(const StepId& step, FrameIndex frame) const {
  if (without_capture_ || !applies(step, frame)) return {};
  const std::optional<FailureNote> note = store_->failure(key(step, frame));
  return note ? note->message : std::string();
}

std::optional<fs::path> Project::result(const StepId& step, FrameIndex frame) const {
  if (!blockedReason(step.stage()).empty()) return std::nullopt;
  return result(step, takeOf(frame), frame);
}

std::optional<fs::path> Project::result(const StepId& step, const Take& take, FrameIndex frame) const {
  const bool needed = beam::applies(setup_->stages.step(step), take, frame);
  if (!needed || !blockedReason(step.stage()).empty()) return std::nullopt;
  return store_->verified(key(step, take, frame));
}

std::optional<ResultRecord> Project::record(const StepId& step, FrameIndex frame) const {
  if (!blockedReason(step.stage()).empty() || !applies(step, frame)) return std::nullopt;
  return store_->record(key(step, frame));
}

}  // namespace beam
