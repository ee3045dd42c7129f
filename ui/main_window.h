// SPDX-License-Identifier: Apache-2.0
// The studio's window: rail and run bar on top, views in the middle, project, inspector and log in docks. It
// wires the parts to each other; each part knows its own subject. Its own code by subject: main_window.cpp
// lays out, _commands what can be done and when, _files opening, saving and closing, _run what runs, _work
// what is made of solved frames, _wiring who hears whom.
#pragma once

#include <QMainWindow>

#include "ui/background_task.h"
#include "ui/capture_watch.h"
#include "ui/command_table.h"
#include "ui/job_bridge.h"
#include "ui/joint_source.h"
#include "ui/light_library.h"
#include "ui/player.h"
#include "ui/problem_list.h"
#include "ui/project_model.h"
#include "ui/run_forecast.h"
#include "ui/scout_dialog.h"
#include "ui/session_memory.h"
#include "ui/studio_view.h"
#include "ui/theme.h"
#include "ui/timeline_lanes.h"
#include "viewers/view_state.h"

class QDockWidget;
class QMenu;
class QMenuBar;
class QStackedWidget;
class QTabBar;
class QTabWidget;

namespace beam {

class DisplayPanel;
class ElidedLabel;
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

enum class RunScope { Frame, Range, Take, Scout };
std::optional<RunScope> runScopeNamed(std::string_view name);      // "frame", "range", "take", "scout"
std::optional<StudioView> studioViewNamed(std::string_view name);  // "splat", "image", "scene"

class MainWindow final : public QMainWindow {
  Q_OBJECT

 public:
  enum class Layout { Remembered, Fresh };
  MainWindow(StudioServices services, Layout layout);
  ~MainWindow() override;

  // A capture, a project or a panorama. `project`: where the project of a capture is to lie; empty: beside
  // it.
  void open(const std::filesystem::path& path, const std::filesystem::path& project = {});
  void showView(StudioView view);
  // `until` empty: every stage. `every`: of a scout, which takes every so manieth frame of the range. Starts
  // nothing, and says why, where it cannot.
  void run(const std::string& until = {}, RunScope scope = RunScope::Frame, int every = kScoutEvery);
  void cancelRun();
  // Colours and text size, of the whole program; as chosen last.
  void chooseLook(Theme theme, int text_percent);
  void recallLook();
  // A fault of the program that it survived.
  void tellOfFault(const QString& what);
  // Whether a person is asked before a run is left by closing; yes unless told otherwise.
  void setAsksBeforeClosing(bool asks) { asks_before_closing_ = asks; }

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
  CommandTable& commands() { return commands_; }
  // Nothing is being read, computed (a run aside) or drawn any more.
  bool settled() const;
  // What is in view is of a run that goes on or was stopped, not a result.
  bool showsPreview() const { return previewWins(); }

