// SPDX-License-Identifier: Apache-2.0
#include "viewers/scene/scene_view.h"

#include <QVTKOpenGLNativeWidget.h>
#include <vtkActor.h>
#include <vtkBillboardTextActor3D.h>
#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkInteractorStyleTerrain.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QMouseEvent>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <array>
#include <deque>
#include <functional>

#include "core/base/error.h"
#include "viewers/latest_worker.h"
#include "viewers/orbit_camera.h"
#include "viewers/scene/vtk_convert.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

constexpr std::size_t kMostEllipsoids = 6000;
constexpr float kEllipsoidSigmas = 2;
constexpr float kGridExtent_m = 2, kGridCell_m = 0.25f;

const std::array<const char*, kSceneLayerCount> kTitles{"Cameras", "Seed points",   "Gaussians",
                                                        "Mesh",    "Grid and axes", "Joints"};

template <class T>
vtkSmartPointer<T> make() {
  return vtkSmartPointer<T>::New();
}

}  // namespace

struct SceneView::State {
  explicit State(SceneView& o) : owner(o) {}

  SceneView& owner;
  QVTKOpenGLNativeWidget* vtk = nullptr;
  QLabel* facts = nullptr;
  std::array<QToolButton*, kSceneLayerCount> toggles{};
  vtkSmartPointer<vtkGenericOpenGLRenderWindow> window = make<vtkGenericOpenGLRenderWindow>();
  vtkSmartPointer<vtkRenderer> renderer = make<vtkRenderer>();
  vtkSmartPointer<vtkRenderer> overlay = make<vtkRenderer>();  // joints lie under the skin, and are seen
  std::array<vtkSmartPointer<vtkActor>, kSceneLayerCount> actors;
  std::array<vtkSmartPointer<vtkBillboardTextActor3D>, 3> axis_names;
  std::array<QString, kSceneLayerCount> counts;
  Bounds bounds{vec3(0, 0.9f, 0), 2.5f};
  bool framed = false;
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<const std::vector<float>> influence;
  JointTrails trails;
  QString joint_hint;
  int picked_joint = -1;
  QPointF pressed_at;
  // A layer that is replaced while it is built never arrives; the newest always does.
  std::array<int, kSceneLayerCount> tickets{}, arrived{};
  std::array<LatestWorker, kSceneLayerCount> workers;  // last: they stop first

  void addActors();
  void layOut();
  void show(SceneLayer layer, const PolyData& data, const QString& count);
  void build(SceneLayer layer, std::function<PolyData()> make_data, const QString& count);
  void buildCloud();
  void buildJoints();
  void updateFacts();
  void render() const { window->Render(); }
};

void SceneView::State::addActors() {
  for (auto& actor : actors) {
    actor = make<vtkActor>();
    auto mapper = make<vtkPolyDataMapper>();
    mapper->SetInputData(make<vtkPolyData>());
    actor->SetMapper(mapper);
    (&actor == &actors[static_cast<int>(SceneLayer::Joints)] ? overlay : renderer)->AddActor(actor);
  }
  const auto property = [&](SceneLayer layer) { return actors[static_cast<int>(layer)]->GetProperty(); };
  for (const SceneLayer flat :
       {SceneLayer::Cameras, SceneLayer::SeedPoints, SceneLayer::Grid, SceneLayer::Joints})
    property(flat)->LightingOff();
  property(SceneLayer::Cameras)->SetLineWidth(1.4f);
  property(SceneLayer::SeedPoints)->SetPointSize(3);
  property(SceneLayer::Joints)->SetPointSize(7);
  property(SceneLayer::Joints)->SetLineWidth(1.6f);
  for (const SceneLayer solid : {SceneLayer::Gaussians, SceneLayer::Mesh}) {
    property(solid)->SetAmbient(0.35);
    property(solid)->SetDiffuse(0.65);
    property(solid)->SetInterpolationToGouraud();
  }
  const std::array<const char*, 3> names{"X", "Y up", "Z"};
  for (int i = 0; i < 3; ++i) {
    axis_names[i] = make<vtkBillboardTextActor3D>();
    axis_names[i]->SetInput(names[i]);
    dvec3 at(0);
    at[i] = 0.52 * kGridExtent_m;
    axis_names[i]->SetPosition(at.x, at.y, at.z);
    axis_names[i]->GetTextProperty()->SetFontSize(15);
    axis_names[i]->GetTextProperty()->SetColor(0.85, 0.87, 0.9);
    renderer->AddActor(axis_names[i]);
  }
}

