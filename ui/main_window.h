// SPDX-License-Identifier: Apache-2.0
// The studio's window: rail and run bar on top, views in the middle, project, inspector and log in docks. It
// wires the parts to each other; each part knows its own subject.
#pragma once

#include <QMainWindow>

#include "ui/job_bridge.h"
#include "ui/light_library.h"
#include "ui/project_model.h"
#include "ui/sample_maker.h"
#include "viewers/view_state.h"

class QLabel;
class QStackedWidget;
class QTabBar;

namespace beam {

class ImagePage;
class LogPanel;
class MessagePanel;
class ProjectPanel;
class RunBar;
class SceneView;
class SettingsPanel;
class SplatView;
class StageRail;
class StartPage;

enum class StudioView { Splat, Image, Scene };
std::optional<StudioView> studioViewNamed(std::string_view name);  // "splat", "image", "scene"

class MainWindow final : public QMainWindow {
  Q_OBJECT

 public:
  enum class Layout { Remembered, Fresh };
  MainWindow(StudioServices services, Layout layout);
  ~MainWindow() override;

  // A capture, a project or a panorama.
  void open(const std::filesystem::path& path);
  void showView(StudioView view);
  // The current frame, or all; `until` empty: every stage.
  void run(const std::string& until = {}, bool all_frames = false);
  void cancelRun();

  ProjectModel& model() { return model_; }
  LightLibrary& lights() { return lights_; }
  JobBridge& job() { return job_; }
  SplatView& splatView() { return *splat_; }
  ImagePage& imagePage() { return *images_; }
  SceneView& sceneView() { return *scene_; }
  StageRail& rail() { return *rail_; }
  RunBar& runBar() { return *run_bar_; }
  SettingsPanel& settings() { return *settings_; }
  MessagePanel& message() { return *message_; }
  // Nothing is being read, computed (a run aside) or drawn any more.
  bool settled() const;

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void closeEvent(QCloseEvent* event) override;

 private:
  void makeParts();
  void makeCentre();
  void makeDocks();
  void makeMenus();
  void connectModel();
  void connectViews();
  void connectJob();

  void showOpened();
  void showValues();
  void showStages();
  void showFinished(const JobFinished& outcome);
  void showTitle();
  void showStatus();
  void say(const QString& title, const QString& text);

  void openCapture();
  void openProject();
  void openSample();
  void openLight();
  void savePicture();
  void remember(const QString& folder);
  void restoreLayout();
  QByteArray freshState() const { return fresh_state_; }

  StudioServices services_;
  ProjectModel model_;
  LightLibrary lights_;
  JobBridge job_;
  SampleMaker sample_;
  Layout layout_;
  bool previewing_ = false;

  StageRail* rail_ = nullptr;
  RunBar* run_bar_ = nullptr;
  MessagePanel* message_ = nullptr;
  QTabBar* view_tabs_ = nullptr;
  QStackedWidget *centre_ = nullptr, *views_ = nullptr;
  StartPage* start_ = nullptr;
  SplatView* splat_ = nullptr;
  ImagePage* images_ = nullptr;
  SceneView* scene_ = nullptr;
  ProjectPanel* project_panel_ = nullptr;
  SettingsPanel* settings_ = nullptr;
  LogPanel* log_ = nullptr;
  QLabel *reading_ = nullptr, *state_words_ = nullptr;
  QByteArray fresh_state_;
};

}  // namespace beam
