// SPDX-License-Identifier: Apache-2.0
// Every command of the window once: its words, its keys, what it does and why it cannot be done now. Menus,
// buttons and shortcuts all show the same action, so that nothing can be pressed that does nothing.
#pragma once

#include <QAction>
#include <QKeySequence>
#include <QObject>
#include <QString>

#include <functional>
#include <map>

class QAbstractButton;
class QActionGroup;

namespace beam {

struct Command {
  QString text;  // as menus show it
  QString tip;   // one sentence: what it does
  QKeySequence keys = {};
  std::function<void()> act;
  // Why not now, a whole sentence; empty: it can be done. None: always.
  std::function<QString()> refusal = {};
  // Of one of several, of which one is always the chosen: the name they share, and whether it is this one.
  QString group = {};
  std::function<bool()> chosen = {};
};

class CommandTable final : public QObject {
  Q_OBJECT

 public:
  explicit CommandTable(QObject* parent = nullptr);

  // `id` is the action's object name; once each. Nothing is asked before the first refresh().
  QAction* add(const QString& id, Command command);
  QAction* action(const QString& id) const { return entries_.at(id).action; }
  // Asks every command whether it can be done: after anything that the answers depend on has changed.
  void refresh();
  // More to know before it is pressed, in the tooltip: what it would take. Empty: nothing.
  void setNote(const QString& id, const QString& note);
  // The reason why the command cannot be done now; empty: it can.
  QString refusalOf(const QString& id) const;

 private:
  struct Entry {
    Command command;
    QAction* action = nullptr;
    QString note;
  };
  void refresh(const Entry& entry);

  std::map<QString, Entry> entries_;
  std::map<QString, QActionGroup*> groups_;
};

// The button does what the action does: the same click, enabled state and tooltip. It keeps its own words.
void bindButton(QAbstractButton* button, QAction* action);

}  // namespace beam
