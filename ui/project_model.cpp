// SPDX-License-Identifier: Apache-2.0
#include "ui/project_model.h"

#include <fmt/format.h>
#include <unistd.h>

#include <QStandardPaths>

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/pipeline/project_history.h"
#include "core/stages/project_sequence.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr int kAutosave_ms = 800;

Project projectOfCapture(const fs::path& capture, const fs::path& place,
                         const std::shared_ptr<const PipelineSetup>& setup) {
  if (!place.empty()) {
    Project made = Project::create(place, {}, setup);
    made.setCapture(capture);
    return made;
  }
  const fs::path wanted = projectFolderFor(capture);
  for (int attempt = 1;; ++attempt) {
    const fs::path folder =
        attempt == 1 ? wanted
                     : wanted.parent_path() / fmt::format("{}-{}.beam", wanted.stem().string(), attempt);
    if (Project::isProject(folder)) {
      Project found = Project::open(folder, setup);
      if (found.isCapture(capture)) return found;
    } else if (!fs::exists(folder) || fs::is_empty(folder)) {
      Project made = Project::create(folder, {}, setup);
      made.setCapture(capture);
      return made;
    }
  }
}

}  // namespace

struct ProjectModel::Opened {
  fs::path path;
  std::optional<Project> project;
  std::shared_ptr<const CaptureSet> capture;
  QString error;
  QString difference;   // of a capture that is not the project's, which was not asked for
  bool broken = false;  // its project.json cannot be read, an earlier one can
};

struct ProjectModel::Surveyed {
  std::uint64_t ticket = 0;
  bool pictures = false;
  std::shared_ptr<const Project> project;
  std::shared_ptr<const TakeSurvey> survey;  // null: `error` tells why
  std::shared_ptr<const GaussianSequence> sequence;
  QString error;
};

fs::path projectFolderFor(const fs::path& capture) {
  const fs::path folder = fs::absolute(capture / "").lexically_normal().parent_path();
  const fs::path name = folder.filename().string() + ".beam";
  if (::access(folder.parent_path().c_str(), W_OK) == 0) return folder.parent_path() / name;
  return fs::path(QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation).toStdString()) / name;
}

ProjectModel::ProjectModel(StudioServices services, QObject* parent)
    : QObject(parent),
      services_(std::move(services)),
      cache_(services_.frame_memory_bytes > 0 ? services_.frame_memory_bytes : defaultFrameBudget(),
             [this](FrameIndex) {
               QMetaObject::invokeMethod(
                   this,
                   [this] {
                     Q_EMIT memoryChanged();
                     if (!ready_ && sequence_) showFrame();
                   },
                   Qt::QueuedConnection);
             }) {
  autosave_.setSingleShot(true);
  autosave_.setInterval(kAutosave_ms);
  connect(&autosave_, &QTimer::timeout, this, &ProjectModel::saveQuietly);
}

ProjectModel::~ProjectModel() {
  if (autosave_.isActive()) saveQuietly();
}

void ProjectModel::open(const fs::path& path, const fs::path& place) {
  opening_ = true;
  Q_EMIT openingStarted(QString::fromStdString(path.string()));
  open_worker_.submit([this, path, place, setup = services_.pipeline] {
    auto result = std::make_shared<Opened>();
    result->path = path;
    try {
      if (!fs::exists(path)) {
        throw Error(
            Error::Kind::Data,
            fmt::format("\"{}\" does not exist; choose a capture folder or a project", path.string()));
      }
      Project project =
          looksLikeProject(path) ? Project::open(path, setup) : projectOfCapture(path, place, setup);
      project.fields();  // refuses settings that no stage takes
      result->project = std::move(project);
      if (!result->project->captureIsThere()) result->project->lookWithoutCapture();
      result->capture = std::make_shared<const CaptureSet>(result->project->capture());
    } catch (const std::exception& e) {  // the border of this thread: said in the window
      result->error = QString::fromStdString(e.what());
      result->broken = !result->project && !projectHistory(path).empty();
    }
    QMetaObject::invokeMethod(
        this, [this, result] { adopt(result); }, Qt::QueuedConnection);
  });
}

