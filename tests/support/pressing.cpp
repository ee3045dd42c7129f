// SPDX-License-Identifier: Apache-2.0
#include "tests/support/pressing.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QActionGroup>
#include <QApplication>
#include <QButtonGroup>
#include <QComboBox>
#include <QContextMenuEvent>
#include <QDialog>
#include <QMenu>
#include <QMenuBar>
#include <QPushButton>
#include <QScrollArea>
#include <QShortcut>
#include <QSlider>
#include <QTabBar>
#include <QToolButton>
#include <QtTest/QTest>

namespace beam::testing {
namespace {

constexpr int kLook_ms = 15;
constexpr int kMostRows = 12;  // of a list: the others are of the same kind

bool isTip(const QWidget& w) { return w.windowType() == Qt::ToolTip; }

QWidget* widgetOf(const QWidget& window, const QString& path) {
  if (path.isEmpty()) return const_cast<QWidget*>(&window);
  const auto all = widgetsByPath(window);
  const auto found = all.find(path);
  return found == all.end() ? nullptr : found->second;
}

QMenu* menuOf(const QWidget& w) {
  if (const auto* tool = qobject_cast<const QToolButton*>(&w)) return tool->menu();
  if (const auto* button = qobject_cast<const QPushButton*>(&w)) return button->menu();
  return nullptr;
}

// --- Finding ---

void addEntries(const QMenu& menu, const Control& way, std::vector<Control>& found) {
  Q_EMIT const_cast<QMenu&>(menu).aboutToShow();  // some menus are filled as they open
  for (const QAction* action : menu.actions()) {
    if (!action->isVisible() || action->isSeparator()) continue;
    Control entry = way;
    entry.words << plainText(action->text().section('\t', 0, 0));
    if (action->menu() && action->isEnabled()) {
      addEntries(*action->menu(), entry, found);
    } else {
      found.push_back(entry);
    }
  }
}

std::vector<QModelIndex> rowsOf(const QAbstractItemView& view, const QModelIndex& parent = {}) {
  std::vector<QModelIndex> rows;
  if (!view.model()) return rows;
  for (int i = 0; i < view.model()->rowCount(parent); ++i) {
    const QModelIndex row = view.model()->index(i, 0, parent);
    if (row.flags() & Qt::ItemIsSelectable) rows.push_back(row);
    for (const QModelIndex& below : rowsOf(view, row)) rows.push_back(below);
  }
  return rows;
}

// Docks behind a tab lie far outside of the window; what is scrolled away can be scrolled to.
bool canBeReached(const QWidget& w) {
  const QRect place(w.mapTo(w.window(), QPoint()), w.size());
  if (place.intersects(w.window()->rect())) return true;
  for (const QWidget* up = w.parentWidget(); up; up = up->parentWidget()) {
    if (qobject_cast<const QScrollArea*>(up)) return canBeReached(*up);
  }
  return false;
}

void addContextEntries(const QString& path, const QWidget& w, std::vector<Control>& found) {
  if (w.contextMenuPolicy() != Qt::ActionsContextMenu) return;
  for (const QAction* action : w.actions()) {
    if (action->isVisible() && !action->isSeparator())
      found.push_back({ControlKind::ContextEntry, path, {plainText(action->text())}, 0, {}, {}});
  }
}

void addControlsOf(const QString& path, const QWidget& w, std::vector<Control>& found) {
  addContextEntries(path, w, found);
  if (const auto* bar = qobject_cast<const QMenuBar*>(&w)) {
    for (const QAction* action : bar->actions()) {
      if (action->menu())
        addEntries(*action->menu(), {ControlKind::Entry, path, {plainText(action->text())}, 0, {}, {}},
                   found);
    }
  } else if (const auto* button = qobject_cast<const QAbstractButton*>(&w)) {
    found.push_back({ControlKind::Button, path, {plainText(button->text())}, 0, {}, {}});
    if (const QMenu* menu = menuOf(w)) addEntries(*menu, {ControlKind::Entry, path, {}, 0, {}, {}}, found);
  } else if (const auto* tabs = qobject_cast<const QTabBar*>(&w)) {
    for (int i = 0; i < tabs->count(); ++i)
      found.push_back({ControlKind::Tab, path, {plainText(tabs->tabText(i))}, i, {}, {}});
  } else if (qobject_cast<const QComboBox*>(&w)) {
    found.push_back({ControlKind::Choice, path, {}, 0, {}, {}});
  } else if (qobject_cast<const QSlider*>(&w) || qobject_cast<const QAbstractSpinBox*>(&w)) {
    found.push_back({ControlKind::Slider, path, {}, 0, {}, {}});
  } else if (const auto* view = qobject_cast<const QAbstractItemView*>(&w)) {
    const std::vector<QModelIndex> rows = rowsOf(*view);
    for (int i = 0; i < std::min(static_cast<int>(rows.size()), kMostRows); ++i)
      found.push_back(
          {ControlKind::Row, path, {rows[static_cast<std::size_t>(i)].data().toString()}, i, {}, {}});
  }
}

QStringList wordsOf(const QKeySequence& keys, const QString& what) {
  return {keys.toString(), plainText(what.section('\t', 0, 0))};
}

QString hintOf(const QWidget& w) {
  if (const auto* box = qobject_cast<const QComboBox*>(&w)) return box->currentText() + " " + w.toolTip();
  return w.toolTip();
}

void addShortcuts(const QWidget& window, std::vector<Control>& found) {
  for (const QAction* action : window.findChildren<QAction*>()) {
    for (const QKeySequence& keys : action->shortcuts()) {
      if (!keys.isEmpty())
        found.push_back({ControlKind::Shortcut, {}, wordsOf(keys, action->text()), 0, {}, {}});
    }
  }
  for (const QShortcut* shortcut : window.findChildren<QShortcut*>()) {
    if (!shortcut->key().isEmpty())
      found.push_back(
          {ControlKind::Shortcut, {}, wordsOf(shortcut->key(), shortcut->whatsThis()), 0, {}, {}});
  }
}

QAction* actionNamed(const QList<QAction*>& actions, const QString& word) {
  const auto at = std::find_if(actions.begin(), actions.end(), [&](const QAction* a) {
    return plainText(a->text().section('\t', 0, 0)) == word && a->isVisible();
  });
  return at == actions.end() ? nullptr : *at;
}

QAction* actionOf(const QWidget& window, const Control& control) {
  if (control.kind == ControlKind::Shortcut) {
    for (QAction* action : window.findChildren<QAction*>()) {
      for (const QKeySequence& keys : action->shortcuts()) {
        if (wordsOf(keys, action->text()) == control.words) return action;
      }
    }
    return nullptr;
  }
  const QWidget* owner = widgetOf(window, control.path);
  if (!owner) return nullptr;
  QList<QAction*> level = owner->actions();
  if (control.kind == ControlKind::Entry && menuOf(*owner)) level = menuOf(*owner)->actions();
  QAction* found = nullptr;
  for (const QString& word : control.words) {
    found = actionNamed(level, word);
    if (!found) return nullptr;
    if (!found->menu()) continue;
    Q_EMIT found->menu()->aboutToShow();
    level = found->menu()->actions();
  }
  return found;
}

QMenu* menuWith(const QWidget& window, const QAction& action) {
  QList<QMenu*> menus = window.findChildren<QMenu*>();
  for (QMenu* menu : menus) {
    if (menu->actions().contains(const_cast<QAction*>(&action))) return menu;
  }
  return nullptr;
}

// --- Standing ---

struct Ears : QObject {
  using QObject::receivers;  // protected in QObject; asking changes nothing
};
bool hears(const QObject& object, const char* signal) {
  int (QObject::*const count)(const char*) const = &Ears::receivers;
  return (object.*count)(signal) > 0;
}

// A check box or a list that only shows to itself what was chosen.
QString deafness(const QWidget& w) {
  if (const auto* button = qobject_cast<const QAbstractButton*>(&w)) {
    const bool heard = hears(w, SIGNAL(clicked(bool))) || hears(w, SIGNAL(toggled(bool))) ||
                       hears(w, SIGNAL(pressed())) || button->group();
    if (button->isCheckable() && !heard) return "is heard by nobody";
  }
  if (qobject_cast<const QComboBox*>(&w) && !hears(w, SIGNAL(activated(int))) &&
      !hears(w, SIGNAL(currentIndexChanged(int))) && !hears(w, SIGNAL(currentTextChanged(QString))) &&
      !hears(w, SIGNAL(textActivated(QString))))
    return "is heard by nobody";
  return {};
}

QPoint middleOf(const QWidget& w, const Control& control, const std::vector<Spot>& spots) {
  if (const auto* tabs = qobject_cast<const QTabBar*>(&w)) return tabs->tabRect(control.index).center();
  if (control.kind == ControlKind::Spot) return spots[static_cast<std::size_t>(control.index)].at;
  // The arrow that opens a menu is not the button.
  if (const auto* tool = qobject_cast<const QToolButton*>(&w);
      tool && tool->menu() && tool->popupMode() == QToolButton::MenuButtonPopup)
    return {w.width() / 4, w.height() / 2};
  // The words of a check box may end long before it does.
  if (control.kind == ControlKind::Button && w.inherits("QCheckBox")) return {8, w.height() / 2};
  return w.rect().center();
}

void bringIntoView(QWidget& w) {
  for (QWidget* up = w.parentWidget(); up; up = up->parentWidget()) {
    if (auto* area = qobject_cast<QScrollArea*>(up)) area->ensureWidgetVisible(&w);
  }
}

QString coverOf(const QWidget& window, const QWidget& w, QPoint at) {
  const QWidget* hit = window.childAt(w.mapTo(&window, at));
  if (hit == &w || (hit && w.isAncestorOf(hit))) return {};
  return hit ? "lies under " + pathOf(*hit) : QString("lies outside of the window");
}

void judgeAction(const QWidget& window, const QAction& action, const Control& control, Standing& s) {
  s.there = true;
  s.grey = !action.isEnabled();
  s.already = action.isChecked() && action.actionGroup() && action.actionGroup()->isExclusive();
  const QString tip = action.toolTip();
  s.reason = plainText(tip) == plainText(action.text().section('\t', 0, 0)) ? QString() : tip;
  const QMenu* menu = menuWith(window, action);
  if (control.kind != ControlKind::Shortcut && s.grey && menu && !menu->toolTipsVisible())
    s.hindrance = "is grey in a menu that shows no tooltips";
}

void judgeWidget(QWidget& window, QWidget& w, const Control& control, const std::vector<Spot>& spots,
                 Standing& s) {
  s.there = true;
  s.grey = !w.isEnabled();
  const QString tip = tipAt(w, middleOf(w, control, spots));
  s.reason = plainText(tip) == control.words.value(0) ? QString() : tip;
  if (const auto* tabs = qobject_cast<const QTabBar*>(&w)) {
    s.already = tabs->currentIndex() == control.index;
    s.grey = s.grey || !tabs->isTabEnabled(control.index);
    if (!tabs->tabToolTip(control.index).isEmpty()) s.reason = tabs->tabToolTip(control.index);
  } else if (const auto* button = qobject_cast<const QAbstractButton*>(&w)) {
    s.already =
        button->isChecked() && (button->autoExclusive() || (button->group() && button->group()->exclusive()));
  } else if (const auto* box = qobject_cast<const QComboBox*>(&w)) {
    if (!s.grey && box->count() < 2) s.hindrance = QString("offers %1 choices").arg(box->count());
  }
  if (s.hindrance.isEmpty() && !s.grey) s.hindrance = deafness(w);
  bringIntoView(w);
  if (s.hindrance.isEmpty() && control.kind != ControlKind::Row)
    s.hindrance = coverOf(window, w, middleOf(w, control, spots));
}

// --- Pressing ---

void pressRow(QAbstractItemView& view, int index) {
  const std::vector<QModelIndex> rows = rowsOf(view);
  if (index >= static_cast<int>(rows.size())) return;
  const QModelIndex row = rows[static_cast<std::size_t>(index)];
  view.scrollTo(row);
  QTest::mouseClick(view.viewport(), Qt::LeftButton, {}, view.visualRect(row).center());
}

void pressEntry(QWidget& window, const QAction& action, const QString& word, Opened& opened) {
  QMenu* menu = menuWith(window, action);
  if (!menu) return;
  opened.allow(menu);
  menu->popup(window.mapToGlobal(QPoint(60, 60)));
  // A menu that is filled as it opens has other actions now.
  if (QAction* now = actionNamed(menu->actions(), word))
    QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(now).center());
  if (menu->isVisible()) menu->close();
  opened.allow(nullptr);
}

void pressContextEntry(QWidget& w, QAction& action, Opened& opened) {
  QTimer::singleShot(0, &w, [&] {
    auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
    if (!menu) return;
    opened.allow(menu);
    QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(&action).center());
    opened.allow(nullptr);
  });
  QContextMenuEvent wanted(QContextMenuEvent::Mouse, w.rect().center(), w.mapToGlobal(w.rect().center()));
  QApplication::sendEvent(&w, &wanted);
}

