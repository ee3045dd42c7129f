// SPDX-License-Identifier: Apache-2.0
// The words that a widget paints, where it paints them and what it cuts off; of drawn widgets as of labels.
#pragma once

#include <QRectF>
#include <QString>
#include <QWidget>

#include <vector>

namespace beam::testing {

struct PaintedText {
  QString text;
  QRectF place;  // in the widget
  QRectF clip;   // what of the widget is painted
  // How much of it is missing at the sides, or at top and bottom.
  double cutWide() const;
  double cutHigh() const;
};

// Of the widget alone, without what lies in it. Painting through OpenGL cannot be listened to: those have
// none.
std::vector<PaintedText> paintedTexts(QWidget& widget);

}  // namespace beam::testing
