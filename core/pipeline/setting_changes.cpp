// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/setting_changes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/field_text.h"
#include "core/io/file.h"
#include "core/pipeline/project_history.h"

namespace beam {
namespace {

std::string lightOf(const Project& project) {
  const std::optional<FileReference>& own = project.document().environment;
  return own ? own->absolute : std::string("the capture's");
}

std::string heldOutOf(const Project& project) {
  const std::vector<std::string>& names = project.document().hold_out;
  return names.empty() ? std::string("none") : fmt::format("{}", fmt::join(names, ","));
}

std::string upOf(const Project& project) {
  return project.document().up ? toText(*project.document().up) : "the capture's";
}

std::string placeOf(const Project& project) {
  const std::optional<CapturePlacement>& world = project.document().world;
  return world ? toText(*world) : std::string("as it is");
}

// What of a version decides results; versions that differ in nothing else are one.
std::string identityOf(const Project& project, bool takes) {
  ProjectDocument d = withoutLooks(project.document());
  d.earlier_takes.clear();
  if (!takes) d.takes.clear();
  d.unknown = "{}";
  return toJson(d);
}

}  // namespace

std::string changeText(std::string_view what, std::string_view before, std::string_view now) {
  return fmt::format("{} {} → {}", what, before, now);
}

std::vector<std::string> settingChanges(const Project& before, const Project& now) {
  std::vector<std::string> changes;
  const auto tell = [&](std::string_view what, const std::string& a, const std::string& b) {
    if (a != b) changes.push_back(changeText(what, a, b));
  };
  const std::vector<Field> old_fields = before.fields(), fields = now.fields();
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].info.effect == Effect::Result)
      tell(fields[i].info.name, toText(old_fields[i].value), toText(fields[i].value));
  }
  tell("the panorama", lightOf(before), lightOf(now));
  tell("held-out cameras", heldOutOf(before), heldOutOf(now));
  tell("the up axis", upOf(before), upOf(now));
  tell("the capture's place", placeOf(before), placeOf(now));
  return changes;
}

std::vector<Project> earlierVersions(const Project& project) {
  std::vector<Project> versions, with_takes;
  std::vector<std::string> seen = {identityOf(project, false)}, seen_takes = {identityOf(project, true)};
  const auto add = [](const Project& version, bool takes, std::vector<std::string>& known,
                      std::vector<Project>& to) {
    const std::string identity = identityOf(version, takes);
    if (std::find(known.begin(), known.end(), identity) != known.end()) return;
    known.push_back(identity);
    to.push_back(version);
  };
  for (const HistoryEntry& entry : projectHistory(project.folder())) {
    if (!entry.readable) continue;
    try {
      const ProjectDocument document = parseProjectDocument(readTextFile(entry.file), entry.file.string());
      const Project version = project.withSettingsOf(document);
      version.fields();  // throws where it names what is not there any more
      add(version, false, seen, versions);
      if (document.takes != project.document().takes)
        add(project.withSettingsOf(document, true), true, seen_takes, with_takes);
    } catch (const Error& e) {
      requireData(e);
      continue;  // of a version, not of the project
    }
  }
  versions.insert(versions.end(), with_takes.begin(), with_takes.end());
  return versions;
}

}  // namespace beam
