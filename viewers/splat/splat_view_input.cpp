// SPDX-License-Identifier: Apache-2.0
// Mouse and keys of the splat view: those of the other views where they mean the same.
#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>

#include <algorithm>

#include "viewers/splat/channel_picture.h"
#include "viewers/splat/splat_view.h"
#include "viewers/view_keys.h"

namespace beam {
namespace {

constexpr float kYawPerPixel_rad = 0.01f;
constexpr float kExposureStep = 0.5f;

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
  const float steps = wheelSteps(*event);
  if (state_.look_through) {
    setPhotoOpacity(state_.photo_opacity + 0.1f * steps);
    return;
  }
  state_.orbit.zoomAt(steps, asVec(event->position()), {width(), height()});
  changed(Pace::Moving);
}

void SplatView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) focusAt(event->localPos());
}

// Of what is on the screen, which may lag behind the orbit.
void SplatView::focusAt(QPointF position) {
  const Planes& depth = hostValues(kDepthChannel);
  if (depth.empty()) return;
  const ivec2 pixel = pixelAt(position, depth.width, depth.height);
  const double depth_m = depth.values[static_cast<std::size_t>(pixel.y) * depth.width + pixel.x];
  if (!(depth_m > 0)) return;
  const Camera& camera = shown_.rendered.camera;
  const dvec3 ray = rayOf(camera.intrinsics, dvec2(pixel) + 0.5);
  const vec3 point(inverse(camera.camera_from_world) * (depth_m / ray.z * ray));
  leaveCamera();
  state_.orbit.focusOn(point);
  changed(Pace::Resting);
}

void SplatView::leaveEvent(QEvent*) {
  pointer_.reset();
  Q_EMIT hovered({});
}

ivec2 SplatView::pixelAt(QPointF position, int width_px, int height_px) const {
  return {std::clamp(static_cast<int>(position.x() * width_px / width()), 0, width_px - 1),
          std::clamp(static_cast<int>(position.y() * height_px / height()), 0, height_px - 1)};
}

void SplatView::reportHover(QPointF position) {
  pointer_ = position;
  const Planes& values = hostValues(shown_.channel.id);
  const Planes& alpha = hostValues(kAlphaChannel);
  if (alpha.empty()) return;
  const ivec2 p = pixelAt(position, alpha.width, alpha.height);
  const std::string reading = describePixel(shown_.channel, values, alpha, p.x, p.y);
  Q_EMIT hovered(QString("x %1  y %2   %3").arg(p.x).arg(p.y).arg(QString::fromStdString(reading)));
}

void SplatView::nextCamera(int step) {
  if (!capture_ || capture_->views.empty()) return;
  const int count = static_cast<int>(capture_->views.size());
  const int now = state_.look_through ? state_.look_through->value : (step > 0 ? -1 : 0);
  lookThrough(ViewIndex{(now + step + count) % count});
}

void SplatView::cycleChannel(int step) {
  const std::vector<ChannelInfo>& all = shownChannels();
  const int count = static_cast<int>(all.size());
  const auto now = std::find(all.begin(), all.end(), state_.channel);
  const int at = now == all.end() ? 0 : static_cast<int>(now - all.begin());
  setChannel(all[(at + step + count) % count]);
}

bool SplatView::handleKey(const QKeyEvent& event) {
  if (const auto preset = presetOf(event)) {
    setPreset(*preset);
    return true;
  }
  if (event.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) return false;
  const bool shift = (event.modifiers() & Qt::ShiftModifier) != 0;
  const int key = event.key();
  const bool pad = (event.modifiers() & Qt::KeypadModifier) != 0;  // of which some digits are directions
  for (const ChannelInfo& channel : shownChannels()) {
    if (pad || key != Qt::Key_0 + channel.key) continue;
    setChannel(channel);
    return true;
  }
  switch (key) {
    case Qt::Key_C:
      cycleChannel(shift ? -1 : 1);
      return true;
    case Qt::Key_M:
      setChannel(channelOf(kRelightChannel));
      return true;
    case Qt::Key_F:
      frameSubject();
      return true;
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
    case Qt::Key_Escape:
      if (!state_.look_through) return false;
      leaveCamera();
      return true;
    default:
      return false;
  }
}

// Ctrl and a digit of the number pad would else be taken for the window's Ctrl+1.
bool SplatView::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride && presetOf(*static_cast<QKeyEvent*>(event))) {
    event->accept();
    return true;
  }
  return PictureCanvas::event(event);
}

// Return is the view's own while it has the focus: one that a text field lets pass must not move the camera.
void SplatView::keyPressEvent(QKeyEvent* event) {
  const bool enters = event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter;
  const Qt::KeyboardModifiers others = event->modifiers() & ~Qt::KeypadModifier;
  if (enters && others == Qt::NoModifier) {
    if (!state_.look_through) nextCamera(1);
  } else if (!handleKey(*event))
    PictureCanvas::keyPressEvent(event);
}

}  // namespace beam
