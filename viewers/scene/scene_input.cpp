// SPDX-License-Identifier: Apache-2.0
// Mouse, keys and camera of the scene view: those of the splat view, by the same orbit.
#include <vtkBoundingBox.h>
#include <vtkCamera.h>
#include <vtkTransform.h>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>

#include <cmath>

#include "viewers/focus_ring.h"
#include "viewers/scene/scene_state.h"
#include "viewers/splat/splat_view.h"
#include "viewers/view_keys.h"

namespace beam {
namespace {

constexpr double kStill_px = 4;  // a press that moves less is no drag

vec2 asVec(QPointF p) { return {static_cast<float>(p.x()), static_cast<float>(p.y())}; }

}  // namespace

Camera SceneView::State::camera() const {
  const int width = std::max(1, vtk->width()), height = std::max(1, vtk->height());
  if (look_through) return fittedTo(capture->views[look_through->value].camera, width, height);
  return orbit.camera(width, height);
}

void SceneView::State::place() {
  const Camera c = camera();
  const Rigid3 world_from_camera = inverse(c.camera_from_world);
  const dvec3 eye = world_from_camera.translation_m, up = world_from_camera.rotation * dvec3(0, -1, 0),
              ahead = eye + world_from_camera.rotation * dvec3(0, 0, orbit.distance_m);
  vtkCamera* vtk_camera = renderer->GetActiveCamera();
  vtk_camera->SetPosition(eye.x, eye.y, eye.z);
  vtk_camera->SetFocalPoint(ahead.x, ahead.y, ahead.z);
  vtk_camera->SetViewUp(up.x, up.y, up.z);
  vtk_camera->SetViewAngle(2 * std::atan(0.5 * c.height / c.intrinsics.fy) * 180 / kPi);
  // VTK knows square pixels alone: the rest is a stretch of the finished picture.
  const double stretch = c.intrinsics.fx / c.intrinsics.fy;
  vtk_camera->SetWindowCenter((1 - 2 * c.intrinsics.cx / c.width) / stretch,
                              2 * c.intrinsics.cy / c.height - 1);
  auto stretched = vtkSmartPointer<vtkTransform>::New();
  stretched->Scale(stretch, 1, 1);
  vtk_camera->SetUserTransform(stretch == 1 ? nullptr : stretched.Get());
  vtkBoundingBox seen;
  for (vtkRenderer* part : {renderer.Get(), overlay.Get()}) {
    double bounds[6];
    part->ComputeVisiblePropBounds(bounds);
    if (bounds[0] <= bounds[1]) seen.AddBounds(bounds);
  }
  double bounds[6] = {-1, 1, -1, 1, -1, 1};
  if (seen.IsValid()) seen.GetBounds(bounds);
  renderer->ResetCameraClippingRange(bounds);
}

void SceneView::State::render() {
  render_timer.stop();
  updateVisibility();
  updateSizes();
  place();
  if (vtk->isVisible()) window->Render();
  labels->update();
}

void SceneView::State::startMoving() {
  moving = true;
  updateVisibility();
  rest_timer.start();
}

void SceneView::State::jump() {
  startMoving();
  render();
}

void SceneView::State::moved() {
  startMoving();
  render_timer.start();
}

void SceneView::State::rest() {
  if (dragging) return rest_timer.start();  // the whole mesh may take a second, and the hand may go on
  rest_timer.stop();
  moving = false;
  render();
}

Bounds SceneView::State::subject() const {
  if (cloud && cloud->size() > 0) return subjectBounds(cloud->position_m);
  if (mesh && !mesh->vertices.empty()) return subjectBounds(mesh->vertices);
  if (capture && !capture->seed_points.position_m.empty())
    return subjectBounds(capture->seed_points.position_m);
  return home;
}

void SceneView::State::leaveCamera() {
  if (!look_through) return;
  const Camera seen = camera();
  look_through.reset();
  const dvec3 to_center = seen.camera_from_world * dvec3(subject().center_m);
  orbit = orbitOf(seen, std::max(static_cast<float>(to_center.z), 0.1f));
}

void SceneView::State::stepCamera(int step) {
  if (!capture || capture->views.empty()) return;
  const int count = static_cast<int>(capture->views.size());
  const int now = look_through ? look_through->value
                  : marked     ? marked->value - (step > 0 ? 1 : -1)
                               : (step > 0 ? -1 : 0);
  const ViewIndex next{(now + step + count) % count};
  owner.lookThrough(next);
  Q_EMIT owner.cameraPicked(next);
}

void SceneView::goHome() {
  State& s = *state_;
  s.look_through.reset();
  s.orbit = OrbitCamera{.azimuth_rad = 0.6f, .elevation_rad = 0.35f};
  s.orbit.frame(s.home);
  s.jump();
}

void SceneView::frameSubject() {
  state_->leaveCamera();
  state_->orbit.frame(state_->subject());
  state_->jump();
}

void SceneView::setPreset(ViewPreset preset) {
  state_->leaveCamera();
  state_->orbit.turnTo(preset);
  state_->jump();
}

void SceneView::lookThrough(std::optional<ViewIndex> view) {
  State& s = *state_;
  if (view && (!s.capture || view->value < 0 || view->value >= static_cast<int>(s.capture->views.size())))
    return;
  if (!view) s.leaveCamera();
  s.look_through = view;
  if (view) markCamera(view);
  s.jump();
}

bool SceneView::handleKey(const QKeyEvent& event) {
  State& s = *state_;
  if (const auto preset = presetOf(event)) {
    setPreset(*preset);
    return true;
  }
  if (event.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) return false;
  const auto toggle = [this](SceneLayer layer) { setLayerShown(layer, !layerShown(layer)); };
  switch (event.key()) {
    case Qt::Key_F:
      frameSubject();
      return true;
    case Qt::Key_H:
      goHome();
      return true;
    case Qt::Key_K:
      toggle(SceneLayer::Cameras);
      return true;
    case Qt::Key_G:
      toggle(SceneLayer::Grid);
      return true;
    case Qt::Key_J:
      toggle(SceneLayer::Joints);
      return true;
    case Qt::Key_BracketLeft:
      s.stepCamera(-1);
      return true;
    case Qt::Key_BracketRight:
      s.stepCamera(1);
      return true;
    case Qt::Key_Escape:
      if (!s.look_through) return false;
      lookThrough(std::nullopt);
      return true;
    default:
      return false;
  }
}

void SceneView::keyPressEvent(QKeyEvent* event) {
  if (!handleKey(*event)) QWidget::keyPressEvent(event);
}

// Ctrl with a digit is a shortcut of the window; on the number pad it looks from the other side.
bool SceneView::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride && presetOf(*static_cast<QKeyEvent*>(event))) {
    event->accept();
    return true;
  }
  return QWidget::event(event);
}

