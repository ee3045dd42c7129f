// SPDX-License-Identifier: Apache-2.0
// Mouse and keys of the splat view (product 4.6, 4.10).
#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>

#include "viewers/splat/channel_picture.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

constexpr float kYawPerPixel_rad = 0.01f;
constexpr float kExposureStep = 0.5f;
constexpr int kWheelUnits = 120;  // Qt: one notch

vec2 asVec(QPointF p) { return {static_cast<float>(p.x()), static_cast<float>(p.y())}; }

}  // namespace

void SplatView::mousePressEvent(QMouseEvent* event) {
  last_mouse_ = event->localPos();
  setFocus();
}

void SplatView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF drag = event->localPos() - last_mouse_;
  last_mouse_ = event->localPos();
  const bool turns_light =
      (event->buttons() & Qt::RightButton) != 0 && (event->modifiers() & Qt::ShiftModifier) != 0;
  if (turns_light) {
    setYaw(state_.yaw_rad + kYawPerPixel_rad * static_cast<float>(drag.x()));
  } else if (event->buttons() & Qt::LeftButton) {
    leaveCamera();
    state_.orbit.orbit(asVec(drag));
    changed(Pace::Moving);
  } else if (event->buttons() & Qt::MiddleButton) {
    leaveCamera();
    state_.orbit.pan(asVec(drag), height());
    changed(Pace::Moving);
  } else {
    reportHover(event->localPos());
  }
}

void SplatView::mouseReleaseEvent(QMouseEvent*) {
  if (rest_timer_.isActive()) request(1);
}

void SplatView::wheelEvent(QWheelEvent* event) {
  const float steps = static_cast<float>(event->angleDelta().y()) / kWheelUnits;
  if (state_.look_through) {
    setPhotoOpacity(state_.photo_opacity + 0.1f * steps);
    return;
  }
  state_.orbit.zoom(steps);
  changed(Pace::Moving);
}

void SplatView::leaveEvent(QEvent*) { Q_EMIT hovered({}); }

void SplatView::reportHover(QPointF position) {
  if (!shown_.gbuffer || !shown_.lit || shown_.gbuffer->alpha.empty()) return;
  const Image<float>& alpha = shown_.gbuffer->alpha;
  const int x = std::clamp(static_cast<int>(position.x() * alpha.width / width()), 0, alpha.width - 1);
  const int y = std::clamp(static_cast<int>(position.y() * alpha.height / height()), 0, alpha.height - 1);
  const std::string reading = describePixel(*shown_.gbuffer, *shown_.lit, shown_.channel, x, y);
  Q_EMIT hovered(QString("x %1  y %2   %3").arg(x).arg(y).arg(QString::fromStdString(reading)));
}

void SplatView::nextCamera(int step) {
  if (!capture_ || capture_->views.empty()) return;
  const int count = static_cast<int>(capture_->views.size());
  const int now = state_.look_through ? state_.look_through->value : (step > 0 ? -1 : 0);
  lookThrough(ViewIndex{(now + step + count) % count});
}

void SplatView::cycleChannel(int step) {
  setChannel(static_cast<Channel>((static_cast<int>(state_.channel) + step + kChannelCount) % kChannelCount));
}

bool SplatView::handleKey(const QKeyEvent& event) {
  if (event.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) return false;
  const bool shift = (event.modifiers() & Qt::ShiftModifier) != 0;
  const int key = event.key();
  if (key >= Qt::Key_1 && key < Qt::Key_1 + kChannelCount) {
    setChannel(static_cast<Channel>(key - Qt::Key_1));
    return true;
  }
  switch (key) {
    case Qt::Key_C:
      cycleChannel(shift ? -1 : 1);
      return true;
    case Qt::Key_M:
      setChannel(Channel::Lit);
      return true;
    case Qt::Key_F:
    case Qt::Key_H:
      goHome();
      return true;
    case Qt::Key_E:
      setExposure(state_.exposure_stops + (shift ? -kExposureStep : kExposureStep));
      return true;
    case Qt::Key_R:
      setExposure(0);
      return true;
    case Qt::Key_BracketLeft:
      nextCamera(-1);
      return true;
    case Qt::Key_BracketRight:
      nextCamera(1);
      return true;
    case Qt::Key_Return:
    case Qt::Key_Enter:
      if (!state_.look_through) nextCamera(1);
      return true;
    case Qt::Key_Escape:
      leaveCamera();
      return true;
    default:
      return false;
  }
}

void SplatView::keyPressEvent(QKeyEvent* event) {
  if (!handleKey(*event)) PictureCanvas::keyPressEvent(event);
}

}  // namespace beam
