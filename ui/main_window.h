// SPDX-License-Identifier: Apache-2.0
// The studio's window: rail and run bar on top, views in the middle, project, inspector and log in docks. It
// wires the parts to each other; each part knows its own subject.
#pragma once

#include <QMainWindow>

#include "ui/job_bridge.h"
#include "ui/joint_source.h"
#include "ui/light_library.h"
#include "ui/player.h"
#include "ui/project_model.h"
#include "ui/sample_maker.h"
#include "ui/scout_dialog.h"
#include "ui/timeline_lanes.h"
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
class TimelinePanel;

enum class StudioView { Splat, Image, Scene };
enum class RunScope { Frame, Range, Take, Scout };
std::optional<RunScope> runScopeNamed(std::string_view name);      // "frame", "range", "take", "scout"
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
  // `until` empty: every stage. `every`: of a scout, which takes every so manieth frame of the range.
  void run(const std::string& until = {}, RunScope scope = RunScope::Frame, int every = kScoutEvery);
  void cancelRun();

  ProjectModel& model() { return model_; }
  LightLibrary& lights() { return lights_; }
  JobBridge& job() { return job_; }
  SplatView& splatView() { return *splat_; }
  ImagePage& imagePage() { return *images_; }
  SceneView& sceneView() { return *scene_; }
  Player& player() { return player_; }
  JointSource& joints() { return joints_; }
  TimelinePanel& timeline() { return *timeline_; }
  // Pictures at full size while playing, too, however slow.
  void setFullSizePlay(bool full) { full_size_play_ = full; }
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
  void connectPlayer();

  void showOpened();
  void showValues();
  void showValuesIn(StudioView view);
  void showPlaying();
  void showRunning(const std::string& stage, std::optional<FrameIndex> frame);
  StudioView shownView() const;
  bool viewSettled() const;
  bool viewFollows() const;
  void showStages();
  void showFinished(const JobFinished& outcome);
  void showTitle();
  void showStatus();
  void say(const QString& title, const QString& text);

  void scout();
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
  Player player_;
  JointSource joints_;
  Layout layout_;
  RunOverlay run_;           // the run that is going on
  bool previewing_ = false;  // of the shown frame
  bool full_size_play_ = false;
  int scout_every_ = kScoutEvery;  // last chosen

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
  TimelinePanel* timeline_ = nullptr;
  QLabel *reading_ = nullptr, *state_words_ = nullptr;
  QByteArray fresh_state_;
};

}  // namespace beam