void SceneView::State::layOut() {
  auto* row = new QHBoxLayout;
  row->setContentsMargins(8, 6, 8, 6);
  row->setSpacing(6);
  for (int i = 0; i < kSceneLayerCount; ++i) {
    auto* button = new QToolButton;
    button->setText(kTitles[i]);
    button->setCheckable(true);
    button->setChecked(true);
    button->setFocusPolicy(Qt::NoFocus);
    const auto layer = static_cast<SceneLayer>(i);
    QObject::connect(button, &QToolButton::toggled, &owner,
                     [this, layer](bool on) { owner.setLayerShown(layer, on); });
    row->addWidget(button);
    toggles[i] = button;
  }
  row->addStretch();
  facts = new QLabel;
  facts->setObjectName("quiet");
  facts->setContentsMargins(10, 0, 10, 6);
  facts->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);  // words must not widen the window
  vtk = new QVTKOpenGLNativeWidget;
  vtk->setRenderWindow(window.Get());
  auto* column = new QVBoxLayout(&owner);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addLayout(row);
  column->addWidget(facts);
  column->addWidget(vtk, 1);
}

void SceneView::State::updateFacts() {
  QStringList words{"world axes, +Y up, metres"};
  for (const QString& count : counts) {
    if (!count.isEmpty()) words << count;
  }
  if (!joint_hint.isEmpty()) words << joint_hint;
  facts->setText(words.join(" · "));
}

void SceneView::State::show(SceneLayer layer, const PolyData& data, const QString& count) {
  const int i = static_cast<int>(layer);
  static_cast<vtkPolyDataMapper*>(actors[i]->GetMapper())->SetInputData(data);
  counts[i] = count;
  arrived[i] = tickets[i];
  updateFacts();
  render();
}

void SceneView::State::build(SceneLayer layer, std::function<PolyData()> make_data, const QString& count) {
  const int ticket = ++tickets[static_cast<int>(layer)];
  if (!make_data) {
    show(layer, make<vtkPolyData>(), {});
    return;
  }
  workers[static_cast<int>(layer)].submit([this, layer, make_data = std::move(make_data), count, ticket] {
    // Handed over whole: who drops one of several references to a data object walks it for cycles
    // (vtkGarbageCollector), which must not meet the last reference dropped by another thread.
    PolyData data = make_data();
    QMetaObject::invokeMethod(
        &owner,
        [this, layer, data = std::move(data), count, ticket] {
          if (tickets[static_cast<int>(layer)] == ticket) show(layer, data, count);
        },
        Qt::QueuedConnection);
  });
}

SceneView::SceneView(QWidget* parent) : QWidget(parent), state_(std::make_unique<State>(*this)) {
  State& s = *state_;
  s.layOut();
  s.addActors();
  s.window->SetNumberOfLayers(2);
  s.window->AddRenderer(s.renderer);
  s.overlay->SetLayer(1);
  s.overlay->InteractiveOff();
  s.overlay->SetActiveCamera(s.renderer->GetActiveCamera());
  s.window->AddRenderer(s.overlay);
  s.vtk->installEventFilter(this);
  s.window->SetMultiSamples(0);
  s.renderer->SetBackground(0.106, 0.110, 0.118);
  s.vtk->interactor()->SetInteractorStyle(make<vtkInteractorStyleTerrain>());
  s.updateFacts();
  s.show(SceneLayer::Grid, gridAndAxes(kGridExtent_m, kGridCell_m), {});
  setLayerShown(SceneLayer::Mesh, false);
  goHome();
}

