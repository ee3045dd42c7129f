// SPDX-License-Identifier: Apache-2.0
#include "core/work/last_solved.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/base/log.h"
#include "core/base/word_list.h"
#include "core/pipeline/setting_changes.h"
#include "core/scene/frame_list.h"
#include "core/stages/project_sequence.h"
#include "core/stages/step_ids.h"

namespace beam {
namespace {

// What the settings of a project solve of what is wanted.
struct Solved {
  bool enough = false;
  std::optional<FrameIndex> first;  // of the frames that are solved
  bool materials = false;           // of `first`
  std::vector<FrameIndex> lacking;  // of frames that were named, where not all of them are
};

std::vector<FrameIndex> framesIn(const Project& project, const std::string& list) {
  return parseFrameList(list, project.capture().frames);
}

Solved solvedOf(const Project& project, const WantedResults& wanted, const Progress& progress) {
  const auto sequence = sequenceOf(project, wanted.between ? Shows::Between : Shows::Solved);
  const bool any = isAllFrames(wanted.frames);
  Solved solved;
  for (const FrameIndex frame : framesIn(project, wanted.frames)) {
    progress.check();
    const FrameContent content = sequence->content(frame);
    const bool enough =
        content.gaussians && (content.materials || !wanted.materials) && (content.mesh || !wanted.mesh);
    if (!enough) {
      if (!any) solved.lacking.push_back(frame);
      continue;
    }
    if (!solved.first) solved.first = frame, solved.materials = content.materials;
    if (any) break;
  }
  solved.enough = solved.first && solved.lacking.empty();
  return solved;
}

// Throws Error for a pipeline without surfaces.
bool onSameSurface(const Project& a, const Project& b, FrameIndex frame) {
  return a.key(kRefineStep, frame) == b.key(kRefineStep, frame);
}

struct Earlier {
  Project project;
  bool materials = false;
};

// The last settings that solve what is wanted, better than those in force, which solve `now` of it: of those
// that do, the last with materials where these are asked for.
std::optional<Earlier> lastThatSolves(const Project& project, const WantedResults& wanted, const Solved& now,
                                      const Progress& progress) {
  std::optional<Earlier> without;
  for (const Project& earlier : earlierVersions(project)) {
    progress.check();
    try {
      const Solved then = solvedOf(earlier, wanted, progress);
      if (!then.enough) continue;
      if (now.enough && !(then.materials && onSameSurface(project, earlier, *now.first))) continue;
      if (then.materials || !wanted.materials_if_any) return Earlier{earlier, then.materials};
      if (!without) without = Earlier{earlier, false};
    } catch (const Error& e) {
      requireData(e);
      logDebug("settings of the history of \"{}\" are passed over: {}", project.folder().string(), e.what());
    }
  }
  return without;
}

// Of what the results are made of: settings of materials that are not there have no part in them.
std::vector<std::string> changesOf(const Earlier& earlier, const Project& now) {
  std::vector<std::string> changes = settingChanges(earlier.project, now);
  if (!earlier.materials) {
    const std::string materials = fmt::format("{}.", kMaterialsStep.stage());
    std::erase_if(changes, [&](const std::string& change) { return change.starts_with(materials); });
  }
  return changes;
}

// "P.beam": frames 000001-000002 are
std::string framesAre(const Project& project, const std::vector<FrameIndex>& frames) {
  std::vector<std::string> names;
  std::vector<int> positions;
  for (const FrameIndex frame : frames) {
    names.push_back(project.capture().frames[static_cast<std::size_t>(frame.value)]);
    positions.push_back(frame.value);
  }
  return fmt::format("\"{}\": {} {} {}", project.folder().string(), nounText(names.size(), "frame"),
                     shortList(frameRanges(names, positions)), nounText(names.size(), "is", "are"));
}

LastSolved lastThatServes(const Project& project, const WantedResults& wanted, const Progress& progress) {
  const Solved now = solvedOf(project, wanted, progress);
  if (now.enough && (now.materials || !wanted.materials_if_any)) return {project, {}};
  const std::optional<Earlier> found = lastThatSolves(project, wanted, now, progress);
  if (!found) return {project, {}};
  const std::vector<std::string> changes = changesOf(*found, project);
  const std::string told = changes.empty() ? "other takes" : shortList(changes);
  // What is drawn of a frame must not depend on which others are named beside it.
  if (now.first && !now.lacking.empty()) {
    throw Error(
        Error::Kind::Data,
        fmt::format("{} solved with other settings only ({}), the others that are named with those in "
                    "force: beam run it, or name them in calls of their own",
                    framesAre(project, now.lacking), told));
  }
  if (wanted.strict) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": what is wanted is not solved with the settings in force, only before "
                            "they changed ({}): beam run it, or leave out --strict",
                            project.folder().string(), told));
  }
  return {found->project, changes.empty() ? std::vector<std::string>{told} : changes};
}

