// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/project_merge.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

namespace beam {
namespace {

class Merger {
 public:
  explicit Merger(std::vector<std::string>& both) : both_(both) {}

  template <class T>
  T operator()(const std::string& name, const T& base, const T& ours, const T& theirs) {
    if (ours == base) return theirs;
    if (theirs != base && theirs != ours) both_.push_back(name);
    return ours;
  }

 private:
  std::vector<std::string>& both_;
};

using Settings = std::map<std::string, FieldValue>;

std::optional<FieldValue> valueIn(const Settings& settings, const std::string& key) {
  const auto found = settings.find(key);
  return found == settings.end() ? std::nullopt : std::optional(found->second);
}

Settings settingsOf(const ProjectDocument& base, const ProjectDocument& ours, const ProjectDocument& theirs,
                    Merger& merge) {
  Settings all = ours.settings;
  all.insert(theirs.settings.begin(), theirs.settings.end());
  Settings kept;
  for (const auto& [key, value] : all) {
    const auto chosen =
        merge(key, valueIn(base.settings, key), valueIn(ours.settings, key), valueIn(theirs.settings, key));
    if (chosen) kept[key] = *chosen;
  }
  return kept;
}

std::optional<Look> lookIn(const ProjectDocument& document, const std::string& name) {
  const auto found = std::find_if(document.looks.begin(), document.looks.end(),
                                  [&](const Look& look) { return look.name == name; });
  return found == document.looks.end() ? std::nullopt : std::optional(*found);
}

// In the order of ours, then those that they added.
std::vector<Look> looksOf(const ProjectDocument& base, const ProjectDocument& ours,
                          const ProjectDocument& theirs, Merger& merge) {
  std::vector<std::string> names;
  for (const ProjectDocument* document : {&ours, &theirs}) {
    for (const Look& look : document->looks)
      if (std::find(names.begin(), names.end(), look.name) == names.end()) names.push_back(look.name);
  }
  std::vector<Look> kept;
  for (const std::string& name : names) {
    const auto chosen =
        merge("the look " + name, lookIn(base, name), lookIn(ours, name), lookIn(theirs, name));
    if (chosen) kept.push_back(*chosen);
  }
  return kept;
}

}  // namespace

MergedDocument merged(const ProjectDocument& base, const ProjectDocument& ours,
                      const ProjectDocument& theirs) {
  MergedDocument out{ours, {}};
  Merger merge(out.both);
  ProjectDocument& d = out.document;
  const auto captureOf = [](const ProjectDocument& p) { return std::tie(p.capture, p.capture_files); };
  const auto worldOf = [](const ProjectDocument& p) { return std::tie(p.world, p.world_unknown); };
  using Capture = std::tuple<FileReference, std::vector<DescriptionFile>>;
  using World = std::tuple<std::optional<CapturePlacement>, std::string>;
  std::tie(d.capture, d.capture_files) =
      merge("the capture", Capture(captureOf(base)), Capture(captureOf(ours)), Capture(captureOf(theirs)));
  std::tie(d.world, d.world_unknown) =
      merge("the unit of the capture", World(worldOf(base)), World(worldOf(ours)), World(worldOf(theirs)));
  d.environment = merge("the panorama", base.environment, ours.environment, theirs.environment);
  d.hold_out = merge("the held-out cameras", base.hold_out, ours.hold_out, theirs.hold_out);
  d.up = merge("the up axis", base.up, ours.up, theirs.up);
  d.preset = merge("the preset", base.preset, ours.preset, theirs.preset);
  d.settings = settingsOf(base, ours, theirs, merge);
  // A value that equals one preset's is no setting and would be another with the other preset.
  if (theirs.preset != base.preset && ours.preset == base.preset && ours.settings != base.settings)
    out.both.emplace_back("the settings beside the preset, which is the other program's");
  d.looks = looksOf(base, ours, theirs, merge);
  d.unknown = merge("what a later version wrote", base.unknown, ours.unknown, theirs.unknown);
  setTakes(d, takesOf(theirs));
  return out;
}

}  // namespace beam