SceneView::~SceneView() = default;

void SceneView::setCapture(std::shared_ptr<const CaptureSet> capture) {
  State& s = *state_;
  s.framed = false;
  if (!capture) {
    s.build(SceneLayer::Cameras, {}, {});
    s.build(SceneLayer::SeedPoints, {}, {});
    return;
  }
  std::vector<vec3> eyes;
  for (const View& view : capture->views) eyes.emplace_back(centerOf(view.camera));
  s.bounds = boundsOf(eyes);
  s.bounds.radius_m *= 0.8f;  // seen from outside, a ring of cameras fills less than its ball
  std::size_t tests = 0;
  for (const View& view : capture->views) tests += view.split == Split::Test ? 1 : 0;
  const QString cameras = QString("%1 cameras, %2 of them test").arg(capture->views.size()).arg(tests);
  const QString points = QString("%L1 seed points").arg(capture->seed_points.position_m.size());
  s.build(
      SceneLayer::Cameras,
      [capture, size = 0.11 * s.bounds.radius_m] { return frustaOf(capture->views, size); }, cameras);
  s.build(
      SceneLayer::SeedPoints, [capture] { return pointsOf(capture->seed_points); }, points);
  goHome();
}

void SceneView::State::buildCloud() {
  if (!cloud || cloud->size() == 0) {
    build(SceneLayer::Gaussians, {}, {});
    return;
  }
  const QString count =
      QString("%L1 of %L2 Gaussians").arg(std::min(cloud->size(), kMostEllipsoids)).arg(cloud->size());
  const bool fits = influence && influence->size() == cloud->size();
  build(
      SceneLayer::Gaussians,
      [shown = cloud, shares = fits ? influence : std::make_shared<const std::vector<float>>()] {
        return ellipsoidsOf(*shown, kMostEllipsoids, kEllipsoidSigmas, *shares);
      },
      count);
}

void SceneView::State::buildJoints() {
  if (trails.empty()) {
    build(SceneLayer::Joints, {}, {});
    return;
  }
  QString words = QString("%L1 joints").arg(trails.back().size());
  if (trails.size() > 1) words += QString(" with trails of %1 frames").arg(trails.size());
  words += picked_joint < 0
               ? QString(", press one to see its influence")
               : QString(", influence of joint %1 from indigo (little) to yellow (all)").arg(picked_joint);
  build(
      SceneLayer::Joints, [shown = trails, joint = picked_joint] { return jointsOf(shown, joint); }, words);
}

void SceneView::setCloud(std::shared_ptr<const GaussianCloud> cloud) {
  state_->cloud = std::move(cloud);
  state_->buildCloud();
}

void SceneView::setJoints(const std::vector<std::vector<vec3>>& trails, const QString& hint) {
  for (const auto& moment : trails) {
    if (moment.size() != trails.back().size())
      throw Error(Error::Kind::Bug, "joints of a trail differ in number");
  }
  state_->trails = trails;
  state_->joint_hint = hint;
  state_->buildJoints();
  state_->updateFacts();
}

void SceneView::setInfluence(int joint, std::shared_ptr<const std::vector<float>> shares) {
  const bool other = shares != state_->influence;
  state_->picked_joint = joint;
  state_->influence = std::move(shares);
  if (other) state_->buildCloud();
  state_->buildJoints();
}

