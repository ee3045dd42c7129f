// SPDX-License-Identifier: Apache-2.0
// The scene view: where cameras, seed points, Gaussians and mesh are in the world. The only user of VTK.
#pragma once

#include <QWidget>

#include <memory>
#include <optional>

#include "core/scene/capture.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/mesh.h"
#include "viewers/orbit_camera.h"

class QKeyEvent;

namespace beam {

enum class SceneLayer { Cameras, SeedPoints, Gaussians, Mesh, Grid, Joints };
inline constexpr int kSceneLayerCount = 6;

class SceneView final : public QWidget {
  Q_OBJECT

 public:
  explicit SceneView(QWidget* parent = nullptr);
  ~SceneView() override;

  // Null takes the layer's content away. Geometry is built on a background thread, once its
  // layer can be seen.
  // Another capture starts from home with the layers of the beginning: all but the mesh.
  void setCapture(std::shared_ptr<const CaptureSet> capture);
  void setCloud(std::shared_ptr<const GaussianCloud> cloud);
  void setMesh(std::shared_ptr<const Mesh> mesh);

  // By moment, oldest first, the same joints in each; empty: none, and `hint` says why. An earlier moment
  // with another number of joints is refused (Error{Bug}).
  void setJoints(const std::vector<std::vector<vec3>>& trails, const QString& hint);
  // The share of a joint in each Gaussian of the cloud, in false colours; -1 and empty: own colours. Shares
  // of another number than the cloud has Gaussians wait for a cloud that fits.
  void setInfluence(int joint, std::shared_ptr<const std::vector<float>> shares);
  // The joint nearest to a point of this widget, within a finger's breadth; -1: none.
  int jointAt(QPointF position) const;

  void setLayerShown(SceneLayer layer, bool shown);
  bool layerShown(SceneLayer layer) const;

  void goHome();
  // Fills the picture with the person: the cloud, else the mesh, else the seed points without strays, else
  // the cameras. Keeps the direction.
  void frameSubject();
  void setPreset(ViewPreset preset);  // keeps target and distance
  // From the eye of a camera, until the first drag, turn of the wheel or Esc.
  void lookThrough(std::optional<ViewIndex> view);
  std::optional<ViewIndex> lookedThrough() const;
  // Tells one camera from the others by colour, width and name.
  void markCamera(std::optional<ViewIndex> view);
  std::optional<ViewIndex> markedCamera() const;
  // The frustum whose line is nearest to a point of this widget, within a finger's breadth.
  std::optional<ViewIndex> cameraAt(QPointF position) const;

  // The free camera; that of a capture's camera is put over it by lookThrough().
  const OrbitCamera& orbit() const;
  // Of mesh and ellipsoids, as they are drawn now: fewer while the camera moves.
  std::size_t drawnTriangles() const;
  // What is shown with the words over it, without the row of buttons.
  QImage picture();

  bool handleKey(const QKeyEvent& event);
  bool settled() const;

  QSize minimumSizeHint() const override;

 Q_SIGNALS:
  void jointPicked(int joint);                 // -1: pressed where none is
  void cameraPicked(beam::ViewIndex view);     // pressed, or stepped to with [ and ]
  void cameraActivated(beam::ViewIndex view);  // pressed twice: the view looks through it

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;
  bool event(QEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  friend class SceneLabels;
  struct State;

  void showLayersOfTheBeginning();

  std::unique_ptr<State> state_;
};

}  // namespace beam