// Of the mouse, VTK sees nothing.
bool SceneView::eventFilter(QObject* watched, QEvent* event) {
  State& s = *state_;
  switch (event->type()) {
    case QEvent::Show:
      s.render_timer.start();
      return false;
    case QEvent::Resize:
      s.labels->resize(static_cast<QResizeEvent*>(event)->size());
      s.render_timer.start();
      return false;
    case QEvent::FocusIn:
    case QEvent::FocusOut:
      s.labels->setRing(event->type() == QEvent::FocusIn && cameByKey(*static_cast<QFocusEvent*>(event)));
      return false;
    case QEvent::MouseButtonPress:
    case QEvent::MouseMove:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseButtonDblClick:
      s.handleMouse(*static_cast<QMouseEvent*>(event));
      return true;
    case QEvent::Wheel: {
      const auto* wheel = static_cast<QWheelEvent*>(event);
      s.leaveCamera();
      s.orbit.zoomAt(wheelSteps(*wheel), asVec(wheel->position()), {s.vtk->width(), s.vtk->height()});
      s.moved();
      event->accept();
      return true;
    }
    default:
      return QWidget::eventFilter(watched, event);
  }
}

void SceneView::State::handleMouse(const QMouseEvent& mouse) {
  const QPointF at = mouse.localPos();
  switch (mouse.type()) {
    case QEvent::MouseButtonPress:
      pressed = mouse.button() == Qt::LeftButton;
      dragging = false;
      pressed_at = last_mouse = at;
      vtk->setFocus(Qt::MouseFocusReason);
      break;
    case QEvent::MouseMove:
      drag(at, mouse.buttons());
      break;
    case QEvent::MouseButtonDblClick:
      pressed = dragging = false;
      pressed_at = last_mouse = at;
      if (mouse.button() == Qt::LeftButton) doubleClickAt(at);
      break;
    default:
      if (dragging || (at - pressed_at).manhattanLength() >= kStill_px) {
        dragging = false;
        if (rest_timer.isActive()) rest();
      } else if (pressed && mouse.button() == Qt::LeftButton) {
        pressAt(at);
      }
      pressed = false;
  }
}

void SceneView::State::hover(QPointF at) {
  const auto view = cameraAt(at);
  vtk->setCursor(view ? Qt::PointingHandCursor : Qt::ArrowCursor);
  vtk->setToolTip(view ? QString("Camera %1: press to mark it, twice to look through it")
                             .arg(QString::fromStdString(capture->views[view->value].name))
                       : QString());
}

void SceneView::State::drag(QPointF at, Qt::MouseButtons buttons) {
  if (buttons == Qt::NoButton) hover(at);
  if (!(buttons & (Qt::LeftButton | Qt::MiddleButton))) return;
  if (!dragging && (at - pressed_at).manhattanLength() < kStill_px) return;
  dragging = true;
  const vec2 by = asVec(at - last_mouse);
  last_mouse = at;
  leaveCamera();
  if (buttons & Qt::LeftButton) {
    orbit.orbit(by);
  } else {
    orbit.pan(by, vtk->height());
  }
  moved();
}

}  // namespace beam
