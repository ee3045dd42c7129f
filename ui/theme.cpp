// SPDX-License-Identifier: Apache-2.0
#include "ui/theme.h"

#include <QApplication>
#include <QFile>
#include <QFont>
#include <QPalette>
#include <QStyleFactory>

// Resources of a static library are linked only when named; the macro must stand outside of namespaces.
static void nameTheme() { Q_INIT_RESOURCE(theme); }

namespace beam {

void applyTheme(QApplication& application) {
  nameTheme();
  QApplication::setStyle(QStyleFactory::create("Fusion"));
  QPalette palette;  // for what the sheet does not reach: indicators, disabled text, native drawing
  palette.setColor(QPalette::Window, QColor("#232529"));
  palette.setColor(QPalette::WindowText, QColor("#d9dce1"));
  palette.setColor(QPalette::Base, QColor("#1f2124"));
  palette.setColor(QPalette::AlternateBase, QColor("#222428"));
  palette.setColor(QPalette::Text, QColor("#d9dce1"));
  palette.setColor(QPalette::Button, QColor("#2d3035"));
  palette.setColor(QPalette::ButtonText, QColor("#d9dce1"));
  palette.setColor(QPalette::Highlight, QColor("#3d6fb4"));
  palette.setColor(QPalette::HighlightedText, Qt::white);
  palette.setColor(QPalette::ToolTipBase, QColor("#33373d"));
  palette.setColor(QPalette::ToolTipText, QColor("#eceef1"));
  palette.setColor(QPalette::PlaceholderText, QColor("#757b84"));
  QApplication::setPalette(palette);
  QFont font = QApplication::font();
  font.setPixelSize(13);
  QApplication::setFont(font);
  QFile sheet(":/theme/studio.qss");
  if (sheet.open(QIODevice::ReadOnly)) application.setStyleSheet(QString::fromUtf8(sheet.readAll()));
}

}  // namespace beam