void ProjectModel::adopt(const std::shared_ptr<Opened>& result) {
  opening_ = false;
  if (result->broken) {
    Q_EMIT broken(QString::fromStdString(result->path.string()), result->error);
    return;
  }
  if (!result->difference.isEmpty()) {
    Q_EMIT anotherCapture(QString::fromStdString(result->path.string()), result->difference);
    return;
  }
  if (!result->error.isEmpty()) {
    Q_EMIT failed("Cannot open " + QString::fromStdString(result->path.filename().string()), result->error);
    return;
  }
  if (autosave_.isActive()) saveQuietly();
  project_.reset();
  forgetValues();
  project_.emplace(std::move(*result->project));
  capture_ = result->capture;
  sequence_ = sequenceOf(*project_, Shows::Newest);
  ready_ = false;
  on_disk_ = Project::isProject(project_->folder());
  unsaved_ = !on_disk_;
  edited_ = false;
  Q_EMIT sequenceChanged();
  Q_EMIT opened();
  refresh();
  showFrame();
}

void ProjectModel::show(std::shared_ptr<const GaussianSequence> sequence) {
  close();
  sequence_ = std::move(sequence);
  ready_ = false;
  Q_EMIT sequenceChanged();
  showFrame();
}

void ProjectModel::close() {
  if (!sequence_) return;
  if (autosave_.isActive()) saveQuietly();
  const bool of_project = project_.has_value();
  project_.reset();
  forgetValues();
  unsaved_ = false;
  states_seen_ = ++states_ticket_;  // what is still on its way is of the closed one
  Q_EMIT sequenceChanged();
  if (of_project) Q_EMIT closed();
}

void ProjectModel::forgetValues() {
  autosave_.stop();
  run_project_.reset();
  capture_ = nullptr;
  sequence_ = nullptr;
  frame_ = FrameIndex{0};
  stages_.clear();
  survey_ = nullptr;
  surveyor_ = std::make_shared<TakeSurveyor>();
  values_ = {};
  held_.reset();
  values_of_.reset();
  prefetch_.clear();
  told_error_.clear();
  pictures_due_ = false;
  start_open_ = false;
  capture_there_ = true;
  mesh_seen_ = ++mesh_ticket_;
  cache_.clear();
}

void ProjectModel::startAt(const QString& frame_name) {
  start_open_ = true;
  for (FrameIndex f{0}; f.value < frameCount(); ++f.value) {
    if (nameOf(f) == frame_name) return setFrame(f);
  }
}

void ProjectModel::locateCapture(const fs::path& folder, bool other_too) {
  opening_ = true;
  Q_EMIT openingStarted(QString::fromStdString(folder.string()));
  open_worker_.submit([this, folder, other_too, project = *project_]() mutable {
    auto result = std::make_shared<Opened>();
    result->path = folder;
    try {
      if (!other_too) result->difference = QString::fromStdString(project.differenceOfCapture(folder));
      if (result->difference.isEmpty()) {
        project.relocateCapture(folder, other_too);
        result->capture = std::make_shared<const CaptureSet>(project.capture());
        if (!project.readOnly()) project.save();
        result->project = std::move(project);
      }
    } catch (const std::exception& e) {  // the border of this thread: said in the window
      result->error = QString::fromStdString(e.what());
    }
    QMetaObject::invokeMethod(
        this, [this, result] { adopt(result); }, Qt::QueuedConnection);
  });
}

void ProjectModel::setCaptureThere(bool there) {
  if (capture_there_ == there) return;
  capture_there_ = there;
  if (there) return refresh(true);
  showStages();
}

QString ProjectModel::lostCaptureText() const {
  return QString(
             "Expected it at \"%1\". Put it back, or say where it is now; what is solved can be looked at "
             "meanwhile.")
      .arg(QString::fromStdString(project_->document().capture.absolute));
}

void ProjectModel::startRun() { run_project_ = *project_; }

void ProjectModel::endRun() {
  run_project_.reset();
  refresh(true);
}

QString ProjectModel::valuesFrameName() const {
  return sequence_ && values_of_ ? nameOf(*values_of_) : frameName();
}

