// SPDX-License-Identifier: Apache-2.0
// What is open as the window sees it: frames, their names and rate of a sequence, which a project gives or a
// file without one; a project's settings edited here on the window's thread; its capture, states and results
// read on background threads and announced when they are there.
#pragma once

#include <QObject>
#include <QTimer>

#include "core/pipeline/take_survey.h"
#include "core/scene/gaussian_sequence.h"
#include "ui/frame_cache.h"
#include "ui/stage_status.h"
#include "ui/studio_services.h"
#include "viewers/latest_worker.h"

namespace beam {

// A frame without results of its own shows those of the nearest frame that has some.
struct HeldValues {
  FrameIndex from;
  FrameValues values;
};

// Title of failed() when save() fails.
inline constexpr const char* kProjectNotSaved = "The project was not saved";

class ProjectModel final : public QObject {
  Q_OBJECT

 public:
  explicit ProjectModel(StudioServices services, QObject* parent = nullptr);
  ~ProjectModel() override;

  // A project folder, or a capture (a project for it is found or made at `place`, empty: beside it; on disk
  // from the first save on). Answers with opened() or failed().
  void open(const std::filesystem::path& path, const std::filesystem::path& place = {});
  bool opening() const { return opening_; }
  // Frames without a project behind them: nothing to set or to run, no cameras, no capture. Answers with
  // sequenceChanged().
  void show(std::shared_ptr<const GaussianSequence> sequence);
  void close();
  // The capture lies in `folder` now; answers like open(), or with anotherCapture() unless `other_too`.
  void locateCapture(const std::filesystem::path& folder, bool other_too = false);
  // It went away, or came back, while the project is open. Without it results are looked at, nothing is run.
  void setCaptureThere(bool there);
  bool captureLost() const { return project_ && (!capture_there_ || project_->withoutCapture()); }
  QString lostCaptureText() const;
  // The frame to begin with, right after opened(): this one, else the first that is solved, which is known
  // after the first survey.
  void startAt(const QString& frame_name);

  bool isOpen() const { return project_.has_value(); }  // a project
  const Project& project() const { return *project_; }
  // The project that states and values are told of: while a run goes on as it was when that started, so that
  // what is being made is shown, whatever is edited meanwhile for the next.
  const Project& shownProject() const { return run_project_ ? *run_project_ : *project_; }
  void startRun();
  void endRun();
  std::shared_ptr<const CaptureSet> capture() const { return capture_; }
  // The frames that are shown; null: nothing is open. Another snapshot with every survey.
  std::shared_ptr<const GaussianSequence> sequence() const { return sequence_; }
  int frameCount() const { return sequence_ ? static_cast<int>(sequence_->frames().size()) : 0; }
  QString nameOf(FrameIndex frame) const;
  const StudioServices& services() const { return services_; }

  FrameIndex frame() const { return frame_; }
  void setFrame(FrameIndex frame);
  QString frameName() const;

  // Edits; a refused one answers with failed().
  void set(const std::string& key, const FieldValue& value);
  void reset(const std::string& key);
  void setPreset(const std::string& name);
  void setEnvironment(const std::filesystem::path& file);
  // False, and failed(), when it cannot be written; also when its folder was on disk and is gone.
  bool save();
  bool unsaved() const { return unsaved_; }
  // Unsaved, and somebody changed something: it would be missed.
  bool editsUnsaved() const { return unsaved_ && edited_; }
  void countAsUnedited() { edited_ = false; }
  // It was on disk while it is open, wherever its folder is now.
  bool onDisk() const { return on_disk_; }

  // Looks at the disk again: states of the whole take, then the frame's values where they changed.
  // `pictures`: also whether the capture's pictures are still the same, which takes longer.
  void refresh(bool pictures = false);
  const std::vector<StageStatus>& stages() const { return stages_; }
  std::shared_ptr<const TakeSurvey> survey() const { return survey_; }  // null: not there yet
  const FrameValues& values() const { return values_; }
  const std::optional<HeldValues>& held() const { return held_; }
  QString valuesFrameName() const;  // the frame that values() are of; while another is read not frame()
  // values() (or held()) belong to frame() and to the newest survey.
  bool valuesReady() const { return ready_; }
  // Frames that will be looked at next, most urgent first.
  void prefetch(std::vector<FrameIndex> frames);
  // Meshes are not read while frames pass by.
  void setPassing(bool passing);
  const FrameCache& cache() const { return cache_; }
  // States and values of the last refresh have arrived.
  bool settled() const {
    return !opening_ && states_seen_ == states_ticket_ && mesh_seen_ == mesh_ticket_ &&
           (ready_ || !sequence_);
  }

 Q_SIGNALS:
  void openingStarted(const QString& path);
  void sequenceChanged();  // other frames are open, or none; before opened()
  void opened();
  void closed();
  void failed(const QString& what, const QString& why);
  // The capture to be located is not the project's; `difference`: how they are told apart.
  void anotherCapture(const QString& folder, const QString& difference);
  // Opening failed because of what project.json says, or lacks; there are earlier versions of it.
  void broken(const QString& folder, const QString& why);
  void settingsChanged();
  void stagesChanged();
  void frameChanged();
  void valuesChanged();
  void memoryChanged();  // other frames than before are in memory

 private:
  struct Opened;
  struct Surveyed;
  void adopt(const std::shared_ptr<Opened>& result);
  void forgetValues();
  void startAtFirstSolved();
  void take(const std::shared_ptr<Surveyed>& result);
  void showStages();
  void showFrame();
  void want(FrameIndex first);
  std::optional<FrameIndex> frameWithResults() const;
  void loadMesh();
  void edited();
  void saveQuietly();

  StudioServices services_;
  std::optional<Project> project_, run_project_;
  std::shared_ptr<const CaptureSet> capture_;
  std::shared_ptr<const GaussianSequence> sequence_;
  FrameIndex frame_;
  std::vector<StageStatus> stages_;
  std::shared_ptr<const TakeSurvey> survey_;
  std::shared_ptr<TakeSurveyor> surveyor_;  // used by states_worker_ alone
  FrameValues values_;
  std::optional<HeldValues> held_;
  std::optional<FrameIndex> values_of_;  // the frame they were announced for
  std::vector<FrameIndex> prefetch_;
  QString told_error_;
  bool on_disk_ = false, edited_ = false;
  bool opening_ = false, unsaved_ = false, ready_ = false, passing_ = false;
  bool capture_there_ = true;
  bool start_open_ = false;    // the frame to begin with is not chosen yet
  bool pictures_due_ = false;  // a refresh of the pictures was asked for and has not answered
  // A refresh that a newer one overtakes never answers; the newest always does.
  std::uint64_t states_ticket_ = 0, states_seen_ = 0, mesh_ticket_ = 0, mesh_seen_ = 0;
  QTimer autosave_;
  LatestWorker states_worker_, mesh_worker_, open_worker_;
  FrameCache cache_;  // last, with the workers: they stop first
};

// Where the project of a capture lies when nobody says: beside it, or in the documents when that is not
// writable.
std::filesystem::path projectFolderFor(const std::filesystem::path& capture);

}  // namespace beam