 protected:
  bool event(QEvent* event) override;
  bool focusNextPrevChild(bool next) override;
  void keyPressEvent(QKeyEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void closeEvent(QCloseEvent* event) override;

 private:
  struct Look {
    Theme theme = Theme::Dark;
    int text_percent = 100;
  };
  // The Gaussians of a run that is going on or was cancelled, and the frame they are of.
  struct Preview {
    std::shared_ptr<const GaussianCloud> cloud;
    int frame = -1;
    bool live = false;  // false: what a cancelled run left, until the next one
  };

  // --- Layout ---
  void makeParts();
  void makeTop();
  void makeCentre();
  void makeDocks();
  void fitToScreen();
  void restoreLayout();
  void recallTimes();
  // The panels are of a project: the start page has the window to itself.
  void showPanels(bool shown);
  void sizePanels();

  // --- Commands: what can be done and why not ---
  void makeCommands();
  void addFileCommands();
  void addProcessCommands();
  void addWorkCommands();
  void addViewCommands();
  void addCameraCommands();
  void addLookCommands();
  void resetLayout();
  void makeMenus();
  void fillRecent();
  void refreshCommands();
  QString refusalToOpen() const;
  QString refusalToSample() const;
  QString refusalToRun() const;
  QString refusalToWork() const;
  QString refusalToEvaluate() const;
  QString refusalToReport() const;
  QString refusalWithoutProject() const;
  QString refusalToStop() const;
  QString refusalToMoveCamera() const;
  bool showsNoGaussians() const;
  QString refusalToSavePicture() const;
  void toggleFullScreen();

  // --- Files ---
  void newProject();
  void openCapture();
  void openProject();
  void openSample();
  // `what` is made: "The sample". The rest is BackgroundTask's.
  template <class Work, class Then>
  void startTask(const QString& what, Work work, Then then) {
    task_words_ = what;
    task_.start(std::move(work), std::move(then));
    showTaskStarted();
  }
  void showTaskStarted();
  void openLight();
  void chooseCaptureLight();
  bool takeOverSettings(const QString& what_waits);
  bool settingsMayGo();
  void saveSettings();
  void saveAs();
  void locateCapture();
  void askForAnotherCapture(const QString& folder, const QString& difference);
  void chooseVersion(const std::filesystem::path& folder);
  void savePicture();
  void closeProject();
  void showOpened();
  void showClosed();
  void showCaptureLost();
  void resetViews();
  QImage viewPicture();
  void rememberProject();
  void keepRecent();
  void showRecent();
  bool mayClose();

  // --- Runs ---
  void scout();
  RunRequest requestOf(const std::string& until, RunScope scope, int every) const;
  void stopAfter(StopAfter what);
  void askForecast();
  void showForecast();
  void showRunning(const std::string& stage, std::optional<FrameIndex> frame);
  void showFinished(const JobFinished& outcome);
  void takePreview(const JobPreview& preview);
  bool previewWins() const;

  // --- Work on solved frames ---
  void evaluateHeldOut();
  void writeReport();

  // --- Who hears whom ---
  void connectModel();
  void connectViews();
  void connectJob();
  void connectTask();
  void connectWatch();
  void connectPlayer();

  void showValues();
  void showValuesIn(StudioView view);
  void showSplats();
  Lighting lighting() const;  // as the project says, but for its turn
  void lightImages();
  void showCamera(ViewIndex view);
  void showPlaying();
  StudioView shownView() const;
  QWidget* viewWidget() const;
  bool viewSettled() const;
  bool viewFollows() const;
  void showStages();
  void showTitle();
  void showStatus();
  // `remedy`: a command that helps.
  void say(const QString& title, const QString& told, QAction* remedy = nullptr);
  // What it said is mended.
  void unsay(const QStringList& titles);
  void warn(const QString& text);
  Problem problemOf(Problem::Kind kind, const QString& text) const;
  void showProblems();

  StudioServices services_;
  SessionMemory memory_;
  ProjectModel model_;
  LightLibrary lights_;
  JobBridge job_;
  QString task_words_;   // what the task makes: "The sample"
  BackgroundTask task_;  // a sample being made, a copy or a report being written, frames being scored
  Player player_;
  JointSource joints_;
  CommandTable commands_;
  RunOverlay run_;  // the run that is going on
  Preview preview_;
  Look look_;
  std::optional<ViewIndex> looked_through_;  // in the splat view
  ProblemList problems_;
  RunForecast forecast_;
  CaptureWatch watch_;
  std::filesystem::path
      broken_;                // a project that could not be read; empty: none, or another was opened since
  bool quick_first_ = false;  // the project that is being opened begins with the quick preset
  bool held_out_ = false;     // the capture has photographs to score against
  bool stopping_ = false;     // the run was told to stop now
  bool full_size_play_ = false, asks_before_closing_ = true, was_maximized_ = false;
  int scout_every_ = kScoutEvery;  // last chosen

  StageRail* rail_ = nullptr;
  RunBar* run_bar_ = nullptr;
  MessagePanel* message_ = nullptr;
  QMenuBar* menus_ = nullptr;
  QMenu* recent_ = nullptr;
  QTabBar* view_tabs_ = nullptr;
  QStackedWidget *centre_ = nullptr, *views_ = nullptr;
  StartPage* start_ = nullptr;
  SplatView* splat_ = nullptr;
  ImagePage* images_ = nullptr;
  SceneView* scene_ = nullptr;
  ProjectPanel* project_panel_ = nullptr;
  QTabWidget* inspector_ = nullptr;
  DisplayPanel* display_ = nullptr;
  SettingsPanel* settings_ = nullptr;
  LogPanel* log_ = nullptr;
  QDockWidget* problems_dock_ = nullptr;
  TimelinePanel* timeline_ = nullptr;
  ElidedLabel *reading_ = nullptr, *state_words_ = nullptr;
  QByteArray fresh_state_;
  QByteArray panels_state_;  // of the panels while they are hidden
};

}  // namespace beam
