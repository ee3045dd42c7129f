// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/pending_reason.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "core/base/count_text.h"
#include "core/pipeline/setting_changes.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNamed = 3;  // files of one cause that are told by name

void addOnce(const std::vector<std::string>& more, std::vector<std::string>& reasons) {
  for (const std::string& reason : more)
    if (std::find(reasons.begin(), reasons.end(), reason) == reasons.end()) reasons.push_back(reason);
}

// Names of both maps, each once.
template <class Key, class Value>
std::set<Key> namesOf(const std::map<Key, Value>& a, const std::map<Key, Value>& b) {
  std::set<Key> names;
  for (const auto* map : {&a, &b})
    for (const auto& [name, value] : *map) names.insert(name);
  return names;
}

std::vector<std::string> changedFiles(const std::map<std::string, std::string>& was,
                                      const std::map<std::string, std::string>& now) {
  std::vector<std::string> changes;
  for (const std::string& name : namesOf(was, now)) {
    const auto before = was.find(name), after = now.find(name);
    if (before == was.end())
      changes.push_back(fmt::format("{} is new", name));
    else if (after == now.end())
      changes.push_back(fmt::format("{} is gone", name));
    else if (before->second != after->second)
      changes.push_back(fmt::format("{} changed", name));
  }
  const std::size_t more = changes.size() > kMostNamed ? changes.size() - kMostNamed : 0;
  if (more == 0) return changes;
  changes.resize(kMostNamed);
  changes.push_back(fmt::format("{} changed", countText(more, "more file")));
  return changes;
}

}  // namespace

std::map<std::string, std::string> picturesRead(const Project& project, const StepInfo& step,
                                                FrameIndex frame) {
  std::map<std::string, std::string> read;
  for (const Reads reads : step.reads) {
    if (reads != Reads::Pictures && reads != Reads::HeldOut) continue;
    const fs::path folder = project.captureFolder();
    const Split split = reads == Reads::Pictures ? Split::Train : Split::Test;
    for (const PictureDigest& p : project.inputs().eachPicture(project.capture(), frame, split)) {
      for (std::size_t i = 0; i < p.files.size(); ++i)
        read[fs::path(p.files[i]).lexically_relative(folder).generic_string()] = p.words[i];
      if (p.files.empty()) read[p.view] = p.words.front();
    }
  }
  return read;
}

PendingReasons::PendingReasons(const Project& project) : project_(project) {
  for (ResultRecord& record : project.store().recordsByAge()) {
    const std::pair place(record.ingredients.step, record.frame);
    const Digest key = record.key;
    // What was made as a lead counts where there is nothing else.
    if (!newest_.emplace(place, key).second && !record.lead) newest_[place] = key;
    records_.emplace(key, std::move(record));
  }
}

PendingReasons::Reasons PendingReasons::of(const StepId& step, FrameIndex frame) const {
  const bool per_frame = project_.setup().stages.step(step).per_frame;
  const std::string name =
      per_frame ? project_.capture().frames[static_cast<std::size_t>(frame.value)] : std::string();
  const auto newest = newest_.find({step, name});
  if (newest == newest_.end() || !project_.applies(step, frame)) return {};
  return between(newest->second, step, project_.takeOf(frame), frame);
}

const PendingReasons::Reasons& PendingReasons::between(const Digest& was, const StepId& step,
                                                       const Take& take, FrameIndex frame) const {
  const std::pair place(was, project_.key(step, take, frame));
  if (const auto known = known_.find(place); known != known_.end()) return known->second;
  Reasons reasons;
  if (const auto record = records_.find(was); place.second == was) {
  } else if (record == records_.end()) {
    reasons = {fmt::format("{} changed", step.text())};
  } else if (const std::string& name = project_.capture().frames[static_cast<std::size_t>(frame.value)];
             !record->second.frame.empty() && record->second.frame != name) {
    reasons = {fmt::format("frame {} is built on, before it was frame {}", name, record->second.frame)};
  } else {
    reasons = differences(record->second, step, take, frame);
  }
  return known_.emplace(place, std::move(reasons)).first->second;
}