// Of the frames, by name, those of which there are results of other settings or takes.
std::vector<FrameIndex> solvedOtherwise(const Project& project,
                                        const std::map<std::string, FrameIndex>& frames,
                                        const Progress& progress) {
  if (frames.empty()) return {};  // no record is read
  std::set<FrameIndex> solved;
  for (const ResultRecord& record : project.store().recordsByAge()) {
    progress.check();
    const StepId& step = record.ingredients.step;
    if (record.lead || step == kMeshStep || !shownOf(project.setup().stages, step).frame) continue;
    if (const auto frame = frames.find(record.frame); frame != frames.end()) solved.insert(frame->second);
  }
  return {solved.begin(), solved.end()};
}

void addWhatIsLacking(LastSolved& last, const WantedResults& wanted, const Progress& progress) {
  const auto sequence = sequenceOf(last.project, wanted.between ? Shows::Between : Shows::Solved);
  std::map<std::string, FrameIndex> lacking;
  bool any_materials = false;
  for (const FrameIndex frame : framesIn(last.project, wanted.frames)) {
    progress.check();
    const FrameContent content = sequence->content(frame);
    if (!content.gaussians) lacking.emplace(nameOf(*sequence, frame), frame);
    if (content.unfinished) last.unfinished.push_back(frame);
    any_materials |= content.materials;
    if (wanted.materials_if_any && content.gaussians && !content.materials) last.bare.push_back(frame);
  }
  if (!any_materials) last.bare.clear();
  if (isAllFrames(wanted.frames)) last.left_out = solvedOtherwise(last.project, lacking, progress);
}

void requireStrictly(bool none, const std::string& text) {
  if (none) return;
  throw Error(Error::Kind::Data,
              fmt::format("{}, name the --frames that are wanted, or leave out --strict", text));
}

}  // namespace

std::string LastSolved::leftOutText() const {
  return fmt::format(
      "{} left out: what there is of them was made with other settings, of other photographs or in another "
      "take than the frames that are used (beam status says which); beam run solves all of them alike",
      framesAre(project, left_out));
}

std::string LastSolved::bareText() const {
  return fmt::format("{} without materials, which the others have: beam run it to give all of them their own",
                     framesAre(project, bare));
}

std::string LastSolved::unfinishedText() const {
  return fmt::format("{} fitted and not refined yet, for a run was cut: beam run it to finish them",
                     framesAre(project, unfinished));
}

void LastSolved::tell() const {
  if (!changes.empty()) {
    logWarning(
        "\"{}\": the results are those of other settings than are in force ({}): beam run it to solve "
        "the frames anew; --strict refuses",
        project.folder().string(), shortList(changes));
  }
  if (!left_out.empty()) logWarning("{}; --strict refuses", leftOutText());
  if (!unfinished.empty()) logWarning("{}; --strict refuses", unfinishedText());
  if (!bare.empty()) logWarning("{}; --strict refuses", bareText());
}

LastSolved lastSolved(const Project& project, const WantedResults& wanted, const Progress& progress) {
  if (project.withoutCapture()) return {project, {}};
  LastSolved last = lastThatServes(project, wanted, progress);
  addWhatIsLacking(last, wanted, progress);
  if (wanted.strict) {
    requireStrictly(last.left_out.empty(), last.leftOutText());
    requireStrictly(last.unfinished.empty(), last.unfinishedText());
    requireStrictly(last.bare.empty(), last.bareText());
  }
  return last;
}

}  // namespace beam
