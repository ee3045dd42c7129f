// SPDX-License-Identifier: Apache-2.0
#include "app/gui/errand.h"

#include <QApplication>
#include <QPixmap>

#include <algorithm>
#include <cstdio>

#include "ui/image_page.h"
#include "ui/message_panel.h"
#include "ui/stage_rail.h"
#include "ui/timeline_panel.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

constexpr int kTick_ms = 50;
constexpr int kCalm_ms = 300;  // nothing new for that long: the window is what it will be
constexpr float kDegrees = 180 / kPi;

}  // namespace

Errand::Errand(MainWindow& window, const StudioArguments& arguments)
    : window_(window), arguments_(arguments) {
  connect(&window_.model(), &ProjectModel::opened, this, [this] {
    if (!shown_) show();
  });
  connect(&window_.model(), &ProjectModel::valuesChanged, this, [this] {
    if (values_came_) return;
    values_came_ = true;
    if (!arguments_.left.isEmpty()) window_.imagePage().choosePictures(arguments_.left, arguments_.right);
  });
  if (!arguments_.screenshot.isEmpty()) window_.setAsksBeforeClosing(false);
  timer_.setInterval(kTick_ms);
  connect(&timer_, &QTimer::timeout, this, &Errand::tick);
  window_.showView(arguments_.view);
  if (!arguments_.path.isEmpty()) window_.open(arguments_.path.toStdString());
  window_.setFullSizePlay(arguments_.full_size);
  if (!arguments_.screenshot.isEmpty() || arguments_.play_s > 0) timer_.start();
}

std::optional<ViewIndex> Errand::cameraNamed(const QString& name) const {
  const auto& views = window_.model().capture()->views;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].name == name.toStdString()) return ViewIndex{static_cast<std::int32_t>(i)};
  }
  return std::nullopt;
}

std::optional<FrameIndex> Errand::frameNamed(const QString& name) const {
  const ProjectModel& model = window_.model();
  for (FrameIndex f{0}; f.value < model.frameCount(); ++f.value) {
    if (model.nameOf(f) == name) return f;
  }
  return std::nullopt;
}

void Errand::show() {
  shown_ = true;
  const QString* const names[] = {&arguments_.frame, &arguments_.in, &arguments_.out};
  for (const QString* name : names) {
    if (!name->isEmpty() && !frameNamed(*name)) return giveUp("the capture has no frame \"" + *name + "\"");
  }
  if (!arguments_.in.isEmpty()) window_.player().setIn(frameNamed(arguments_.in)->value);
  if (!arguments_.out.isEmpty()) window_.player().setOut(frameNamed(arguments_.out)->value);
  if (!arguments_.frame.isEmpty()) window_.model().setFrame(*frameNamed(arguments_.frame));
  SplatView& splats = window_.splatView();
  splats.setChannel(arguments_.channel);
  splats.setYaw(static_cast<float>(arguments_.yaw_deg) / kDegrees);
  splats.setSky(arguments_.sky);
  if (arguments_.photo >= 0) splats.setPhotoOpacity(static_cast<float>(arguments_.photo));
  if (!arguments_.camera.isEmpty()) {
    const auto view = cameraNamed(arguments_.camera);
    if (!view) return giveUp("the capture has no camera \"" + arguments_.camera + "\"");
    splats.lookThrough(view);
    window_.imagePage().choose(*view);
  }
  if (arguments_.mesh) {
    window_.sceneView().setLayerShown(SceneLayer::Mesh, true);
    window_.sceneView().setLayerShown(SceneLayer::Gaussians, false);
    window_.sceneView().setLayerShown(SceneLayer::SeedPoints, false);
  }
  if (!arguments_.environment.isEmpty()) window_.open(arguments_.environment.toStdString());
  if (!arguments_.select.isEmpty()) window_.rail().select(arguments_.select.toStdString());
  if (arguments_.run) {
    window_.run(arguments_.until.toStdString(), arguments_.scope, arguments_.every);
    run_started_ = true;
  }
}

// Before the picture is taken, so that it shows the window at play.
bool Errand::playing() {
  if (arguments_.play_s <= 0 || played_) return false;
  if (!play_since_.isValid()) {
    play_since_.start();
    window_.player().play();
  }
  if (static_cast<double>(play_since_.elapsed()) < 1000 * arguments_.play_s) return true;
  played_ = true;
  reportPlay();
  return false;
}

void Errand::reportPlay() {
  const PlaybackClock& clock = window_.player().clock();
  const FrameCache& cache = window_.model().cache();
  const std::vector<bool> held = cache.held(*window_.model().sequence());
  std::printf("played %.2f of %g fps, %d dropped, %td frames in memory (%.0f of %.0f MB)\n", clock.rate(),
              clock.takeRate(), clock.dropped(), std::count(held.begin(), held.end(), true),
              1e-6 * static_cast<double>(cache.bytes()), 1e-6 * static_cast<double>(cache.budget()));
  std::fflush(stdout);
}

void Errand::tick() {
  if (play_since_.isValid() && playing()) return;
  if (played_) {
    timer_.stop();
    if (!arguments_.screenshot.isEmpty()) takePicture();
    return;
  }
  const bool runs = run_started_ && window_.job().busy();
  const bool to_play = arguments_.play_s > 0 && !(window_.model().settled() && window_.lights().settled());
  const bool busy =
      (runs && arguments_.wait_run) || (!runs && !window_.settled()) || window_.model().opening() || to_play;
  if (busy) {
    settled_since_.invalidate();
    return;
  }
  if (!settled_since_.isValid()) settled_since_.start();
  if (static_cast<double>(settled_since_.elapsed()) >= kCalm_ms + 1000 * arguments_.after_s) {
    if (!arguments_.curve.isEmpty()) {
      if (!window_.timeline().chooseCurve(arguments_.curve))
        return giveUp("there is no curve \"" + arguments_.curve + "\" (yet)");
      arguments_.curve.clear();
      arguments_.after_s = 0;
      return settled_since_.invalidate();  // the docks make room for it first
    }
    if (!playing()) takePicture();
  }
}

void Errand::takePicture() {
  timer_.stop();
  if (!window_.grab().save(arguments_.screenshot, "PNG")) {
    return giveUp("the picture \"" + arguments_.screenshot + "\" cannot be written; choose another place");
  }
  window_.close();
  QApplication::exit(0);
}

void Errand::giveUp(const QString& why) {
  window_.setAsksBeforeClosing(false);
  std::fprintf(stderr, "error: %s\n", why.toUtf8().constData());
  window_.close();
  QApplication::exit(exitCode(Error::Kind::Usage));
}

}  // namespace beam
