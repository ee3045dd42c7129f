// SPDX-License-Identifier: Apache-2.0
// What the layers of the scene view hold, and how it gets there.
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include <QLocale>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "viewers/scene/coarse_mesh.h"
#include "viewers/scene/scene_state.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

constexpr std::size_t kMostEllipsoids = 6000;
constexpr std::size_t kMostMovingTriangles = 60000;  // a software OpenGL draws them in about 40 ms
constexpr float kEllipsoidSigmas = 2;
constexpr float kJointSize_px = 7, kSmallJointSize_px = 3, kFaintJointSize_px = 2;
constexpr float kFewJoints = 300;  // as many squares leave the skin in view

QString numberText(std::size_t number) {
  return QLocale(QLocale::English).toString(static_cast<qulonglong>(number));
}

// Of all of them: there are few, and none is a stray.
Bounds boundsOfCameras(const std::vector<View>& views) {
  if (views.empty()) return {};
  vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const View& view : views) {
    const vec3 eye(centerOf(view.camera));
    low = glm::min(low, eye);
    high = glm::max(high, eye);
  }
  Bounds bounds{0.5f * (low + high), 0.1f};
  for (const View& view : views)
    bounds.radius_m = std::max(bounds.radius_m, glm::distance(bounds.center_m, vec3(centerOf(view.camera))));
  bounds.radius_m *= 0.9f;  // seen from outside, a ring of cameras fills less than its ball
  return bounds;
}

}  // namespace

QString counted(std::size_t count, const QString& thing) {
  return numberText(count) + " " + thing + (count == 1 ? "" : "s");
}

Bounds subjectBounds(const std::vector<vec3>& positions_m) {
  constexpr float kReach = 4;  // a standing person reaches 2.5 times the median distance to the middle
  if (positions_m.empty()) return {};
  std::vector<float> values(positions_m.size());
  const auto median = [&] {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  vec3 center;
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(positions_m.begin(), positions_m.end(), values.begin(),
                   [axis](const vec3& p) { return p[axis]; });
    center[axis] = median();
  }
  std::transform(positions_m.begin(), positions_m.end(), values.begin(),
                 [center](const vec3& p) { return glm::distance(p, center); });
  const float reach_m = kReach * median();
  std::vector<vec3> near;
  std::copy_if(positions_m.begin(), positions_m.end(), std::back_inserter(near),
               [&](const vec3& p) { return glm::distance(p, center) <= reach_m; });
  return boundsOf(near);
}

void SceneView::State::updateFacts() {
  // What is still to do, or can be pressed, goes first: the end is cut in a narrow view.
  QStringList words{joint_hint, counts[static_cast<int>(SceneLayer::Joints)]};
  for (int i = 0; i < kSceneLayerCount; ++i) {
    if (i != static_cast<int>(SceneLayer::Joints)) words << counts[i];
  }
  words << "world axes, +Y up, metres";
  words.removeAll(QString());
  facts->setWords(words.join(" · "));
}

// From inside a frustum its lines would be a frame around the picture.
bool SceneView::State::markShown() const {
  if (!marked || !shown[static_cast<int>(SceneLayer::Cameras)]) return false;
  const dvec3 away = centerOf(camera()) - centerOf(capture->views[marked->value].camera);
  return glm::length(away) > frustumLength();
}

void SceneView::State::updateVisibility() {
  for (int i = 0; i < kSceneLayerCount; ++i) {
    const bool stand_in = moving && geometryOf(coarse[i])->GetNumberOfPolys() > 0;
    actors[i]->SetVisibility(shown[i] && !stand_in);
    coarse[i]->SetVisibility(shown[i] && stand_in);
  }
  mark->SetVisibility(markShown());
}

// VTK counts in pixels of the screen, and those are small on a dense one.
void SceneView::State::updateSizes() {
  const auto ratio = static_cast<float>(vtk->devicePixelRatioF());
  const auto property = [&](SceneLayer layer) { return actors[static_cast<int>(layer)]->GetProperty(); };
  property(SceneLayer::Cameras)->SetLineWidth(1.4f * ratio);
  property(SceneLayer::Grid)->SetLineWidth(ratio);
  property(SceneLayer::SeedPoints)->SetPointSize(3 * ratio);
  property(SceneLayer::Joints)->SetLineWidth(1.6f * ratio);
  property(SceneLayer::Joints)->SetPointSize(joint_size_px * ratio);
  mark->GetProperty()->SetLineWidth(3 * ratio);
}

void SceneView::State::show(SceneLayer layer, const BuiltLayer& data) {
  const int i = static_cast<int>(layer);
  const auto put = [](vtkActor* actor, const PolyData& geometry) {
    static_cast<vtkPolyDataMapper*>(actor->GetMapper())
        ->SetInputData(geometry ? geometry : vtkSmartPointer<vtkPolyData>::New());
  };
  put(actors[i], data.full);
  put(coarse[i], data.coarse);
  arrived[i] = tickets[i];
  render();
}

