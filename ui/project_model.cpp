// SPDX-License-Identifier: Apache-2.0
#include "ui/project_model.h"

#include <fmt/format.h>
#include <unistd.h>

#include <QStandardPaths>

#include "core/base/error.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr int kAutosave_ms = 800;

Project projectOfCapture(const fs::path& capture, const std::shared_ptr<const PipelineSetup>& setup) {
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

std::vector<StageStatus> statusOf(const Project& project, FrameIndex shown) {
  std::vector<StageStatus> all;
  const int frames = static_cast<int>(project.capture().frames.size());
  for (const StageInfo& info : project.setup().stages.infos()) {
    StageStatus status{.id = info.id,
                       .title = QString::fromStdString(info.title),
                       .summary = QString::fromStdString(info.summary),
                       .frames = frames,
                       .detail = QString::fromStdString(project.blockedReason(info.id))};
    for (int f = 0; f < frames; ++f) {
      const StepState state = project.stageState(info.id, FrameIndex{f});
      if (state == StepState::Done) ++status.done;
      if (f == shown.value) status.state = state;
    }
    for (const StepInfo& step : info.steps) {
      if (status.state != StepState::Failed) break;
      const std::string why = project.failureOf(info.id + "." + step.id, shown);
      if (!why.empty()) status.detail = QString::fromStdString(why);
    }
    all.push_back(std::move(status));
  }
  return all;
}

FrameValues valuesOf(const Project& project, FrameIndex frame) {
  FrameValues values;
  if (std::optional<FrameResult> result = loadFrameResult(project, frame)) {
    values.cloud = std::make_shared<const GaussianCloud>(std::move(result->cloud));
    if (result->materials)
      values.materials = std::make_shared<const Materials>(std::move(*result->materials));
  }
  if (std::optional<Mesh> mesh = loadFrameMesh(project, frame)) {
    values.mesh = std::make_shared<const Mesh>(std::move(*mesh));
  }
  return values;
}

}  // namespace

struct ProjectModel::Opened {
  fs::path path;
  std::optional<Project> project;
  std::shared_ptr<const CaptureSet> capture;
  QString error;
};

fs::path projectFolderFor(const fs::path& capture) {
  const fs::path folder = fs::absolute(capture / "").lexically_normal().parent_path();
  const fs::path name = folder.filename().string() + ".beam";
  if (::access(folder.parent_path().c_str(), W_OK) == 0) return folder.parent_path() / name;
  return fs::path(QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation).toStdString()) / name;
}

ProjectModel::ProjectModel(StudioServices services, QObject* parent)
    : QObject(parent), services_(std::move(services)) {
  autosave_.setSingleShot(true);
  autosave_.setInterval(kAutosave_ms);
  connect(&autosave_, &QTimer::timeout, this, &ProjectModel::saveQuietly);
}

ProjectModel::~ProjectModel() {
  if (autosave_.isActive()) saveQuietly();
}

void ProjectModel::open(const fs::path& path) {
  opening_ = true;
  Q_EMIT openingStarted(QString::fromStdString(path.string()));
  open_worker_.submit([this, path, setup = services_.pipeline] {
    auto result = std::make_shared<Opened>();
    result->path = path;
    try {
      if (!fs::exists(path)) {
        throw Error(
            Error::Kind::Data,
            fmt::format("\"{}\" does not exist; choose a capture folder or a project", path.string()));
      }
      result->project = Project::isProject(path) ? Project::open(path, setup) : projectOfCapture(path, setup);
      result->capture = std::make_shared<const CaptureSet>(result->project->capture());
    } catch (const std::exception& e) {  // the border of this thread: said in the window
      result->error = QString::fromStdString(e.what());
    }
    QMetaObject::invokeMethod(
        this, [this, result] { adopt(result); }, Qt::QueuedConnection);
  });
}

void ProjectModel::adopt(const std::shared_ptr<Opened>& result) {
  opening_ = false;
  if (!result->error.isEmpty()) {
    Q_EMIT failed("Cannot open " + QString::fromStdString(result->path.filename().string()), result->error);
    return;
  }
  if (autosave_.isActive()) saveQuietly();
  autosave_.stop();
  project_.reset();
  project_.emplace(std::move(*result->project));
  capture_ = result->capture;
  frame_ = FrameIndex{0};
  stages_.clear();
  values_ = {};
  unsaved_ = !Project::isProject(project_->folder());
  Q_EMIT opened();
  refresh();
}

QString ProjectModel::frameName() const {
  if (!capture_ || capture_->frames.empty()) return {};
  return QString::fromStdString(capture_->frames[frame_.value]);
}

void ProjectModel::setFrame(FrameIndex frame) {
  if (frame == frame_) return;
  frame_ = frame;
  Q_EMIT frameChanged();
  refresh();
}

void ProjectModel::edited() {
  unsaved_ = true;
  // A project that is not on disk yet stays in memory until it is run or saved.
  if (Project::isProject(project_->folder()) && !project_->readOnly()) autosave_.start();
  Q_EMIT settingsChanged();
  refresh(false);
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
    project_->save();
    unsaved_ = false;
    autosave_.stop();
    Q_EMIT settingsChanged();
    return true;
  } catch (const Error& e) {
    Q_EMIT failed("The project was not saved", QString::fromStdString(e.what()));
    return false;
  }
}

void ProjectModel::saveQuietly() {
  if (project_ && unsaved_) save();
}

void ProjectModel::refresh(bool values) {
  if (!project_) return;
  const std::uint64_t states_ticket = ++states_ticket_;
  states_worker_.submit([this, project = *project_, frame = frame_, states_ticket] {
    std::vector<StageStatus> stages;
    QString error;
    try {
      stages = statusOf(project, frame);
    } catch (const std::exception& e) {
      error = QString::fromStdString(e.what());
    }
    QMetaObject::invokeMethod(
        this,
        [this, stages, error, states_ticket] {
          if (states_ticket != states_ticket_) return;
          states_seen_ = states_ticket;
          if (!error.isEmpty()) Q_EMIT failed("The state of the project cannot be read", error);
          stages_ = stages;
          Q_EMIT stagesChanged();
        },
        Qt::QueuedConnection);
  });
  if (!values) return;
  const std::uint64_t values_ticket = ++values_ticket_;
  values_worker_.submit([this, project = *project_, frame = frame_, values_ticket] {
    FrameValues found;
    QString error;
    try {
      found = valuesOf(project, frame);
    } catch (const std::exception& e) {
      error = QString::fromStdString(e.what());
    }
    QMetaObject::invokeMethod(
        this,
        [this, found, error, values_ticket] {
          if (values_ticket != values_ticket_) return;
          values_seen_ = values_ticket;
          if (!error.isEmpty()) Q_EMIT failed("The results of this frame cannot be read", error);
          values_ = found;
          Q_EMIT valuesChanged();
        },
        Qt::QueuedConnection);
  });
}

}  // namespace beam
