// SPDX-License-Identifier: Apache-2.0
// Finds what can be pressed in a window and presses it with a mouse and a keyboard, as a person does.
#pragma once

#include <QAction>
#include <QImage>
#include <QPointer>
#include <QTimer>

#include <functional>
#include <optional>
#include <vector>

#include "tests/support/window_look.h"

namespace beam::testing {

enum class ControlKind { Button, Tab, Row, Choice, Slider, Entry, ContextEntry, Shortcut, Spot };

// Something to press. It is named, not pointed at: after a press the window may be made anew.
struct Control {
  ControlKind kind = ControlKind::Button;
  QString path;       // of the widget; of an entry, of the widget that its menu hangs on
  QStringList words;  // what stands on it; of an entry, the way through the menus; of a shortcut, its keys
  int index = 0;      // of a tab, a row, a spot
  std::vector<std::pair<QString, int>> room;  // tabs to press before it can be seen
  QString hint;                               // for a person: what a control without words tells

  QString title() const;
  QString id() const { return QString("%1 %2 %3").arg(static_cast<int>(kind)).arg(words.join(" > "), path); }
  bool operator<(const Control& o) const {
    return std::tie(kind, path, words, index) < std::tie(o.kind, o.path, o.words, o.index);
  }
};

// A place in a widget that draws its own controls.
struct Spot {
  QWidget* widget = nullptr;
  QPoint at;
  QString words;
};

// All that can be pressed now, grey or not.
std::vector<Control> controlsIn(QWidget& window, const std::vector<Spot>& spots);

// Closes what opens over the window, and counts it as seen.
class Opened final : public QObject {
 public:
  explicit Opened(const QWidget& window);
  // What opened since the last call.
  QStringList take();
  void allow(QWidget* popup) { allowed_ = popup; }  // one that the test opened itself

 private:
  void look();
  const QWidget& window_;
  QPointer<QWidget> allowed_;
  QStringList seen_;
  QTimer timer_;
};

// How a control stands before it is pressed.
struct Standing {
  bool there = false, grey = false;
  bool already = false;  // chosen already: pressing it says so by doing nothing
  QString reason;        // why it is grey, as a person can read it
  QString hindrance;     // something that lies over it, or a menu that shows no reasons
};
Standing standingOf(QWidget& window, const Control& control, const std::vector<Spot>& spots);

// With real events; false when it was not there any more.
bool press(QWidget& window, const Control& control, const std::vector<Spot>& spots, Opened& opened);
// Where in the window its own answer to the mouse is painted.
QRect ownPlace(QWidget& window, const Control& control);
// The state of the control itself: what a dead one changes, too.
bool isOwnValue(const Control& control, const QString& key);

}  // namespace beam::testing
