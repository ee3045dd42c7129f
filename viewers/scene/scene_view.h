// SPDX-License-Identifier: Apache-2.0
// The scene view: where cameras, seed points, Gaussians and mesh are in the world. The only user of VTK.
#pragma once

#include <QWidget>

#include <memory>

#include "core/scene/capture.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/mesh.h"

class QKeyEvent;

namespace beam {

enum class SceneLayer { Cameras, SeedPoints, Gaussians, Mesh, Grid };
inline constexpr int kSceneLayerCount = 5;

class SceneView final : public QWidget {
  Q_OBJECT

 public:
  explicit SceneView(QWidget* parent = nullptr);
  ~SceneView() override;

  // Null takes the layer's content away. Geometry is built on a background thread.
  void setCapture(std::shared_ptr<const CaptureSet> capture);
  void setCloud(std::shared_ptr<const GaussianCloud> cloud);
  void setMesh(std::shared_ptr<const Mesh> mesh);

  void setLayerShown(SceneLayer layer, bool shown);
  bool layerShown(SceneLayer layer) const;
  void goHome();

  bool handleKey(const QKeyEvent& event);
  bool settled() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace beam
