// SPDX-License-Identifier: Apache-2.0
#include "ui/start_page.h"

#include <QFileInfo>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>

#include "ui/command_table.h"
#include "ui/session_memory.h"

namespace beam {
namespace {

constexpr int kCardWidth = 620;

QLabel* words(const QString& text, const char* role) {
  auto* label = new QLabel(text);
  label->setObjectName(role);
  label->setWordWrap(true);
  return label;
}

}  // namespace

StartPage::StartPage(const QString& machine, QWidget* parent) : QWidget(parent) {
  auto* card = new QFrame;
  card->setObjectName("card");
  card->setMaximumWidth(kCardWidth);
  auto* column = new QVBoxLayout(card);
  column->setContentsMargins(32, 28, 32, 28);
  column->setSpacing(10);
  column->addWidget(words("BEAM Studio", "title"));
  column->addWidget(
      words("Photographs of a person, taken from all sides in a lit dome, become Gaussians that can be "
            "lit anew.",
            "quiet"));
  column->addSpacing(12);
  column->addWidget(words("Drop a capture folder or a project here, or open one", "heading"));
  buttons_ = new QHBoxLayout;
  column->addLayout(buttons_);
  column->addSpacing(14);
  recent_ = new QVBoxLayout;
  recent_->setSpacing(4);
  column->addLayout(recent_);
  column->addSpacing(8);
  column->addWidget(words("This machine", "heading"));
  column->addWidget(words(machine, "quiet"));
  auto* inside = new QWidget;
  auto* middle = new QGridLayout(inside);
  middle->setColumnStretch(0, 1);
  middle->setColumnStretch(1, 4);
  middle->setColumnStretch(2, 1);
  middle->setRowStretch(0, 1);
  middle->setRowStretch(2, 1);
  middle->addWidget(card, 1, 1);
  auto* scroll = new QScrollArea;
  scroll->setWidgetResizable(true);
  scroll->setWidget(inside);
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(scroll);
}

void StartPage::bind(CommandTable& commands) {
  const auto button = [&](const QString& text, const char* command, bool primary) {
    auto* b = new QPushButton(text);
    if (primary) b->setObjectName("primary");
    bindButton(b, commands.action(command));
    buttons_->addWidget(b);
  };
  button("Open capture…", "open_capture", true);
  button("Open project…", "open_project", false);
  button("Open sample", "open_sample", false);
  buttons_->addStretch();
}

void StartPage::setRefusal(const QString& why) {
  if (why == refusal_) return;
  refusal_ = why;
  setRecent(folders_);
}

void StartPage::setRecent(const QStringList& folders) {
  folders_ = folders;
  while (QLayoutItem* item = recent_->takeAt(0)) {
    // A click on one of them may be what brought us here.
    if (item->widget()) {
      item->widget()->hide();
      item->widget()->deleteLater();
    }
    delete item;
  }
  recent_->addWidget(words("Recent", "heading"));
  if (folders.isEmpty()) recent_->addWidget(words("Nothing yet.", "quiet"));
  for (const QString& folder : folders) recent_->addWidget(recentButton(folder));
}

QPushButton* StartPage::recentButton(const QString& folder) {
  auto* link = new QPushButton;
  link->setFlat(true);
  link->setObjectName("recent");
  const QString text = QFileInfo(folder).fileName() + "    " + folder;
  link->setText(link->fontMetrics().elidedText(text, Qt::ElideMiddle, kCardWidth - 110));
  const QString why = refusalToReopen(folder, refusal_);
  link->setEnabled(why.isEmpty());
  link->setToolTip(why.isEmpty() ? folder : why);
  connect(link, &QPushButton::clicked, this, [this, folder] { Q_EMIT recentChosen(folder); });
  return link;
}

}  // namespace beam