void pressKeys(QWidget& window, const QString& keys) {
  const int code = QKeySequence(keys)[0];
  const auto modifiers = Qt::KeyboardModifiers(code & static_cast<int>(Qt::KeyboardModifierMask));
  QTest::keyClick(&window, static_cast<Qt::Key>(code & ~static_cast<int>(Qt::KeyboardModifierMask)),
                  modifiers);
}

}  // namespace

QString Control::title() const {
  static const char* const kKinds[] = {"button", "tab",           "row",      "choice", "slider",
                                       "entry",  "context entry", "shortcut", "spot"};
  QString place = path.section('/', -3);
  for (const auto& [tabs, i] : room)
    place += QString(" behind tab %1 of %2").arg(i + 1).arg(tabs.section('/', -2));
  const QString what = words.join(" > ").isEmpty() ? "of " + hint : words.join(" > ");
  return QString("%1 \"%2\" (%3)").arg(kKinds[static_cast<int>(kind)], what, place);
}

std::vector<Control> controlsIn(QWidget& window, const std::vector<Spot>& spots) {
  std::vector<Control> found;
  for (const auto& [path, w] : widgetsByPath(window)) {
    if (isToolkitPart(*w) || !canBeReached(*w)) continue;
    const std::size_t before = found.size();
    addControlsOf(path, *w, found);
    for (std::size_t i = before; i < found.size(); ++i) found[i].hint = hintOf(*w);
  }
  addShortcuts(window, found);
  for (std::size_t i = 0; i < spots.size(); ++i) {
    if (spots[i].widget->isVisible())
      found.push_back(
          {ControlKind::Spot, pathOf(*spots[i].widget), {spots[i].words}, static_cast<int>(i), {}, {}});
  }
  return found;
}