void SceneView::State::build(SceneLayer layer, std::function<BuiltLayer()> make_data, const QString& count) {
  const int i = static_cast<int>(layer);
  arrived[i] = ++tickets[i];  // what is being built is not waited for
  counts[i] = count;
  waiting[i] = std::move(make_data);
  updateFacts();
  if (waiting[i]) {
    buildIfSeen(layer);
  } else {
    show(layer, {});
  }
}

void SceneView::State::buildIfSeen(SceneLayer layer) {
  const int i = static_cast<int>(layer);
  if (!waiting[i] || !shown[i] || !owner.isVisible()) return;
  const int ticket = ++tickets[i];
  workers[i].submit([this, layer, make_data = std::exchange(waiting[i], {}), ticket] {
    // Handed over whole: who drops one of several references to a data object walks it for cycles
    // (vtkGarbageCollector), which must not meet the last reference dropped by another thread.
    BuiltLayer data = make_data();
    QMetaObject::invokeMethod(
        &owner,
        [this, layer, data = std::move(data), ticket] {
          if (tickets[static_cast<int>(layer)] == ticket) show(layer, data);
        },
        Qt::QueuedConnection);
  });
}

void SceneView::State::buildCapture() {
  if (!capture) {
    home = {vec3(0, 0.9f, 0), 2.5f};
    build(SceneLayer::Cameras, {}, {});
    build(SceneLayer::SeedPoints, {}, {});
    return;
  }
  home = boundsOfCameras(capture->views);
  const auto tests =
      static_cast<std::size_t>(std::count_if(capture->views.begin(), capture->views.end(),
                                             [](const View& view) { return view.split == Split::Test; }));
  QString cameras = counted(capture->views.size(), "camera");
  if (tests > 0) cameras += ", " + numberText(tests) + " of them for testing";
  build(
      SceneLayer::Cameras,
      [capture = capture, size = frustumLength()] {
        return BuiltLayer{frustaOf(capture->views, size), {}};
      },
      cameras);
  build(
      SceneLayer::SeedPoints,
      [capture = capture] {
        return BuiltLayer{pointsOf(capture->seed_points), {}};
      },
      counted(capture->seed_points.position_m.size(), "seed point"));
}

// One pyramid: built at once, so that the list of cameras and the view agree.
void SceneView::State::buildMark() {
  const PolyData geometry =
      marked ? frustaOf(capture->views, frustumLength(), marked->value) : vtkSmartPointer<vtkPolyData>::New();
  static_cast<vtkPolyDataMapper*>(mark->GetMapper())->SetInputData(geometry);
}

void SceneView::State::buildCloud() {
  if (!cloud || cloud->size() == 0) {
    build(SceneLayer::Gaussians, {}, {});
    return;
  }
  const QString count = cloud->size() <= kMostEllipsoids
                            ? counted(cloud->size(), "Gaussian")
                            : QString("the largest %1 of %2")
                                  .arg(numberText(kMostEllipsoids), counted(cloud->size(), "Gaussian"));
  build(
      SceneLayer::Gaussians,
      [shown = cloud, shares = influenceFits() ? influence : std::make_shared<const std::vector<float>>()] {
        const auto drawn = [&](int splits) {
          return ellipsoidsOf(*shown, kMostEllipsoids, kEllipsoidSigmas, *shares, splits);
        };
        return BuiltLayer{drawn(2), drawn(0)};
      },
      count);
}

void SceneView::State::buildJoints() {
  const int picked = influenceFits() ? picked_joint : -1;
  labels->update();
  if (trails.empty()) {
    build(SceneLayer::Joints, {}, {});
    return;
  }
  const auto joints = static_cast<float>(trails.back().size());
  const float size_px = kJointSize_px * std::sqrt(std::min(1.0f, kFewJoints / joints));
  joint_size_px = picked < 0 ? std::max(kSmallJointSize_px, size_px) : kFaintJointSize_px;
  QString words = counted(trails.back().size(), "joint");
  if (trails.size() > 1) words += " with trails of " + counted(trails.size(), "frame");
  words += picked < 0 ? QString(", press one to see its influence")
                      : QString(", influence of joint %1; press beside it to end").arg(picked);
  build(
      SceneLayer::Joints,
      [shown = trails, picked] {
        return BuiltLayer{jointsOf(shown, picked, shown.back().size() <= kFewJoints), {}};
      },
      words);
}

void SceneView::setMesh(std::shared_ptr<const Mesh> mesh) {
  State& s = *state_;
  if (mesh == s.mesh) return;
  s.mesh = std::move(mesh);
  if (!s.mesh || s.mesh->triangles.empty()) {
    s.build(SceneLayer::Mesh, {}, {});
    return;
  }
  s.build(
      SceneLayer::Mesh,
      [mesh = s.mesh] {
        BuiltLayer built{meshOf(*mesh), {}};
        if (mesh->triangles.size() > kMostMovingTriangles)
          built.coarse = meshOf(coarser(*mesh, kMostMovingTriangles));
        return built;
      },
      counted(s.mesh->triangles.size(), "triangle"));
}

}  // namespace beam
