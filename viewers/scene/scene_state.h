// SPDX-License-Identifier: Apache-2.0
// What is behind the scene view: the VTK objects, what they show, and the camera. Private to the view.
#pragma once

#include <QVTKOpenGLNativeWidget.h>
#include <vtkActor.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>

#include <QTimer>
#include <QToolButton>

#include <array>
#include <functional>

#include "viewers/latest_worker.h"
#include "viewers/orbit_camera.h"
#include "viewers/scene/narrow_rows.h"
#include "viewers/scene/scene_view.h"
#include "viewers/scene/vtk_convert.h"

namespace beam {

inline constexpr float kGridExtent_m = 2;

// A layer's geometry, and a stand-in for it while the camera moves; null: it needs none.
struct BuiltLayer {
  PolyData full, coarse;
};

inline vtkPolyData* geometryOf(vtkActor* actor) {
  return static_cast<vtkPolyDataMapper*>(actor->GetMapper())->GetInput();
}
// "1 camera", "1,234 cameras".
QString counted(std::size_t count, const QString& thing);
// Middle and radius of the densest part; also a third of the points far away do not count.
Bounds subjectBounds(const std::vector<vec3>& positions_m);

class SceneLabels;

struct SceneView::State {
  explicit State(SceneView& o) : owner(o) {}

  // Made once.
  void layOut();
  void addActors();
  void setUpWindow();

  // Layers (scene_layers.cpp).
  void show(SceneLayer layer, const BuiltLayer& data);
  void buildIfSeen(SceneLayer layer);  // else what it needs keeps waiting
  void build(SceneLayer layer, std::function<BuiltLayer()> make_data, const QString& count);
  void buildCapture();
  void buildCloud();
  void buildJoints();
  void buildMark();
  void updateFacts();
  void updateVisibility();
  void updateSizes();
  bool markShown() const;
  double frustumLength() const { return 0.11 * home.radius_m; }
  bool influenceFits() const { return influence && cloud && influence->size() == cloud->size(); }

  // Camera (scene_input.cpp).
  Camera camera() const;  // pixels: device-independent ones of the picture
  void place();
  void render();  // unless nobody can see it
  void jump();    // the camera stands elsewhere: the picture of now
  void moved();   // the camera goes on moving: the next picture is soon enough
  void rest();
  void startMoving();
  void handleMouse(const QMouseEvent& mouse);
  void drag(QPointF at, Qt::MouseButtons buttons);
  void hover(QPointF at);
  void leaveCamera();
  void stepCamera(int step);
  Bounds subject() const;

  // What is under the pointer, in pixels of the picture (scene_pick.cpp).
  std::optional<QPointF> onScreen(vec3 point) const;  // nothing: behind the eye
  int jointAt(QPointF at) const;
  std::optional<ViewIndex> cameraAt(QPointF at) const;
  std::optional<vec3> surfaceAt(QPointF at);
  void pressAt(QPointF at);
  void doubleClickAt(QPointF at);

  SceneView& owner;
  QVTKOpenGLNativeWidget* vtk = nullptr;
  SceneLabels* labels = nullptr;  // over the picture
  WrappingRow* button_row = nullptr;
  ElidedLine* facts = nullptr;
  std::array<QToolButton*, kSceneLayerCount> toggles{};
  vtkSmartPointer<vtkGenericOpenGLRenderWindow> window = vtkSmartPointer<vtkGenericOpenGLRenderWindow>::New();
  vtkSmartPointer<vtkRenderer> renderer = vtkSmartPointer<vtkRenderer>::New();
  vtkSmartPointer<vtkRenderer> overlay = vtkSmartPointer<vtkRenderer>::New();  // seen through the skin
  std::array<vtkSmartPointer<vtkActor>, kSceneLayerCount> actors;
  std::array<vtkSmartPointer<vtkActor>, kSceneLayerCount> coarse;  // without geometry: the layer needs none
  vtkSmartPointer<vtkActor> mark;
  std::array<bool, kSceneLayerCount> shown{};
  std::array<QString, kSceneLayerCount> counts;
  std::array<std::function<BuiltLayer()>, kSceneLayerCount> waiting;  // until somebody can see it

  std::shared_ptr<const CaptureSet> capture;
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<const Mesh> mesh;
  std::shared_ptr<const std::vector<float>> influence;
  JointTrails trails;
  QString joint_hint;
  int picked_joint = -1;
  float joint_size_px = 1;

  OrbitCamera orbit;
  Bounds home{vec3(0, 0.9f, 0), 2.5f};
  std::optional<ViewIndex> look_through, marked;
  QPointF pressed_at, last_mouse;
  bool pressed = false, dragging = false;
  bool moving = false;
  QTimer rest_timer, render_timer;

  // A layer that is replaced while it is built never arrives; the newest always does.
  std::array<int, kSceneLayerCount> tickets{}, arrived{};
  std::array<LatestWorker, kSceneLayerCount> workers;  // last: they stop first
};

// Names and the legend over the picture (scene_labels.cpp).
class SceneLabels final : public QWidget {
 public:
  SceneLabels(const SceneView::State& state, QWidget* parent);
  void setRing(bool shown);  // the focus of the view came by the keyboard

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paintLegend(QPainter& painter) const;
  void paintPickedJoint(QPainter& painter) const;
  void paintAxisNames(QPainter& painter) const;
  void paintMarkedName(QPainter& painter) const;
  void paintLookThrough(QPainter& painter) const;

  const SceneView::State& state_;
  bool ring_ = false;
};

}  // namespace beam