PendingReasons::Reasons PendingReasons::differences(const ResultRecord& was, const StepId& step,
                                                    const Take& take, FrameIndex frame) const {
  const KeyIngredients now = project_.ingredients(step, take, frame);
  Reasons reasons;
  if (was.ingredients.version != now.version) {
    reasons.push_back(changeText(fmt::format("this program's version of {}", step.text()),
                                 fmt::format("{}", was.ingredients.version), fmt::format("{}", now.version)));
  }
  addParameters(was.ingredients, now, reasons);
  addInputs(was, now, frame, reasons);
  if (was.ingredients.later != now.later)
    reasons.emplace_back(now.later ? "now builds on the frame before" : "now the first frame of its take");
  addResults(was.ingredients.upstream, now.upstream, take, frame, reasons);
  if (const std::optional<FrameIndex> before = take.before(frame))
    addResults(was.ingredients.previous, now.previous, take, *before, reasons);
  return reasons;
}

void PendingReasons::addParameters(const KeyIngredients& was, const KeyIngredients& now,
                                   Reasons& reasons) const {
  if (was.parameters == now.parameters) return;
  std::map<std::string, std::string> defaults;
  const std::string stage(now.step.stage());
  for (const Field& field : fieldsOf(*project_.setup().stages.make(stage)))
    defaults[fmt::format("{}.{}", stage, field.info.name)] = toText(field.value);
  const auto valueIn = [&](const std::map<std::string, std::string>& parameters, const std::string& name) {
    const auto found = parameters.find(name);
    if (found != parameters.end()) return found->second;
    const auto plain = defaults.find(name);
    return plain == defaults.end() ? std::string("unknown") : plain->second;
  };
  const auto inOneAlone = [&](const std::string& name) {
    return was.parameters.contains(name) != now.parameters.contains(name);
  };
  for (const std::string& name : namesOf(was.parameters, now.parameters)) {
    // Of a first frame and a later one other settings count: one that is missing need not have its default.
    if (was.later != now.later && inOneAlone(name)) continue;
    const std::string before = valueIn(was.parameters, name), after = valueIn(now.parameters, name);
    if (before != after) addOnce({changeText(name, before, after)}, reasons);
  }
}

void PendingReasons::addInputs(const ResultRecord& was, const KeyIngredients& now, FrameIndex frame,
                               Reasons& reasons) const {
  const std::map<std::string, Digest>& inputs = was.ingredients.inputs;
  bool pictures = false;
  for (const std::string& name : namesOf(inputs, now.inputs)) {
    const auto before = inputs.find(name), after = now.inputs.find(name);
    if (before != inputs.end() && after != now.inputs.end() && before->second == after->second) continue;
    if (name == "calibration")
      addOnce({"the cameras or seed points of the capture changed"}, reasons);
    else if (name == "environment")
      addOnce({"the panorama changed"}, reasons);
    else
      pictures = true;
  }
  if (!pictures) return;
  const Reasons files =
      changedFiles(was.pictures, picturesRead(project_, project_.setup().stages.step(now.step), frame));
  const bool known = !was.pictures.empty() && !files.empty();
  addOnce(known ? files : Reasons{"the photographs of the frame changed"}, reasons);
}

void PendingReasons::addResults(const std::map<StepId, Digest>& was, const std::map<StepId, Digest>& now,
                                const Take& take, FrameIndex frame, Reasons& reasons) const {
  for (const auto& [step, key] : now) {
    const auto before = was.find(step);
    if (before == was.end())
      addOnce({fmt::format("now builds on {}", step.text())}, reasons);
    else if (before->second != key)
      addOnce(between(before->second, step, take, frame), reasons);
  }
}

}  // namespace beam
