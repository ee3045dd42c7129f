// SPDX-License-Identifier: Apache-2.0
#include "tests/support/window_fit.h"

#include <QAbstractScrollArea>
#include <QDockWidget>
#include <QLayout>
#include <QMainWindow>
#include <QScrollArea>
#include <QSplitter>
#include <QStackedWidget>
#include <QTabBar>
#include <QVariant>

#include "tests/support/painted_text.h"
#include "tests/support/window_look.h"

namespace beam::testing {
namespace {

// Rounding of widths of words to whole pixels.
constexpr double kSlack_px = 1.5;
// Of a line: letters reach neither its top nor its bottom.
constexpr double kSlackHigh = 0.25;

bool manages(const QLayout& layout, const QWidget& child) {
  if (layout.indexOf(const_cast<QWidget*>(&child)) >= 0) return true;
  for (int i = 0; i < layout.count(); ++i) {
    const QLayout* inner = layout.itemAt(i)->layout();
    if (inner && manages(*inner, child)) return true;
  }
  return false;
}

// Docks behind a tab and tabs of hidden docks are kept far away.
bool isPutAway(const QWidget& w) {
  return qobject_cast<const QMainWindow*>(w.parentWidget()) &&
         !w.geometry().intersects(w.parentWidget()->rect());
}

std::vector<QWidget*> childrenOf(const QWidget& parent) {
  std::vector<QWidget*> found;
  for (QObject* child : parent.children()) {
    auto* w = qobject_cast<QWidget*>(child);
    if (!w || w->isWindow() || !w->isVisible() || w->size().isEmpty() || isToolkitPart(*w) || isPutAway(*w))
      continue;
    const bool over =
        parent.layout() && !qobject_cast<const QMainWindow*>(&parent) && !manages(*parent.layout(), *w);
    if (!over) found.push_back(w);
  }
  return found;
}

// The toolkit lays out what is in these.
bool hasOwnLaw(const QWidget& parent) {
  return qobject_cast<const QSplitter*>(&parent) || qobject_cast<const QStackedWidget*>(&parent) ||
         qobject_cast<const QTabBar*>(&parent) || qobject_cast<const QAbstractScrollArea*>(&parent) ||
         parent.inherits("QComboBox") || parent.inherits("QLineEdit");
}

bool isViewport(const QWidget& w) {
  const auto* area = qobject_cast<const QAbstractScrollArea*>(w.parentWidget());
  return area && area->viewport() == &w;
}

QString inWords(const QRect& r) {
  return QString("%1x%2 at %3,%4").arg(r.width()).arg(r.height()).arg(r.x()).arg(r.y());
}

void addOverlaps(const QWidget& parent, QStringList& faults) {
  const std::vector<QWidget*> children = childrenOf(parent);
  for (std::size_t a = 0; a < children.size(); ++a) {
    for (std::size_t b = a + 1; b < children.size(); ++b) {
      const QRect common = children[a]->geometry() & children[b]->geometry();
      if (common.isEmpty()) continue;
      faults << pathOf(*children[a]) + " lies over " + pathOf(*children[b]).section('/', -1) + "\t" +
                    inWords(common);
    }
  }
}

void addOutsiders(const QWidget& parent, QStringList& faults) {
  const auto* area = qobject_cast<const QScrollArea*>(parent.parentWidget());
  for (const QWidget* w : childrenOf(parent)) {
    if (isViewport(parent)) {
      const bool cut =
          area && area->horizontalScrollBarPolicy() == Qt::ScrollBarAlwaysOff && w->width() > parent.width();
      if (cut)
        faults << pathOf(*w) + " is wider than what scrolls it, which scrolls up and down alone\t" +
                      inWords(w->geometry());
    } else if (!parent.rect().contains(w->geometry())) {
      faults << pathOf(*w) + " lies outside of " + (parent.isWindow() ? "the window" : "what it is in") +
                    "\t" + inWords(w->geometry()) + " in " + inWords(parent.rect());
    }
  }
}

void addCutWords(const QString& path, QWidget& w, QStringList& faults) {
  for (const PaintedText& t : paintedTexts(w)) {
    const QString words = "\"" + t.text + "\" of " + path;
    if (t.cutWide() > kSlack_px) {
      faults << words + QString(" is cut\tby %1 of %2 pixels").arg(t.cutWide()).arg(t.place.width());
    } else if (t.cutHigh() > kSlackHigh * t.place.height()) {
      faults << words +
                    QString(" is cut at top or bottom\tby %1 of %2").arg(t.cutHigh()).arg(t.place.height());
    } else if (t.text.endsWith("…")) {
      const QString start = t.text.chopped(1).trimmed();
      // Some words end in an ellipsis by themselves: "Open capture…".
      if (!w.property("text").toString().contains(t.text) &&
          !tipAt(w, t.place.center().toPoint()).contains(start))
        faults << words + " is shortened and stands whole in no tooltip\t";
    }
  }
}

}  // namespace

QStringList faultsOfFit(QWidget& window) {
  QStringList faults;
  auto all = widgetsByPath(window);
  all[""] = &window;
  for (const auto& [path, w] : all) {
    if (isToolkitPart(*w)) {
      if (w->objectName() == "qt_toolbar_ext_button") faults << path + " hides what has no room\t";
      continue;
    }
    if (hasOwnLaw(*w)) {
      if (!qobject_cast<const QAbstractScrollArea*>(w)) addCutWords(path, *w, faults);
      continue;
    }
    addOverlaps(*w, faults);
    addOutsiders(*w, faults);
    addCutWords(path, *w, faults);
  }
  return faults;
}

}  // namespace beam::testing
