// SPDX-License-Identifier: Apache-2.0
// What the project holds: capture and counts, the frame in view, the last scores, the cameras.
#pragma once

#include <QWidget>

#include "ui/project_model.h"

class QComboBox;
class QGridLayout;
class QLabel;
class QTreeWidget;

namespace beam {

class ProjectPanel final : public QWidget {
  Q_OBJECT

 public:
  explicit ProjectPanel(ProjectModel& model, QWidget* parent = nullptr);
  void refreshScores();
  void mark(std::optional<ViewIndex> view);  // the camera looked through

 Q_SIGNALS:
  void cameraActivated(beam::ViewIndex view);

 private:
  void refresh();
  void refreshFacts();
  void fillCameras();

  ProjectModel& model_;
  QLabel *name_, *facts_, *scores_title_;
  QComboBox* frames_;
  QGridLayout* scores_;
  QTreeWidget* cameras_;
};

}  // namespace beam
