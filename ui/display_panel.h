// SPDX-License-Identifier: Apache-2.0
// How a view shows: channel, light and its turn, exposure, sky, photograph. A mirror of the splat view's
// ViewState, of which the other views use less: the rest is grey and says why.
#pragma once

#include <QWidget>

#include "ui/light_library.h"
#include "ui/studio_view.h"
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

  // The view that is seen.
  void setShown(StudioView shown);

 Q_SIGNALS:
  void openLightWanted();

 private:
  void makeRows();
  void connectParts();
  void mirror(const ViewState& state);
  void fillLights();
  void allowLights();
  // Why the view that is seen does not use what is the splat view's alone; empty: it does.
  QString notUsed() const;

  SplatView& view_;
  LightLibrary& lights_;
  StudioView shown_ = StudioView::Splat;
  QuietCombo* channel_;
  QuietCombo* light_;
  QSlider* yaw_;
  QSlider* exposure_;
  QSlider* photo_;
  QLabel *yaw_words_, *exposure_words_, *photo_words_, *hands_;
  QCheckBox *sky_, *lock_depth_;
  QPushButton* open_;
};

}  // namespace beam
