// SPDX-License-Identifier: Apache-2.0
// How long a person waits for the window: start, first picture of a project, another frame, another channel.
// Says milliseconds, one line each; studio_times.sh compares two of these programs. It uses only what the
// window has had for long, so that it builds in a tree of before, too.
#include <QApplication>
#include <QElapsedTimer>
#include <QSurfaceFormat>
#include <QWindow>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "app/services.h"
#include "core/render/cpu_scene_renderer.h"
#include "tests/support/wait_for.h"
#include "ui/main_window.h"
#include "ui/theme.h"
#include "viewers/gl/functions.h"
#include "viewers/splat/splat_view.h"

namespace {

using beam::testing::waitFor;

constexpr int kRounds = 5;
constexpr QSize kWindow{1400, 900};

double milliseconds(const QElapsedTimer& since) { return 1e-6 * static_cast<double>(since.nsecsElapsed()); }

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// Since the moment that whoever started this program has noted.
double sinceStart() {
  const char* noted = std::getenv("BEAM_STARTED_NS");
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
  return noted ? 1e-6 * static_cast<double>(now_ns - std::atoll(noted)) : 0;
}

template <class Act>
double timeUntilSettled(beam::MainWindow& window, Act&& act) {
  QElapsedTimer timer;
  timer.start();
  act();
  if (!waitFor([&] { return window.settled(); }, 60000)) std::fprintf(stderr, "error: not settled in 60 s\n");
  return milliseconds(timer);
}

void say(const char* what, double ms) { std::printf("%s\t%.2f\n", what, ms); }

int measure(const char* project) {
  const beam::Services services = beam::makeServices();
  beam::MainWindow window({.pipeline = services.pipeline,
                           .job_device = beam::makeDevice({}),
                           .new_renderer = beam::cpuSceneRenderers(beam::makeDevice({}), 2),
                           .make_sample = {},
                           .version = "bench"},
                          beam::MainWindow::Layout::Fresh);
  window.resize(kWindow);
  window.show();
  waitFor([&] { return window.windowHandle() && window.windowHandle()->isExposed(); });
  QApplication::processEvents();  // it is painted
  say("start to window", sinceStart());
  if (!project) return 0;
  QElapsedTimer opening;
  opening.start();
  window.open(project);
  const bool there = waitFor(
      [&] { return window.model().isOpen() && window.settled() && window.model().values().cloud; }, 60000);
  if (!there) {
    std::fprintf(stderr, "error: \"%s\" shows no Gaussians; a project with solved frames is expected\n",
                 project);
    return 1;
  }
  say("project to first picture", milliseconds(opening));
  const int frames = static_cast<int>(window.model().capture()->frames.size());
  std::vector<double> frame_ms, channel_ms;
  for (int round = 0; round < kRounds; ++round) {
    for (int f = frames - 1; f >= 0; --f)
      frame_ms.push_back(timeUntilSettled(window, [&] { window.player().goTo(f); }));
    const auto& channels = beam::shownChannels();
    for (auto c = channels.rbegin(); c != channels.rend(); ++c)
      channel_ms.push_back(timeUntilSettled(window, [&] { window.splatView().setChannel(*c); }));
  }
  say("frame change", median(frame_ms));
  say("channel change", median(channel_ms));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  QSurfaceFormat::setDefaultFormat(beam::surfaceFormat());
  QApplication::setAttribute(Qt::AA_ShareOpenGLContexts);
  QApplication application(argc, argv);
  if (argc > 2) {
    std::fprintf(stderr, "usage: studio_times [PROJECT.beam]   (without: the start alone)\n");
    return 2;
  }
  beam::applyTheme(application);
  return measure(argc == 2 ? argv[1] : nullptr);
}
