// SPDX-License-Identifier: Apache-2.0
// What a person can see of a window, as text: what is shown where, what it says, what is chosen and what is
// grey.
#pragma once

#include <QString>
#include <QWidget>

#include <map>
#include <set>

namespace beam::testing {

// Names a widget by its way down from the window; the same in another window that was made alike.
QString pathOf(const QWidget& widget);
// Those that are visible below the window.
std::map<QString, QWidget*> widgetsByPath(const QWidget& window);

// "path|property" to value.
using WindowLook = std::map<QString, QString>;
WindowLook lookAt(const QWidget& window);
// Keys that are in one alone or tell different things.
std::set<QString> differences(const WindowLook& a, const WindowLook& b);

// The words that a person reads who rests the mouse there: the widget's own, else those of what it lies in.
QString tipOf(const QWidget& widget);
// The same at a place: what a widget shows that answers for its parts itself.
QString tipAt(QWidget& widget, QPoint at);
// Without the ampersand of its key, the dots of its dialog, and around it.
QString plainText(QString text);
// Parts that the toolkit puts into its own widgets: arrows of tab bars, extension buttons, views of popups.
bool isToolkitPart(const QWidget& widget);

}  // namespace beam::testing