QString ProjectModel::nameOf(FrameIndex frame) const {
  return QString::fromStdString(beam::nameOf(*sequence_, frame));
}

QString ProjectModel::frameName() const { return frameCount() > 0 ? nameOf(frame_) : QString(); }

void ProjectModel::setFrame(FrameIndex frame) {
  start_open_ = false;
  if (frame == frame_) return;
  frame_ = frame;
  ready_ = false;
  Q_EMIT frameChanged();
  showStages();
  showFrame();
}

void ProjectModel::edited() {
  unsaved_ = true;
  edited_ = true;
  // A project that is not on disk yet stays in memory until it is run or saved.
  if (on_disk_ && (!Project::isProject(project_->folder()) || !project_->readOnly())) autosave_.start();
  Q_EMIT settingsChanged();
  refresh();
}

void ProjectModel::set(const std::string& key, const FieldValue& value) {
  try {
    project_->set(key, value);
  } catch (const Error& e) {
    Q_EMIT failed("This value was not taken", QString::fromStdString(e.what()));
  }
  edited();
}

void ProjectModel::reset(const std::string& key) {
  project_->reset(key);
  edited();
}

void ProjectModel::setPreset(const std::string& name) {
  try {
    project_->setPreset(name);
  } catch (const Error& e) {
    Q_EMIT failed("This preset was not taken", QString::fromStdString(e.what()));
  }
  edited();
}

void ProjectModel::setEnvironment(const fs::path& file) {
  project_->setEnvironment(file);
  edited();
}

bool ProjectModel::save() {
  try {
    if (on_disk_ && !Project::isProject(project_->folder())) {
      throw Error(
          Error::Kind::Storage,
          fmt::format("\"{}\" is not there any more: put it back, then save again. No second one is made "
                      "in its place.",
                      project_->folder().string()));
    }
    const bool by_others = project_->save();
    if (by_others) capture_ = std::make_shared<const CaptureSet>(project_->capture());
    on_disk_ = true;
    unsaved_ = false;
    edited_ = false;
    autosave_.stop();
    if (by_others) refresh(true);
    Q_EMIT settingsChanged();
    return true;
  } catch (const Error& e) {
    Q_EMIT failed(kProjectNotSaved, QString::fromStdString(e.what()));
    return false;
  }
}

void ProjectModel::saveQuietly() {
  if (project_ && unsaved_) save();
}

void ProjectModel::refresh(bool pictures) {
  if (!project_ || !capture_there_) return;
  pictures_due_ = pictures_due_ || pictures;
  const std::uint64_t ticket = ++states_ticket_;
  states_worker_.submit(
      [this, project = shownProject(), surveyor = surveyor_, ticket, look = pictures_due_]() mutable {
        auto result = std::make_shared<Surveyed>();
        result->ticket = ticket;
        result->pictures = look;
        try {
          project.readTakesAgain();  // runs change them
          if (look) surveyor->forgetKeys();
          result->survey = std::make_shared<const TakeSurvey>(surveyor->survey(project));
          result->project = std::make_shared<const Project>(project);
          result->sequence = sequenceOf(project, Shows::Newest, result->survey);
        } catch (const std::exception& e) {  // the border of this thread: said in the window
          result->error = QString::fromStdString(e.what());
        }
        QMetaObject::invokeMethod(
            this, [this, result] { take(result); }, Qt::QueuedConnection);
      });
}

void ProjectModel::take(const std::shared_ptr<Surveyed>& result) {
  if (result->ticket != states_ticket_) return;
  states_seen_ = result->ticket;
  if (result->pictures) pictures_due_ = false;
  if (!result->survey) {
    ready_ = true;
    Q_EMIT failed("The state of the project cannot be read", result->error);
    return;
  }
  survey_ = result->survey;
  project_->adoptTakes(*result->project);
  if (run_project_) run_project_->adoptTakes(*result->project);
  sequence_ = result->sequence;
  showStages();
  if (start_open_) startAtFirstSolved();
  showFrame();
  Q_EMIT memoryChanged();
}

