// SPDX-License-Identifier: Apache-2.0
// Words over pictures: labels that stay inside a width, the legend of false colours, messages of empty views.
#pragma once

#include <QFontMetricsF>
#include <QRectF>
#include <QStringList>

#include <limits>

#include "viewers/false_color.h"

class QPainter;

namespace beam {

enum class LabelTone { Plain, Warning };

struct LabelStyle {
  double width_px = std::numeric_limits<double>::max();  // of the box, which is no wider
  LabelTone tone = LabelTone::Plain;
};

// The lines that a text takes in a width: broken at " · ", then between words; a word that is longer than the
// width is elided.
QStringList labelLines(const QFontMetricsF& metrics, const QString& text, double width_px);

// A label in a rounded box with its corner at `at`; `alignment` says which corner (Qt::AlignLeft |
// Qt::AlignTop ...). Nothing where there are no words or no room.
QRectF paintLabel(QPainter& painter, QPointF at, Qt::Alignment alignment, const QString& text,
                  const LabelStyle& style = {});

// The legend of false colours: a bar with values beside it, in the upper right corner of `area` and no higher
// than that. Nothing where the area holds no two values.
QRectF paintScale(QPainter& painter, const QRectF& area, const Limits& limits, const QString& unit);
double scaleWidth(const QPainter& painter, const Limits& limits, const QString& unit);
// A value between limits, with as many digits as tell it from its neighbours on the legend.
QString scaleText(float value, const Limits& limits, const QString& unit);

// Several lines, centred, for empty states.
void paintMessage(QPainter& painter, const QRectF& area, const QString& title, const QString& body);

}  // namespace beam
