// SPDX-License-Identifier: Apache-2.0
#include "tests/support/window_look.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QHelpEvent>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPlainTextEdit>
#include <QProgressBar>
#include <QTabBar>
#include <QToolTip>

#include "ui/elided_label.h"

namespace beam::testing {
namespace {

QString nameOf(const QWidget& w) {
  const QString kind = w.metaObject()->className();
  if (!w.objectName().isEmpty()) return kind + "#" + w.objectName();
  const auto* button = qobject_cast<const QAbstractButton*>(&w);
  // Words tell which of many buttons better than a number does.
  const QString words = button ? plainText(button->text()) : QString();
  return words.isEmpty() ? kind : kind + "\"" + words + "\"";
}

// Names of the widgets that lie in `parent`, numbered where they are alike.
std::map<const QWidget*, QString> namesIn(const QWidget& parent) {
  std::map<const QWidget*, QString> names;
  std::map<QString, int> times;
  for (const QObject* child : parent.children()) {
    const auto* w = qobject_cast<const QWidget*>(child);
    if (!w || w->isWindow()) continue;
    const QString name = nameOf(*w);
    const int time = times[name]++;
    names[w] = time == 0 ? name : name + QString("[%1]").arg(time);
  }
  return names;
}

void walk(const QWidget& parent, const QString& path, std::map<QString, QWidget*>& found) {
  for (const auto& [w, name] : namesIn(parent)) {
    if (!w->isVisible()) continue;
    const QString own = path.isEmpty() ? name : path + "/" + name;
    found[own] = const_cast<QWidget*>(w);
    walk(*w, own, found);
  }
}

QString rowsOf(const QAbstractItemView& view) {
  QStringList chosen;
  if (view.selectionModel()) {
    for (const QModelIndex& index : view.selectionModel()->selectedIndexes())
      chosen << index.data().toString();
    chosen << "at " + view.currentIndex().data().toString();
  }
  return chosen.join(", ");
}

// What it says; and under "value" what is chosen in it.
void tell(WindowLook& look, const QString& path, const QWidget& w) {
  const auto put = [&](const char* property, const QString& value) { look[path + "|" + property] = value; };
  if (const auto* elided = qobject_cast<const ElidedLabel*>(&w)) {
    put("text", elided->text());
  } else if (const auto* label = qobject_cast<const QLabel*>(&w)) {
    put("text", label->text() + (label->pixmap(Qt::ReturnByValue).isNull() ? "" : " picture"));
  } else if (const auto* button = qobject_cast<const QAbstractButton*>(&w)) {
    put("text", button->text());
    put("icon", QString::number(button->icon().cacheKey()));
    if (button->isCheckable()) put("value", button->isChecked() ? "checked" : "not checked");
  } else if (const auto* box = qobject_cast<const QComboBox*>(&w)) {
    put("choices", QString::number(box->count()));
    put("value", box->currentText());
  } else if (const auto* line = qobject_cast<const QLineEdit*>(&w)) {
    put("value", line->text());
  } else if (const auto* bar = qobject_cast<const QProgressBar*>(&w)) {
    put("text", bar->text());
  } else if (const auto* slider = qobject_cast<const QAbstractSlider*>(&w)) {
    put("value", QString::number(slider->value()));
  } else if (const auto* text = qobject_cast<const QPlainTextEdit*>(&w)) {
    put("text", text->toPlainText());
  } else if (const auto* tabs = qobject_cast<const QTabBar*>(&w)) {
    put("value", QString::number(tabs->currentIndex()));
  } else if (const auto* view = qobject_cast<const QAbstractItemView*>(&w)) {
    put("rows", QString::number(view->model() ? view->model()->rowCount() : 0));
    put("value", rowsOf(*view));
  }
}

}  // namespace

QString plainText(QString text) { return text.remove('&').remove("…").remove("...").trimmed(); }

bool isToolkitPart(const QWidget& w) {
  const QString name = w.objectName();
  if (name.startsWith("qt_") && name != "qt_dockwidget_closebutton") return true;
  return name.startsWith("ScrollLeft") || name.startsWith("ScrollRight") ||
         (w.parentWidget() && w.parentWidget()->inherits("QComboBoxPrivateContainer"));
}

QString pathOf(const QWidget& widget) {
  QStringList steps;
  for (const QWidget* w = &widget; !w->isWindow(); w = w->parentWidget())
    steps.prepend(namesIn(*w->parentWidget()).at(w));
  return steps.join("/");
}

std::map<QString, QWidget*> widgetsByPath(const QWidget& window) {
  std::map<QString, QWidget*> found;
  walk(window, {}, found);
  return found;
}

WindowLook lookAt(const QWidget& window) {
  WindowLook look;
  look["window|title"] = window.windowTitle();
  look["window|state"] = QString::number(static_cast<int>(window.windowState()));
  look["window|shown"] = window.isVisible() ? "yes" : "no";
  for (const auto& [path, w] : widgetsByPath(window)) {
    const QRect place = w->geometry();
    look[path + "|place"] =
        QString("%1 %2 %3 %4").arg(place.x()).arg(place.y()).arg(place.width()).arg(place.height());
    look[path + "|grey"] = w->isEnabled() ? "no" : "yes";
    tell(look, path, *w);
  }
  int number = 0;
  for (const QAction* action : window.findChildren<QAction*>()) {
    look[QString("action %1|state").arg(number++)] =
        QString("%1 %2 %3").arg(action->text()).arg(action->isEnabled()).arg(action->isChecked());
  }
  return look;
}

std::set<QString> differences(const WindowLook& a, const WindowLook& b) {
  std::set<QString> keys;
  for (const auto& [key, value] : a) {
    const auto other = b.find(key);
    if (other == b.end() || other->second != value) keys.insert(key);
  }
  for (const auto& [key, value] : b) {
    if (!a.contains(key)) keys.insert(key);
  }
  return keys;
}

QString tipOf(const QWidget& widget) {
  for (const QWidget* w = &widget; w; w = w->parentWidget()) {
    if (!w->toolTip().isEmpty()) return w->toolTip();
    if (w->isWindow()) break;
  }
  return {};
}

QString tipAt(QWidget& w, QPoint at) {
  QToolTip::hideText();
  QHelpEvent wanted(QEvent::ToolTip, at, w.mapToGlobal(at));
  QApplication::sendEvent(&w, &wanted);
  const QString tip = QToolTip::text();
  QToolTip::hideText();
  return tip.isEmpty() ? tipOf(w) : tip;
}

}  // namespace beam::testing
