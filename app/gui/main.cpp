// SPDX-License-Identifier: Apache-2.0
// beam-studio: puts the window together with the stages, the device and the sample, and runs it.
#include <QApplication>
#include <QMessageBox>

#include <cstdio>
#include <string>
#include <utility>

#include "app/gui/errand.h"
#include "app/gui/widget_map.h"
#include "app/services.h"
#include "core/base/error.h"
#include "core/io/capture_check.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/sample/make_sample.h"
#include "ui/theme.h"
#include "viewers/gl/functions.h"

namespace {

// What a handler of an event throws would end the process; it is said, and the window goes on.
class StudioApplication final : public QApplication {
 public:
  using QApplication::QApplication;
  void setWindow(beam::MainWindow* window) { window_ = window; }
  bool notify(QObject* receiver, QEvent* event) override {
    try {
      return QApplication::notify(receiver, event);
    } catch (const std::exception& e) {
      if (!window_) throw;
      // One that comes back with every picture is said once.
      if (std::exchange(told_, e.what()) != e.what()) {
        std::fprintf(stderr, "error: %s\n", e.what());
        window_->tellOfFault(e.what());
      }
      return true;
    }
  }

 private:
  beam::MainWindow* window_ = nullptr;
  std::string told_;
};

constexpr std::size_t kViewSizes = 2;  // of the moving and of the resting picture
constexpr int kSampleFrames = 4;       // enough to play, and to see the tracking

// Without a picture to take there is a person before the screen; say it in a window, too.
int report(const beam::Error& error, bool person) {
  std::fprintf(stderr, "error: %s\n", error.what());
  if (person) QMessageBox::critical(nullptr, "BEAM Studio cannot start", error.what());
  return beam::exitCode(error.kind());
}

int runStudio(StudioApplication& application) {
  beam::StudioArguments arguments;
  try {
    arguments = beam::parseArguments(application);
  } catch (const beam::Error& e) {
    return report(e, false);
  }
  const bool person = arguments.screenshot.isEmpty() && QGuiApplication::platformName() != "offscreen";
  try {
    beam::requireOpenGl();
    const beam::Services services = beam::makeServices();
    beam::StudioServices studio{
        .pipeline = services.pipeline,
        .job_device = beam::makeDevice(arguments.device),
        .new_renderer = beam::cpuSceneRenderers(beam::makeDevice(arguments.device), kViewSizes),
        .make_sample =
            [](const std::filesystem::path& folder, beam::Progress& progress) {
              beam::makeSample(folder, {.frames = kSampleFrames}, progress);
            },
        .check_capture =
            [](const std::filesystem::path& folder, const beam::ImportOptions& options,
               beam::Progress& progress) { return beam::checkPath(folder, options, &progress).warnings; },
        .version = beam::versionText(),
        .frame_memory_bytes = static_cast<std::uint64_t>(1e6 * arguments.frame_memory_mb),
    };
    beam::applyTheme(application, arguments.theme, arguments.text_percent / 100.0);
    beam::MainWindow window(std::move(studio),
                            person ? beam::MainWindow::Layout::Remembered : beam::MainWindow::Layout::Fresh);
    if (person && !arguments.look_given) window.recallLook();
    window.show();
    const beam::Errand errand(window, arguments);
    const auto map = beam::widgetMapWanted();
    application.setWindow(&window);
    const int code = QApplication::exec();
    application.setWindow(nullptr);
    return code;
  } catch (const beam::Error& e) {
    return report(e, person);
  }
}

// Qt aborts the process when it finds no display; offscreen, --help and --version still answer, and all else
// ends in requireOpenGl's message.
void surviveWithoutDisplay() {
#ifdef Q_OS_LINUX
  const bool display = qEnvironmentVariableIsSet("DISPLAY") || qEnvironmentVariableIsSet("WAYLAND_DISPLAY");
  if (!display && !qEnvironmentVariableIsSet("QT_QPA_PLATFORM")) qputenv("QT_QPA_PLATFORM", "offscreen");
#endif
}

}  // namespace

int main(int argc, char** argv) {
  surviveWithoutDisplay();
  QSurfaceFormat::setDefaultFormat(beam::surfaceFormat());
  QApplication::setAttribute(Qt::AA_ShareOpenGLContexts);
  StudioApplication application(argc, argv);
  QApplication::setOrganizationName("BEAM Studio");
  QApplication::setApplicationName("beam-studio");
  QApplication::setApplicationVersion(beam::versionText());
  return runStudio(application);
}
