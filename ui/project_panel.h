// SPDX-License-Identifier: Apache-2.0
// What the project holds: capture and counts, the frame in view, the last scores, the cameras with their
// problems. A click or an arrow key chooses a camera, a double click or Enter looks through it.
#pragma once

#include <QWidget>

#include <map>
#include <string>

#include "ui/project_model.h"

class QGridLayout;
class QLabel;
class QTreeWidget;
class QTreeWidgetItem;

namespace beam {

class ElidedLabel;
class QuietCombo;

class ProjectPanel final : public QWidget {
  Q_OBJECT

 public:
  explicit ProjectPanel(ProjectModel& model, QWidget* parent = nullptr);
  void refreshScores();
  void mark(std::optional<ViewIndex> view);  // the camera looked through, or chosen elsewhere
  // Texts by camera name: the row shows how many, its tooltip which.
  void setProblems(std::map<std::string, QStringList> problems);
  QTreeWidget& cameras() { return *cameras_; }
  QSize minimumSizeHint() const override;

 Q_SIGNALS:
  void cameraChosen(beam::ViewIndex view);
  void cameraActivated(beam::ViewIndex view);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void makeColumn();
  void connectAll();
  void refresh();
  void refreshFacts();
  void fillCameras();
  void showProblems();
  void fitRows();
  void fitColumns();
  std::optional<ViewIndex> viewOf(const QTreeWidgetItem* item) const;

  ProjectModel& model_;
  ElidedLabel *name_, *scores_title_;
  QLabel* facts_;
  QuietCombo* frames_;
  QGridLayout* scores_;
  QTreeWidget* cameras_;
  std::map<std::string, QStringList> problems_;
};

}  // namespace beam
