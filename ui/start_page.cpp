// SPDX-License-Identifier: Apache-2.0
#include "ui/start_page.h"

#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

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

StartPage::StartPage(bool has_sample, const QString& machine, QWidget* parent) : QWidget(parent) {
  auto* card = new QFrame;
  card->setObjectName("card");
  card->setFixedWidth(kCardWidth);
  auto* column = new QVBoxLayout(card);
  column->setContentsMargins(32, 28, 32, 28);
  column->setSpacing(10);
  column->addWidget(words("BEAM Studio", "title"));
  column->addWidget(words("Photographs of a person in a dome in, relightable Gaussians out.", "quiet"));
  column->addSpacing(12);
  column->addWidget(words(has_sample ? "Drop a capture folder here, or open the sample"
                                     : "Drop a capture folder or a project here",
                          "heading"));
  auto* row = new QHBoxLayout;
  const auto button = [&](const QString& text, auto signal, bool primary) {
    auto* b = new QPushButton(text);
    if (primary) b->setObjectName("primary");
    b->setMinimumHeight(32);
    connect(b, &QPushButton::clicked, this, signal);
    row->addWidget(b);
  };
  button("Open capture…", &StartPage::openCaptureWanted, true);
  button("Open project…", &StartPage::openProjectWanted, false);
  if (has_sample) button("Open sample", &StartPage::sampleWanted, false);
  row->addStretch();
  column->addLayout(row);
  column->addSpacing(14);
  recent_ = new QVBoxLayout;
  recent_->setSpacing(4);
  column->addLayout(recent_);
  column->addSpacing(8);
  column->addWidget(words("This machine", "heading"));
  column->addWidget(words(machine, "quiet"));
  auto* middle = new QHBoxLayout;
  middle->addStretch();
  middle->addWidget(card);
  middle->addStretch();
  auto* all = new QVBoxLayout(this);
  all->addStretch();
  all->addLayout(middle);
  all->addStretch();
}

void StartPage::setRecent(const QStringList& folders) {
  while (QLayoutItem* item = recent_->takeAt(0)) {
    delete item->widget();
    delete item;
  }
  recent_->addWidget(words("Recent", "heading"));
  if (folders.isEmpty()) recent_->addWidget(words("Nothing yet.", "quiet"));
  for (const QString& folder : folders) {
    auto* link = new QPushButton(QFileInfo(folder).fileName() + "    " + folder);
    link->setFlat(true);
    link->setStyleSheet("text-align: left");
    link->setEnabled(QFileInfo::exists(folder));
    link->setToolTip(link->isEnabled() ? folder : folder + " is not there any more");
    connect(link, &QPushButton::clicked, this, [this, folder] { Q_EMIT recentChosen(folder); });
    recent_->addWidget(link);
  }
}

}  // namespace beam
