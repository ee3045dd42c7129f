// SPDX-License-Identifier: Apache-2.0
// Project: one folder Name.beam on disk; which capture, which settings, which results. Copies are independent
// snapshots over the same folder (the runner works on one); opening never writes.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/fields.h"
#include "core/base/hash.h"
#include "core/base/progress.h"
#include "core/io/capture_reader.h"
#include "core/pipeline/input_digests.h"
#include "core/pipeline/key_memo.h"
#include "core/pipeline/project_document.h"
#include "core/pipeline/result_key.h"
#include "core/pipeline/result_store.h"
#include "core/pipeline/stage_registry.h"

namespace beam {

// What the pipeline is built of; made once by the program.
struct PipelineSetup {
  StageRegistry stages;
  std::filesystem::path presets;  // folder with draft.json, standard.json, paper.json
  std::function<ImportedCapture(const std::filesystem::path&, const ImportOptions&)> open_capture =
      openCapture;
};

enum class StepState {
  Pending,
  Running,  // some process holds its lease
  Failed,   // the last attempt did; failureOf tells why
  Done,
  Blocked,    // needs something the project does not have (a panorama)
  NotNeeded,  // the step is not for this frame of its take
};

class Project {
 public:
  // Throws Error{Data} when the folder is no project or of a newer format.
  static Project open(const std::filesystem::path& folder, std::shared_ptr<const PipelineSetup> setup);
  // A new project in memory; save() makes its folder. Throws Error{Usage} when something is there already.
  static Project create(const std::filesystem::path& folder, const ProjectDocument& document,
                        std::shared_ptr<const PipelineSetup> setup);
  static bool isProject(const std::filesystem::path& folder);

  const std::filesystem::path& folder() const { return folder_; }
  std::string name() const;  // of the folder, without ".beam"
  const PipelineSetup& setup() const { return *setup_; }
  const std::shared_ptr<const PipelineSetup>& sharedSetup() const { return setup_; }  // for another project
  // Whether results and settings can be written; opening and looking work without.
  bool readOnly() const;

  // --- Settings. Changes stay in memory until save(). ---
  // Every field of every stage under its full name ("surface.iterations") with its value in force, in order.
  std::vector<Field> fields() const;
  FieldValue value(std::string_view key) const;
  FieldValue presetValue(std::string_view key) const;  // what holds when the user says nothing
  // Throws Error{Usage}: unknown key (names the nearest), wrong type, out of range.
  void set(std::string_view key, const FieldValue& value);
  void reset(std::string_view key);
  void setPreset(const std::string& name);  // Error{Usage} when there is none of that name
  std::vector<std::string> presetNames() const;
  const ProjectDocument& document() const { return document_; }
  void setCapture(const std::filesystem::path& capture);
  void setEnvironment(const std::optional<std::filesystem::path>& file);
  void setHoldOut(std::vector<std::string> hold_out);
  void setUp(std::optional<UpAxis> up);
  // Looks, in the order they came in: they enter no key and change no state. Null: there is none of that
  // name.
  const std::vector<Look>& looks() const { return document_.looks; }
  const Look* look(std::string_view name) const;
  // Adds it, or puts it in place of the one of its name. Throws Error{Data} for a look that is not valid,
  // Error{Usage} for a name that is none (isLookName) and for more than kMostLooks.
  void setLook(const Look& look);
  void removeLook(std::string_view name);  // nothing when there is none
  // A copy, never saved, in which preset, settings, light, held-out cameras, axes and place of the capture
  // are those of `earlier`, a version of this project; its takes, too, where they are asked for.
  Project withSettingsOf(const ProjectDocument& earlier, bool takes_too = false) const;
  // Metres a unit of the capture; its place is found anew with it.
  void setUnit(double unit_m);
  // Writes to project.json what was changed here since it was read or saved; nothing else ever does. What
  // other programs changed there meanwhile stays and is in force here, too, from now on. What a new project
  // finds of its capture's unit and origin is kept from now on. Whether others changed more than takes.
  // Throws Error{Locked} or Error{Storage}.
  bool save();

  // --- Capture, read when first asked for and kept. ---
  const ImportedCapture& imported() const;
  // Its unit and origin as document() has them or, in a project that is new, as they were found; none: the
  // capture is only turned.
  std::optional<CapturePlacement> world() const;
  const CaptureSet& capture() const { return imported().set; }
  std::filesystem::path captureFolder() const;
  // Whether `folder` holds the capture of this project: the same folder, or one described by the same bytes.
  bool isCapture(const std::filesystem::path& folder) const;
  // Whether the folder of the capture is where the project expects it; cheap.
  bool captureIsThere() const;
  // For looking at results whose capture is gone: from now on capture() is what the results tell of it
  // (captureFromResults), every stage is blocked, there are no keys, and nothing can be run.
  void lookWithoutCapture();
  bool withoutCapture() const { return without_capture_; }
  // Throws Error{Data} in a project that is looked at without its capture.
  void requireCapture() const;
  // What tells the capture in `folder` from the one of this project, in words; empty: nothing does.
  // Throws Error{Data} when there is none.
  std::string differenceOfCapture(const std::filesystem::path& folder) const;
  // The same of the capture where it is: its description was edited since, or another capture lies there.
  std::string captureChange() const;
  // What it says now is that of this project.
  void acceptCaptureChange();
  // The capture is in `folder` now; ends looking without it. One that is described by other bytes, which may
  // not fit the results, is refused unless `other_too`: Error{Data} that tells what differs.
  void relocateCapture(const std::filesystem::path& folder, bool other_too = false);
  // The panorama in force: the project's own, else the capture's.
  std::optional<std::filesystem::path> environmentFile() const;