Opened::Opened(const QWidget& window) : window_(window) {
  timer_.setInterval(kLook_ms);
  connect(&timer_, &QTimer::timeout, this, &Opened::look);
  timer_.start();
}

void Opened::look() {
  for (QWidget* w : QApplication::topLevelWidgets()) {
    if (!w->isVisible() || w == &window_ || w == allowed_ || isTip(*w)) continue;
    seen_ << QString("%1 \"%2\"").arg(w->metaObject()->className(), w->windowTitle());
    if (auto* dialog = qobject_cast<QDialog*>(w)) {
      dialog->reject();
    } else {
      w->close();
    }
  }
}

QStringList Opened::take() {
  look();
  return std::exchange(seen_, {});
}

Standing standingOf(QWidget& window, const Control& control, const std::vector<Spot>& spots) {
  Standing s;
  if (control.kind == ControlKind::Entry || control.kind == ControlKind::ContextEntry ||
      control.kind == ControlKind::Shortcut) {
    if (const QAction* action = actionOf(window, control)) judgeAction(window, *action, control, s);
    if (control.kind == ControlKind::Shortcut) s.already = false;
  } else if (QWidget* w = widgetOf(window, control.path)) {
    judgeWidget(window, *w, control, spots, s);
  }
  return s;
}

bool press(QWidget& window, const Control& control, const std::vector<Spot>& spots, Opened& opened) {
  QWidget* w = widgetOf(window, control.path);
  if (!w) return false;
  QAction* action = nullptr;
  switch (control.kind) {
    case ControlKind::Entry:
    case ControlKind::ContextEntry:
      action = actionOf(window, control);
      if (!action) return false;
      if (control.kind == ControlKind::Entry) {
        pressEntry(window, *action, control.words.back(), opened);
      } else {
        pressContextEntry(*w, *action, opened);
      }
      return true;
    case ControlKind::Shortcut:
      pressKeys(window, control.words.front());
      return true;
    case ControlKind::Row:
      pressRow(*qobject_cast<QAbstractItemView*>(w), control.index);
      return true;
    case ControlKind::Choice: {
      const auto* box = qobject_cast<const QComboBox*>(w);
      QTest::keyClick(w, box->currentIndex() + 1 < box->count() ? Qt::Key_Down : Qt::Key_Up);
      return true;
    }
    case ControlKind::Slider: {
      const auto* slider = qobject_cast<const QSlider*>(w);
      const bool at_end = slider && slider->value() == slider->maximum();
      QTest::keyClick(w, at_end ? Qt::Key_Down : Qt::Key_Up);
      return true;
    }
    default:
      bringIntoView(*w);
      QTest::mouseClick(w, Qt::LeftButton, {}, middleOf(*w, control, spots));
      return true;
  }
}

QRect ownPlace(QWidget& window, const Control& control) {
  if (control.kind == ControlKind::Entry || control.kind == ControlKind::Shortcut) return {};
  const QWidget* w = widgetOf(window, control.path);
  if (!w) return {};
  return QRect(w->mapTo(&window, QPoint()), w->size()).adjusted(-2, -2, 2, 2);
}

bool isOwnValue(const Control& control, const QString& key) {
  const bool has_value = control.kind == ControlKind::Choice || control.kind == ControlKind::Slider ||
                         control.kind == ControlKind::Row || control.kind == ControlKind::Tab;
  return has_value && key.startsWith(control.path) && key.endsWith("|value");
}

}  // namespace beam::testing
