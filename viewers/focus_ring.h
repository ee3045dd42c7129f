// SPDX-License-Identifier: Apache-2.0
// The ring around a view that has the focus. A view is pressed and gets keys all the time: only who came by
// the keyboard needs to see where he is.
#pragma once

#include <QFocusEvent>
#include <QPainter>
#include <QWidget>

namespace beam {

inline bool cameByKey(const QFocusEvent& event) {
  return event.reason() == Qt::TabFocusReason || event.reason() == Qt::BacktabFocusReason ||
         event.reason() == Qt::ShortcutFocusReason;
}

inline void paintFocusRing(QPainter& painter, const QWidget& around) {
  constexpr int kWidth_px = 2;  // as around every other control
  painter.setRenderHint(QPainter::Antialiasing, false);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(around.palette().color(QPalette::Link), kWidth_px));
  painter.drawRect(around.rect().adjusted(1, 1, -1, -1));
}

}  // namespace beam