int SceneView::jointAt(QPointF position) const {
  constexpr double kReach_px = 12;
  if (state_->trails.empty() || !layerShown(SceneLayer::Joints)) return -1;
  const QPointF at = state_->vtk->mapFrom(this, position.toPoint());
  const double ratio = devicePixelRatioF();
  const dvec2 wanted(at.x() * ratio, (state_->vtk->height() - at.y()) * ratio);
  double nearest = kReach_px * ratio;
  int found = -1;
  const std::vector<vec3>& joints = state_->trails.back();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    state_->overlay->SetWorldPoint(joints[j].x, joints[j].y, joints[j].z, 1);
    state_->overlay->WorldToDisplay();
    const double* display = state_->overlay->GetDisplayPoint();
    const double away = glm::distance(dvec2(display[0], display[1]), wanted);
    if (away >= nearest) continue;
    nearest = away;
    found = static_cast<int>(j);
  }
  return found;
}

// A press that does not become a drag picks; everything goes on to the camera.
bool SceneView::eventFilter(QObject* watched, QEvent* event) {
  constexpr double kStill_px = 4;
  if (event->type() == QEvent::MouseButtonPress) {
    state_->pressed_at = static_cast<QMouseEvent*>(event)->localPos();
  } else if (event->type() == QEvent::MouseButtonRelease && !state_->trails.empty()) {
    const auto* mouse = static_cast<QMouseEvent*>(event);
    const QPointF moved = mouse->localPos() - state_->pressed_at;
    if (mouse->button() == Qt::LeftButton && moved.manhattanLength() < kStill_px)
      Q_EMIT jointPicked(jointAt(state_->vtk->mapTo(this, mouse->localPos().toPoint())));
  }
  return QWidget::eventFilter(watched, event);
}

void SceneView::setMesh(std::shared_ptr<const Mesh> mesh) {
  State& s = *state_;
  if (!mesh || mesh->triangles.empty()) {
    s.build(SceneLayer::Mesh, {}, {});
    return;
  }
  s.build(
      SceneLayer::Mesh, [mesh] { return meshOf(*mesh); },
      QString("%L1 triangles").arg(mesh->triangles.size()));
}

void SceneView::setLayerShown(SceneLayer layer, bool shown) {
  State& s = *state_;
  const int i = static_cast<int>(layer);
  s.actors[i]->SetVisibility(shown);
  if (layer == SceneLayer::Grid) {
    for (auto& name : s.axis_names) name->SetVisibility(shown);
  }
  s.toggles[i]->setChecked(shown);
  s.render();
}

bool SceneView::layerShown(SceneLayer layer) const {
  return state_->actors[static_cast<int>(layer)]->GetVisibility();
}

void SceneView::goHome() {
  State& s = *state_;
  OrbitCamera orbit{.azimuth_rad = 0.6f, .elevation_rad = 0.35f};
  orbit.frame(s.bounds);
  const dvec3 eye = centerOf(orbit.camera(100, 100));
  vtkCamera* camera = s.renderer->GetActiveCamera();
  camera->SetPosition(eye.x, eye.y, eye.z);
  camera->SetFocalPoint(orbit.target_m.x, orbit.target_m.y, orbit.target_m.z);
  camera->SetViewUp(0, 1, 0);
  camera->SetViewAngle(orbit.field_of_view_rad * 180 / kPi);
  s.renderer->ResetCameraClippingRange();
  s.render();
}

bool SceneView::handleKey(const QKeyEvent& event) {
  if (event.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) return false;
  switch (event.key()) {
    case Qt::Key_F:
    case Qt::Key_H:
      goHome();
      return true;
    case Qt::Key_K:
      setLayerShown(SceneLayer::Cameras, !layerShown(SceneLayer::Cameras));
      return true;
    case Qt::Key_G:
      setLayerShown(SceneLayer::Grid, !layerShown(SceneLayer::Grid));
      return true;
    case Qt::Key_J:
      setLayerShown(SceneLayer::Joints, !layerShown(SceneLayer::Joints));
      return true;
    default:
      return false;
  }
}

bool SceneView::settled() const { return state_->arrived == state_->tickets; }

}  // namespace beam