void ProjectModel::startAtFirstSolved() {
  start_open_ = false;
  const auto solved = std::find_if(survey_->stamps.begin(), survey_->stamps.end(),
                                   [](const Digest& stamp) { return stamp != Digest{}; });
  if (solved != survey_->stamps.end())
    setFrame(FrameIndex{static_cast<std::int32_t>(solved - survey_->stamps.begin())});
}

void ProjectModel::showStages() {
  if (!survey_) return;
  stages_ = stageStatus(*survey_, services_.pipeline->stages.infos(), frame_);
  if (!capture_there_) {
    for (StageStatus& stage : stages_) {
      stage.state = StepState::Blocked;
      stage.detail = "The capture is not where it was.";
      stage.to_do += std::exchange(stage.running, 0);  // of a run that ended with it
    }
  }
  Q_EMIT stagesChanged();
}

// The nearest frame that has something to show, the earlier of two; while that is not known the frame itself.
std::optional<FrameIndex> ProjectModel::frameWithResults() const {
  const int frames = frameCount();
  if (frames > 0 && !sequence_->stamp(frame_)) return frame_;
  for (int away = 0; away < frames; ++away) {
    for (const int f : {frame_.value - away, frame_.value + away}) {
      if (f < 0 || f >= frames) continue;
      const FrameIndex frame{f};
      if (sequence_->stamp(frame) != Digest{} && !cache_.isBlank(*sequence_, frame)) return frame;
    }
  }
  return std::nullopt;
}

void ProjectModel::want(FrameIndex first) {
  std::vector<SequenceFrame> wishes{{sequence_, first}};
  for (const FrameIndex frame : prefetch_) wishes.push_back({sequence_, frame});
  cache_.want(std::move(wishes));
}

void ProjectModel::showFrame() {
  const std::optional<FrameIndex> source = frameWithResults();
  FrameValues found;
  if (source) {
    want(*source);
    const std::optional<FrameCache::Found> held = cache_.find(*sequence_, *source);
    ready_ = held && held->current;
    if (!ready_) return;
    const bool known = sequence_->stamp(*source).has_value();
    if (known && cache_.isBlank(*sequence_, *source)) return showFrame();  // with the next nearest
    found = held->values;
    const QString error = QString::fromStdString(held->error);
    if (!error.isEmpty() && error != told_error_)
      Q_EMIT failed("The results of this frame cannot be read", error);
    told_error_ = error;
  }
  ready_ = true;
  const bool own = source == frame_;
  const FrameValues& before = held_ ? held_->values : values_;
  const bool same = values_of_ == frame_ && own != held_.has_value() && before.cloud == found.cloud &&
                    before.materials == found.materials;
  if (same) return loadMesh();
  values_of_ = frame_;
  values_ = own ? found : FrameValues{};
  held_.reset();
  if (!own && source) held_ = HeldValues{*source, found};
  Q_EMIT valuesChanged();
  loadMesh();
}

void ProjectModel::prefetch(std::vector<FrameIndex> frames) {
  prefetch_ = std::move(frames);
  if (sequence_) want(frameWithResults().value_or(frame_));
}

void ProjectModel::setPassing(bool passing) {
  passing_ = passing;
  if (!passing_ && sequence_ && ready_) loadMesh();
}

void ProjectModel::loadMesh() {
  if (passing_ || !values_.cloud) {
    mesh_seen_ = ++mesh_ticket_;
    return;
  }
  const std::uint64_t ticket = ++mesh_ticket_;
  mesh_worker_.submit([this, sequence = sequence_, frame = frame_, ticket] {
    std::shared_ptr<const Mesh> mesh;
    QString error;
    try {
      mesh = sequence->mesh(frame);
    } catch (const std::exception& e) {  // the border of this thread: said in the window
      error = QString::fromStdString(e.what());
    }
    QMetaObject::invokeMethod(
        this,
        [this, mesh, error, ticket] {
          if (ticket != mesh_ticket_) return;
          mesh_seen_ = ticket;
          if (!error.isEmpty()) Q_EMIT failed("The mesh of this frame cannot be read", error);
          if (!mesh && !values_.mesh) return;
          values_.mesh = mesh;
          Q_EMIT valuesChanged();
        },
        Qt::QueuedConnection);
  });
}

}  // namespace beam
