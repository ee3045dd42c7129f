// SPDX-License-Identifier: Apache-2.0
#include "ui/command_table.h"

#include <QAbstractButton>
#include <QActionGroup>

namespace beam {
namespace {

QString tipOf(const Command& command, const QString& note, const QString& refusal) {
  QString tip = command.tip;
  if (!command.keys.isEmpty()) tip += " (" + command.keys.toString(QKeySequence::NativeText) + ")";
  if (refusal.isEmpty()) return note.isEmpty() ? tip : tip + "\n" + note;
  return tip + "\n" + refusal;
}

}  // namespace

CommandTable::CommandTable(QObject* parent) : QObject(parent) {}

QAction* CommandTable::add(const QString& id, Command command) {
  auto* action = new QAction(command.text, this);
  action->setObjectName(id);
  action->setShortcut(command.keys);
  if (command.chosen) {
    QActionGroup*& group = groups_[command.group];
    if (!group) group = new QActionGroup(this);
    action->setCheckable(true);
    group->addAction(action);
  }
  connect(action, &QAction::triggered, this, [this, act = command.act] {
    act();
    refresh();
  });
  entries_.insert_or_assign(id, Entry{std::move(command), action, {}});
  return action;
}

void CommandTable::refresh(const Entry& entry) {
  const QString refusal = entry.command.refusal ? entry.command.refusal() : QString();
  entry.action->setEnabled(refusal.isEmpty());
  if (entry.command.chosen) entry.action->setChecked(entry.command.chosen());
  entry.action->setToolTip(tipOf(entry.command, entry.note, refusal));
}

void CommandTable::refresh() {
  for (const auto& [id, entry] : entries_) refresh(entry);
}

void CommandTable::setNote(const QString& id, const QString& note) {
  Entry& entry = entries_.at(id);
  if (entry.note == note) return;
  entry.note = note;
  refresh(entry);
}

QString CommandTable::refusalOf(const QString& id) const {
  const Command& command = entries_.at(id).command;
  return command.refusal ? command.refusal() : QString();
}

void bindButton(QAbstractButton* button, QAction* action) {
  const auto mirror = [button, action] {
    button->setEnabled(action->isEnabled());
    button->setToolTip(action->toolTip());
  };
  QObject::connect(button, &QAbstractButton::clicked, action, &QAction::trigger);
  QObject::connect(action, &QAction::changed, button, mirror);
  mirror();
}

}  // namespace beam