  // --- Takes: which frames build on the frame before. ---
  std::vector<Take> takes() const;
  std::vector<Take> earlierTakes() const;  // ProjectDocument::earlier_takes
  Take takeOf(FrameIndex frame) const;
  // Changes what other processes left in project.json, at once, and has the same here. A project that is
  // read-only or not on disk yet changes here alone. Those that go become earlier takes. Throws Error{Locked}
  // or Error{Storage}.
  void changeTakes(const std::function<std::vector<Take>(std::vector<Take>)>& change);
  // Forgets likewise earlier takes of which nothing is there that the others do not have. Throws Cancelled.
  void dropOutdoneTakes(const Progress& progress);
  // Whether the frame, claimed by the take or between two of its members, can be seen there from a step that
  // its owner, and what it lies between now, lack.
  bool hasMore(const Take& take, FrameIndex frame) const;
  // Makes `frame`, a member of `take`, the first of one, likewise; further changes by others do not reach
  // this project.
  void splitTake(const Take& take, FrameIndex frame);
  // Those that are in project.json now; a project that is read-only or not on disk keeps its own.
  void readTakesAgain();
  void adoptTakes(const Project& other);
  // A copy whose takes change in memory alone.
  Project sketch() const;

  // --- Steps. `frame` is ignored for steps that serve the whole project. A frame is
  // seen as a member of the take that owns it, or of the one that is named. ---
  // Why a stage cannot run ("" when it can): "needs a panorama: ...".
  std::string blockedReason(std::string_view stage) const;
  // False: the step is not for this frame of its take; it has no key and no result.
  bool applies(const StepId& step, FrameIndex frame) const;
  // The user's files that the step reads itself are looked at each time; keys of what it builds on are kept
  // until settings or takes change, or forgetKeys(): every frame's key holds that of the frame before.
  KeyIngredients ingredients(const StepId& step, FrameIndex frame) const;
  KeyIngredients ingredients(const StepId& step, const Take& take, FrameIndex frame) const;
  Digest key(const StepId& step, FrameIndex frame) const;
  Digest key(const StepId& step, const Take& take, FrameIndex frame) const;
  void forgetKeys() const { memo_.clear(); }
  // What of the settings in force enters the key of the step: full name -> value.
  const std::map<std::string, std::string>& parametersOf(const StepId& step, bool later) const;
  // How much there is to do by StepInfo::work with the capture and the settings in force; only ratios mean
  // something.
  double workOf(const StepId& step, bool later) const;
  // Whether the frame has no result yet of one of the steps. Keeps no keys: before its turn its files may
  // change.
  bool lacksAny(const std::vector<StepId>& steps, const Take& take, FrameIndex frame) const;
  StepState state(const StepId& step, FrameIndex frame) const;
  StepState state(const StepId& step, const Take& take, FrameIndex frame) const;
  // Of a whole stage for a frame: the least finished of its steps that are for it; Done when there are none.
  StepState stageState(std::string_view stage, FrameIndex frame) const;
  std::string failureOf(const StepId& step, FrameIndex frame) const;  // message; empty: none
  // Folder of the finished result, every byte verified (once a process and version of the file); empty when
  // there is none. A damaged one is set aside with a warning and counts as none.
  std::optional<std::filesystem::path> result(const StepId& step, FrameIndex frame) const;
  std::optional<std::filesystem::path> result(const StepId& step, const Take& take, FrameIndex frame) const;
  std::optional<ResultRecord> record(const StepId& step, FrameIndex frame) const;

  const ResultStore& store() const { return *store_; }
  // A stage with the settings in force.
  std::unique_ptr<Stage> makeStage(std::string_view stage) const;
  const InputDigests& inputs() const;

 private:
  Project(std::filesystem::path folder, ProjectDocument document, std::shared_ptr<const PipelineSetup> setup);
  void forgetCapture();
  bool takeOver(ProjectDocument document);
  const std::map<std::string, FieldValue>& preset() const;
  // `from`: of preset() or of the document. Error{Data} that names where it stands for what cannot be.
  void setSaved(Stage& stage, std::string_view stage_id, const std::map<std::string, FieldValue>& from) const;
  std::string lostCaptureText() const;
  bool savesTakes() const;
  void changeSaved(const ChangeTakes& change);
  std::set<StepId> shownOf(const Take& take, FrameIndex frame) const;  // claimed, or between its members
  std::set<StepId> shownNow(FrameIndex frame) const;                   // by the takes of now
  bool isUnseen(const Take& take, FrameIndex frame) const;
  std::set<StepId> shownIn(const Take& take, FrameIndex frame) const;  // StepShown::frame
  std::set<StepId> shownBetween(const Take& take, const Between& between) const;
  Digest keyAt(const StepId& step, const Take& take, FrameIndex frame) const;
  void keepKeysBefore(const StepId& step, const Take& take, FrameIndex frame) const;
  const std::vector<StepId>& chainOf(const StepId& step) const;

  std::filesystem::path folder_;
  ProjectDocument document_;
  std::shared_ptr<const ProjectDocument>
      saved_;  // as project.json was read or written; null: it is not there
  std::shared_ptr<const PipelineSetup> setup_;
  std::shared_ptr<const ResultStore> store_;
  mutable std::map<std::string, FieldValue> preset_;
  mutable std::string preset_loaded_;
  mutable std::shared_ptr<const ImportedCapture> imported_;
  mutable std::shared_ptr<const InputDigests> inputs_;
  mutable KeyMemo memo_;
  bool without_capture_ = false, sketch_ = false;
  std::optional<std::vector<std::string>> read_hold_out_;  // what project.json said; none: it was not read
  bool finds_placement_ = false;                           // of the capture, when it is read next
  std::optional<double> unit_m_;                           // that was given for it
};

}  // namespace beam
