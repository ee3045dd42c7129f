// SPDX-License-Identifier: Apache-2.0
// The image view with what one chooses for it: the camera, pictures A and B, how they are compared, and the
// limits of false colours.
#pragma once

#include <QWidget>

#include <optional>

#include "ui/picture_sources.h"

class QBoxLayout;
class QCheckBox;
class QLineEdit;
class QToolButton;

namespace beam {

class ImageView;
class QuietCombo;

class ImagePage final : public QWidget {
  Q_OBJECT

 public:
  explicit ImagePage(const ProjectModel& model, QWidget* parent = nullptr);

  ImageView& view() { return *view_; }
  void setLight(const PictureLight& light);
  // Looks at the model again: cameras, what exists now. Keeps the choices; what has not changed is not read
  // again.
  void refresh();
  void choose(ViewIndex view);
  // By the ids of picture_sources.h; an empty B takes wipe and difference away.
  void choosePictures(const QString& a, const QString& b);
  // As at first: what belonged to the project that was open is gone.
  void reset();

 Q_SIGNALS:
  void cameraChosen(beam::ViewIndex view);

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  QWidget* makeChoice();
  QWidget* makeComparing();
  QWidget* makeHolding();
  void connectParts();
  void arrangeRows();
  void fillCameras();
  void fillPictures();
  void fillChoices(int side);
  void showPicture(int side);
  void takeChoice(int side);
  // A comparison with nothing would show nothing: B becomes the render, or the photograph where A is that.
  void requireB();
  void mirrorLegend();
  void takeLimits();
  void refuseWhatIsNotThere();
  const PictureSource* chosen(int side) const;

  struct Shown {
    QString id;
    PictureIngredients made_of;
  };

  const ProjectModel& model_;
  PictureLight light_;
  std::vector<PictureSource> sources_;
  std::array<QString, 2> wanted_;  // ids
  std::array<std::optional<Shown>, 2> shown_;
  QuietCombo* cameras_;
  std::array<QuietCombo*, 2> pictures_;
  QToolButton *wipe_, *difference_;
  QCheckBox* lock_;
  std::array<QLineEdit*, 2> limits_;  // low, high
  QString limits_unit_;
  QBoxLayout* choice_layout_;
  QWidget *choice_, *comparing_, *holding_, *rows_;
  QBoxLayout *row_layout_, *judging_layout_;
  ImageView* view_;
};

}  // namespace beam
