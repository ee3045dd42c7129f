// SPDX-License-Identifier: Apache-2.0
// What lies under the pointer in the scene view. Positions are device-independent pixels of the picture.
#include <vtkRenderWindow.h>

#include <algorithm>

#include "viewers/scene/scene_state.h"

namespace beam {
namespace {

constexpr double kReach_px = 12;  // a finger's breadth
constexpr double kLineReach_px = 6;

double distanceToSegment(dvec2 p, dvec2 a, dvec2 b) {
  const dvec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0;
  return glm::distance(p, a + t * along);
}

dvec2 asVec(QPointF p) { return {p.x(), p.y()}; }

}  // namespace

std::optional<QPointF> SceneView::State::onScreen(vec3 point) const {
  constexpr double kNearest_m = 0.01;
  const Camera c = camera();
  const dvec3 in_camera = c.camera_from_world * dvec3(point);
  if (in_camera.z < kNearest_m) return {};
  const dvec2 at = project(c.intrinsics, in_camera);
  return QPointF(at.x, at.y);
}

int SceneView::State::jointAt(QPointF at) const {
  if (trails.empty() || !shown[static_cast<int>(SceneLayer::Joints)]) return -1;
  double nearest = kReach_px;
  int found = -1;
  const std::vector<vec3>& joints = trails.back();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto seen = onScreen(joints[j]);
    const double away = seen ? glm::distance(asVec(*seen), asVec(at)) : nearest;
    if (away >= nearest) continue;
    nearest = away;
    found = static_cast<int>(j);
  }
  return found;
}

std::optional<ViewIndex> SceneView::State::cameraAt(QPointF at) const {
  if (!capture || !shown[static_cast<int>(SceneLayer::Cameras)]) return {};
  double nearest = kLineReach_px;
  std::optional<ViewIndex> found;
  for (std::size_t v = 0; v < capture->views.size(); ++v) {
    const Frustum frustum = frustumOf(capture->views[v].camera, frustumLength());
    std::array<std::optional<QPointF>, std::tuple_size_v<Frustum>> seen;
    std::transform(frustum.begin(), frustum.end(), seen.begin(), [&](vec3 p) { return onScreen(p); });
    for (const auto& [a, b] : kFrustumEdges) {
      if (!seen[a] || !seen[b]) continue;
      const double away = distanceToSegment(asVec(at), asVec(*seen[a]), asVec(*seen[b]));
      if (away >= nearest) continue;
      nearest = away;
      found = ViewIndex{static_cast<std::int32_t>(v)};
    }
  }
  return found;
}

// By the depth of the picture, drawn once more with the stand-ins and without what is no surface. A search
// for the nearest triangle would need a tree over each mesh that passes by.
std::optional<vec3> SceneView::State::surfaceAt(QPointF at) {
  constexpr int kAround_px = 2;
  if (!vtk->isValid()) return {};
  vtkActor* const lines[] = {actors[static_cast<int>(SceneLayer::Grid)],
                             actors[static_cast<int>(SceneLayer::Cameras)]};
  moving = true;
  updateVisibility();
  for (vtkActor* line : lines) line->VisibilityOff();
  overlay->DrawOff();
  place();
  window->Render();
  const int* size = window->GetSize();
  const double ratio = vtk->devicePixelRatioF();
  const int x = static_cast<int>(at.x() * ratio), y = size[1] - 1 - static_cast<int>(at.y() * ratio);
  std::optional<vec3> found;
  int nearest = kAround_px * kAround_px + 1;
  for (int dy = -kAround_px; dy <= kAround_px; ++dy) {
    for (int dx = -kAround_px; dx <= kAround_px; ++dx) {
      const int px = x + dx, py = y + dy, away = dx * dx + dy * dy;
      if (away >= nearest || px < 0 || py < 0 || px >= size[0] || py >= size[1]) continue;
      const double depth = renderer->GetZ(px, py);
      if (depth <= 0 || depth >= 1) continue;
      renderer->SetDisplayPoint(px + 0.5, py + 0.5, depth);
      renderer->DisplayToWorld();
      const double* p = renderer->GetWorldPoint();
      found = vec3(dvec3(p[0], p[1], p[2]) / p[3]);
      nearest = away;
    }
  }
  overlay->DrawOn();
  return found;
}

// Joints lie over the cameras, and cameras over nothing.
void SceneView::State::pressAt(QPointF at) {
  const int joint = jointAt(at);
  if (joint < 0) {
    if (const auto view = cameraAt(at)) {
      owner.markCamera(view);
      Q_EMIT owner.cameraPicked(*view);
      return;
    }
  }
  if (!trails.empty()) Q_EMIT owner.jointPicked(joint);
}

void SceneView::State::doubleClickAt(QPointF at) {
  const int joint = jointAt(at);
  if (joint < 0) {
    if (const auto view = cameraAt(at)) {
      owner.lookThrough(view);
      Q_EMIT owner.cameraActivated(*view);
      return;
    }
  }
  std::optional<vec3> point = surfaceAt(at);
  if (!point && joint >= 0) point = trails.back()[joint];
  if (point) {
    leaveCamera();
    orbit.focusOn(*point);
  }
  jump();
}

}  // namespace beam
