// SPDX-License-Identifier: Apache-2.0
// The image view with what one chooses for it: the camera, picture A, picture B and the wipe.
#pragma once

#include <QWidget>

#include "ui/picture_sources.h"

class QComboBox;
class QToolButton;

namespace beam {

class ImageView;

class ImagePage final : public QWidget {
  Q_OBJECT

 public:
  explicit ImagePage(const ProjectModel& model, QWidget* parent = nullptr);

  ImageView& view() { return *view_; }
  void setLight(const PictureLight& light);
  // Looks at the model again: cameras, what exists now. Keeps the choices that are still possible.
  void refresh();
  void choose(ViewIndex view);
  // By the ids of picture_sources.h; an empty B takes the wipe away.
  void choosePictures(const QString& a, const QString& b);

 Q_SIGNALS:
  void cameraChosen(beam::ViewIndex view);

 private:
  void fillPictures();
  void show(int side);
  QString chosenId(int side) const;

  const ProjectModel& model_;
  PictureLight light_;
  std::vector<PictureSource> sources_;
  std::array<QString, 2> wanted_{"photo", {}};  // ids; shown as soon as they exist
  QComboBox* cameras_;
  std::array<QComboBox*, 2> pictures_;
  QToolButton* wipe_;
  ImageView* view_;
};

}  // namespace beam
