// SPDX-License-Identifier: Apache-2.0
// How the splat view shows: channel, light and its turn, exposure, sky, photograph. A mirror of its
// ViewState.
#pragma once

#include <QWidget>

#include "ui/light_library.h"
#include "viewers/view_state.h"

class QCheckBox;
class QLabel;
class QPushButton;
class QSlider;

namespace beam {

class QuietCombo;
class SplatView;

class DisplayPanel final : public QWidget {
  Q_OBJECT

 public:
  DisplayPanel(SplatView& view, LightLibrary& lights, QWidget* parent = nullptr);

 Q_SIGNALS:
  void openLightWanted();

 private:
  void makeRows();
  void connectParts();
  void mirror(const ViewState& state);
  void fillLights();

  SplatView& view_;
  LightLibrary& lights_;
  QuietCombo* channel_;
  QuietCombo* light_;
  QSlider* yaw_;
  QSlider* exposure_;
  QSlider* photo_;
  QLabel *yaw_words_, *exposure_words_, *photo_words_;
  QCheckBox *sky_, *lock_depth_;
  QPushButton* open_;
};

}  // namespace beam
