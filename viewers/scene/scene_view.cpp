// SPDX-License-Identifier: Apache-2.0
#include "viewers/scene/scene_view.h"

#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindowInteractor.h>

#include <QResizeEvent>
#include <QVBoxLayout>

#include "core/base/error.h"
#include "viewers/scene/scene_state.h"

namespace beam {
namespace {

constexpr int kLeastLines = 4;  // of text: the height that is kept for the picture
constexpr float kGridCell_m = 0.25f;
constexpr int kRest_ms = 160;  // without movement before the whole mesh

struct LayerWords {
  const char *title, *tip;
};
const std::array<LayerWords, kSceneLayerCount> kWords{
    {{"Cameras", "The capture's cameras: blue for fitting, orange for testing (K)"},
     {"Seed points", "Points that came with the capture"},
     {"Gaussians", "The largest Gaussians as ellipsoids"},
     {"Mesh", "The surface as triangles"},
     {"Grid and axes", "The floor in cells of 25 cm, and the world's axes (G)"},
     {"Joints", "The joints that move the skin; press one to see its influence (J)"}}};

vtkSmartPointer<vtkActor> emptyActor() {
  auto actor = vtkSmartPointer<vtkActor>::New();
  auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
  mapper->SetInputData(vtkSmartPointer<vtkPolyData>::New());
  actor->SetMapper(mapper);
  return actor;
}

}  // namespace

void SceneView::State::addActors() {
  for (int i = 0; i < kSceneLayerCount; ++i) {
    actors[i] = emptyActor();
    (i == static_cast<int>(SceneLayer::Joints) ? overlay : renderer)->AddActor(actors[i]);
    coarse[i] = emptyActor();
    renderer->AddActor(coarse[i]);
  }
  mark = emptyActor();
  overlay->AddActor(mark);
  const auto actor = [&](SceneLayer layer) { return actors[static_cast<int>(layer)].Get(); };
  for (vtkActor* flat : {actor(SceneLayer::Cameras), actor(SceneLayer::SeedPoints), actor(SceneLayer::Grid),
                         actor(SceneLayer::Joints), mark.Get()})
    flat->GetProperty()->LightingOff();
  for (const SceneLayer solid : {SceneLayer::Gaussians, SceneLayer::Mesh}) {
    actor(solid)->GetProperty()->SetAmbient(0.35);
    actor(solid)->GetProperty()->SetDiffuse(0.65);
    actor(solid)->GetProperty()->SetInterpolationToGouraud();
    coarse[static_cast<int>(solid)]->SetProperty(actor(solid)->GetProperty());
  }
}

void SceneView::State::layOut() {
  auto* row = new WrappingRow(6);
  button_row = row;
  row->setContentsMargins(8, 6, 8, 6);
  for (int i = 0; i < kSceneLayerCount; ++i) {
    auto* button = new QToolButton;
    button->setText(kWords[i].title);
    button->setToolTip(kWords[i].tip);
    button->setCheckable(true);
    button->setFocusPolicy(Qt::StrongFocus);
    const auto layer = static_cast<SceneLayer>(i);
    QObject::connect(button, &QToolButton::toggled, &owner,
                     [this, layer](bool on) { owner.setLayerShown(layer, on); });
    row->addWidget(button);
    toggles[i] = button;
  }
  facts = new ElidedLine;
  facts->setObjectName("quiet");
  facts->setContentsMargins(10, 0, 10, 6);
  vtk = new QVTKOpenGLNativeWidget;
  vtk->setRenderWindow(window.Get());
  // The keys of VTK (quit, wireframe, pick, stereo ...) and its mouse would be a second hand on the camera.
  window->GetInteractor()->SetInteractorStyle(nullptr);
  vtk->setFocusPolicy(Qt::StrongFocus);
  vtk->setMouseTracking(true);
  vtk->installEventFilter(&owner);
  labels = new SceneLabels(*this, vtk);
  auto* column = new QVBoxLayout(&owner);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addLayout(row);
  column->addWidget(facts);
  column->addWidget(vtk, 1);
  owner.setFocusProxy(vtk);
}

void SceneView::State::setUpWindow() {
  window->SetNumberOfLayers(2);
  window->SetMultiSamples(0);
  window->AddRenderer(renderer);
  overlay->SetLayer(1);
  overlay->InteractiveOff();
  overlay->SetActiveCamera(renderer->GetActiveCamera());
  window->AddRenderer(overlay);
  renderer->SetBackground(0.106, 0.110, 0.118);
  rest_timer.setSingleShot(true);
  rest_timer.setInterval(kRest_ms);
  QObject::connect(&rest_timer, &QTimer::timeout, &owner, [this] { rest(); });
  render_timer.setSingleShot(true);
  render_timer.setInterval(0);
  QObject::connect(&render_timer, &QTimer::timeout, &owner, [this] { render(); });
}

SceneView::SceneView(QWidget* parent) : QWidget(parent), state_(std::make_unique<State>(*this)) {
  State& s = *state_;
  s.layOut();
  s.addActors();
  s.setUpWindow();
  s.updateFacts();
  s.show(SceneLayer::Grid, {gridAndAxes(kGridExtent_m, kGridCell_m), {}});
  showLayersOfTheBeginning();
  goHome();
}

SceneView::~SceneView() = default;

void SceneView::showLayersOfTheBeginning() {
  // The mesh would hide the ellipsoids.
  for (int i = 0; i < kSceneLayerCount; ++i)
    setLayerShown(static_cast<SceneLayer>(i), i != static_cast<int>(SceneLayer::Mesh));
}

void SceneView::setCapture(std::shared_ptr<const CaptureSet> capture) {
  State& s = *state_;
  if (capture == s.capture && capture) return;
  s.capture = std::move(capture);
  s.look_through.reset();
  s.marked.reset();
  s.trails.clear();
  s.joint_hint.clear();
  setInfluence(-1, nullptr);
  s.buildCapture();
  s.buildMark();
  showLayersOfTheBeginning();
  goHome();
}

void SceneView::setCloud(std::shared_ptr<const GaussianCloud> cloud) {
  if (cloud == state_->cloud) return;
  state_->cloud = std::move(cloud);
  state_->buildCloud();
  state_->buildJoints();
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
  return state_->jointAt(state_->vtk->mapFrom(this, position.toPoint()));
}

std::optional<ViewIndex> SceneView::cameraAt(QPointF position) const {
  return state_->cameraAt(state_->vtk->mapFrom(this, position.toPoint()));
}

void SceneView::setLayerShown(SceneLayer layer, bool shown) {
  State& s = *state_;
  const int i = static_cast<int>(layer);
  if (s.shown[i] == shown) return;
  s.shown[i] = shown;
  s.toggles[i]->setChecked(shown);
  s.buildIfSeen(layer);
  s.updateVisibility();
  s.render();
}

bool SceneView::layerShown(SceneLayer layer) const { return state_->shown[static_cast<int>(layer)]; }

void SceneView::markCamera(std::optional<ViewIndex> view) {
  State& s = *state_;
  if (view && (!s.capture || view->value < 0 || view->value >= static_cast<int>(s.capture->views.size())))
    view.reset();
  if (view == s.marked) return;
  s.marked = view;
  s.buildMark();
  s.render();
}

std::optional<ViewIndex> SceneView::markedCamera() const { return state_->marked; }
std::optional<ViewIndex> SceneView::lookedThrough() const { return state_->look_through; }
const OrbitCamera& SceneView::orbit() const { return state_->orbit; }

std::size_t SceneView::drawnTriangles() const {
  std::size_t triangles = 0;
  for (const auto& actors : {state_->actors, state_->coarse}) {
    for (vtkActor* actor : actors)
      if (actor->GetVisibility())
        triangles += static_cast<std::size_t>(geometryOf(actor)->GetNumberOfPolys());
  }
  return triangles;
}

QImage SceneView::picture() {
  state_->dragging = false;
  state_->rest();
  if (!state_->vtk->isVisible()) state_->window->Render();
  return state_->vtk->grab().toImage();
}

// The buttons wrap where the view is narrow; what they then need is no view's minimum by itself.
QSize SceneView::minimumSizeHint() const {
  const int words = state_->button_row->heightForWidth(width()) + state_->facts->sizeHint().height();
  return {QWidget::minimumSizeHint().width(), words + kLeastLines * fontMetrics().height()};
}

void SceneView::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  if (event->oldSize().width() != width()) updateGeometry();
}

void SceneView::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  for (int i = 0; i < kSceneLayerCount; ++i) state_->buildIfSeen(static_cast<SceneLayer>(i));
}

bool SceneView::settled() const {
  const State& s = *state_;
  return s.arrived == s.tickets && !s.rest_timer.isActive() && !s.render_timer.isActive();
}

}  // namespace beam
