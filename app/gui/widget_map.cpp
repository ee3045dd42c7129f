// SPDX-License-Identifier: Apache-2.0
#include "app/gui/widget_map.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QApplication>
#include <QComboBox>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QMenuBar>
#include <QProgressBar>
#include <QSaveFile>
#include <QTabBar>

#include "ui/elided_label.h"

namespace beam {
namespace {

constexpr int kEvery_ms = 250;

QString plain(QString text) { return text.remove('&'); }

QString textOf(const QWidget& w) {
  if (const auto* elided = qobject_cast<const ElidedLabel*>(&w)) return elided->text();
  if (const auto* label = qobject_cast<const QLabel*>(&w)) return label->text();
  if (const auto* button = qobject_cast<const QAbstractButton*>(&w)) return plain(button->text());
  if (const auto* box = qobject_cast<const QComboBox*>(&w)) return box->currentText();
  if (const auto* line = qobject_cast<const QLineEdit*>(&w)) return line->text();
  if (const auto* bar = qobject_cast<const QProgressBar*>(&w)) return bar->text();
  return w.isWindow() ? w.windowTitle() : QString();
}

// In pixels of the screen, as X counts them.
QJsonArray placeOf(const QWidget& w, const QRect& inside) {
  const double scale = w.devicePixelRatioF();
  const QPoint corner = w.mapToGlobal(inside.topLeft());
  return {scale * corner.x(), scale * corner.y(), scale * inside.width(), scale * inside.height()};
}

QJsonObject entry(const QWidget& w, const QRect& inside, const QString& kind, const QString& text) {
  return {{"kind", kind},
          {"name", w.objectName()},
          {"text", text},
          {"tip", w.toolTip()},
          {"enabled", w.isEnabled()},
          {"window", w.window()->metaObject()->className()},
          {"place", placeOf(w, inside)}};
}

void addParts(QJsonArray& all, const QWidget& w) {
  if (const auto* tabs = qobject_cast<const QTabBar*>(&w)) {
    for (int i = 0; i < tabs->count(); ++i) {
      QJsonObject tab = entry(w, tabs->tabRect(i), "Tab", plain(tabs->tabText(i)));
      tab["checked"] = i == tabs->currentIndex();
      all.append(tab);
    }
  } else if (const auto* list = qobject_cast<const QAbstractItemView*>(&w)) {
    const int middle = list->viewport()->width() / 2, below = list->viewport()->height();
    for (int y = 2; y < below;) {
      const QModelIndex row = list->indexAt({middle, y});
      if (!row.isValid()) break;
      all.append(entry(*list->viewport(), list->visualRect(row), "Row", row.data().toString()));
      y = list->visualRect(row).bottom() + 3;
    }
  } else if (const auto* bar = qobject_cast<const QMenuBar*>(&w)) {
    for (QAction* action : bar->actions())
      all.append(entry(w, bar->actionGeometry(action), "Menu", plain(action->text())));
  } else if (const auto* menu = qobject_cast<const QMenu*>(&w)) {
    for (QAction* action : menu->actions()) {
      QJsonObject made = entry(w, menu->actionGeometry(action), "Entry", plain(action->text()));
      made["enabled"] = action->isEnabled();
      made["checked"] = action->isChecked();
      all.append(made);
    }
  }
}

}  // namespace

WidgetMap::WidgetMap(const QString& file) : file_(file) {
  timer_.setInterval(kEvery_ms);
  connect(&timer_, &QTimer::timeout, this, &WidgetMap::write);
  timer_.start();
}

void WidgetMap::write() {
  QJsonArray all;
  for (const QWidget* w : QApplication::allWidgets()) {
    // What lies outside of a scrolled area cannot be pressed.
    if (!w->isVisible() || (w->visibleRegion().isEmpty() && !w->isWindow())) continue;
    const QRect seen = w->visibleRegion().boundingRect();
    QJsonObject made = entry(*w, seen.isEmpty() ? w->rect() : seen, w->metaObject()->className(), textOf(*w));
    if (const auto* button = qobject_cast<const QAbstractButton*>(w)) made["checked"] = button->isChecked();
    if (w == QApplication::focusWidget()) made["focus"] = true;
    all.append(made);
    addParts(all, *w);
  }
  // Whole or not at all: the reader comes at any moment. A file that cannot be written is missed by it.
  QSaveFile out(file_);
  if (!out.open(QIODevice::WriteOnly)) return;
  out.write(QJsonDocument(QJsonObject{{"tick", ++tick_}, {"widgets", all}}).toJson(QJsonDocument::Compact));
  out.commit();
}

std::unique_ptr<WidgetMap> widgetMapWanted() {
  const QString file = qEnvironmentVariable("BEAM_STUDIO_MAP");
  return file.isEmpty() ? nullptr : std::make_unique<WidgetMap>(file);
}

}  // namespace beam
