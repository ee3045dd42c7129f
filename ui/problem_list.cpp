// SPDX-License-Identifier: Apache-2.0
#include "ui/problem_list.h"

#include <QApplication>
#include <QClipboard>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

#include "ui/theme.h"
#include "ui/words.h"

namespace beam {
namespace {

constexpr int kMostProblems = 1000;

bool same(const Problem& a, const Problem& b) {
  return a.kind == b.kind && a.text == b.text && a.camera == b.camera && a.stage == b.stage &&
         a.frame == b.frame;
}

QString rowText(const Problem& problem) {
  QString text = QString("%1  %2").arg(problem.kind == Problem::Kind::Error ? "✕" : "▲",
                                       problem.last.toString("hh:mm:ss"));
  if (problem.count > 1) text += QString("  ×%1").arg(problem.count);
  const QString place = placeOf(problem);
  return text + "  " + (place.isEmpty() ? QString() : place + ": ") + problem.text;
}

}  // namespace

QString placeOf(const Problem& problem) {
  QStringList parts;
  if (!problem.camera.empty()) parts << "camera " + QString::fromStdString(problem.camera);
  if (!problem.frame.isEmpty()) parts << "frame " + problem.frame;
  return parts.join(", ");
}

ProblemList::ProblemList(QObject* parent) : QObject(parent) {}

void ProblemList::add(Problem problem) {
  problem.count = 1;
  problem.last = QDateTime::currentDateTime();
  const auto known = std::find_if(problems_.begin(), problems_.end(),
                                  [&](const Problem& other) { return same(other, problem); });
  if (known != problems_.end()) {
    problem.count += known->count;
    problems_.erase(known);
  }
  problems_.insert(problems_.begin(), std::move(problem));
  if (count() > kMostProblems) problems_.pop_back();
  Q_EMIT changed();
}

void ProblemList::clear() {
  if (problems_.empty()) return;
  problems_.clear();
  Q_EMIT changed();
}

int ProblemList::count(Problem::Kind kind) const {
  return static_cast<int>(std::count_if(problems_.begin(), problems_.end(),
                                        [&](const Problem& problem) { return problem.kind == kind; }));
}

std::map<std::string, int> ProblemList::countsByStage() const {
  std::map<std::string, int> counts;
  for (const Problem& problem : problems_) {
    if (!problem.stage.empty()) ++counts[problem.stage];
  }
  return counts;
}

std::map<std::string, int> ProblemList::countsByCamera() const {
  std::map<std::string, int> counts;
  for (const Problem& problem : problems_) {
    if (!problem.camera.empty()) ++counts[problem.camera];
  }
  return counts;
}

std::map<std::string, QStringList> ProblemList::textsByCamera() const {
  std::map<std::string, QStringList> texts;
  for (const Problem& problem : problems_) {
    if (problem.camera.empty()) continue;
    texts[problem.camera] << (problem.frame.isEmpty() ? QString() : "frame " + problem.frame + ": ") +
                                 problem.text;
  }
  return texts;
}

ProblemsPanel::ProblemsPanel(ProblemList& problems, QWidget* parent)
    : QWidget(parent),
      problems_(problems),
      rows_(new QListWidget),
      empty_(new QLabel("No problems. Warnings and errors of the capture and of runs are listed here.")),
      copy_all_(new QToolButton),
      clear_(new QToolButton) {
  rows_->setWordWrap(true);
  rows_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  rows_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  rows_->setResizeMode(QListView::Adjust);
  rows_->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  rows_->setAccessibleName("Problems, newest first");
  rows_->installEventFilter(this);
  empty_->setObjectName("quiet");
  empty_->setWordWrap(true);
  empty_->setAlignment(Qt::AlignCenter);
  empty_->setMargin(8);
  copy_all_->setText("Copy all");
  clear_->setText("Clear");
  auto* row = new QHBoxLayout;
  row->setContentsMargins(8, 4, 8, 4);
  row->addWidget(copy_all_);
  row->addWidget(clear_);
  row->addStretch();
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addLayout(row);
  column->addWidget(rows_, 1);
  column->addWidget(empty_, 1);
  connect(copy_all_, &QToolButton::clicked, this, [this] { copy(true); });
  connect(rows_, &QListWidget::itemClicked, this,
          [this](const QListWidgetItem* pressed) { Q_EMIT told(pressed->toolTip()); });
  connect(clear_, &QToolButton::clicked, &problems_, &ProblemList::clear);
  connect(&problems_, &ProblemList::changed, this, &ProblemsPanel::refresh);
  refresh();
}

// The keys of copying are the list's, not the window's.
bool ProblemsPanel::eventFilter(QObject* watched, QEvent* event) {
  if (watched == rows_ && event->type() == QEvent::KeyPress &&
      static_cast<QKeyEvent*>(event)->matches(QKeySequence::Copy)) {
    copy(false);
    return true;
  }
  return QWidget::eventFilter(watched, event);
}

QString ProblemsPanel::title() const {
  return problems_.count() == 0 ? QString("Problems") : QString("Problems (%1)").arg(problems_.count());
}

void ProblemsPanel::refresh() {
  rows_->clear();
  for (const Problem& problem : problems_.all()) {
    auto* row = new QListWidgetItem(rowText(problem), rows_);
    row->setToolTip(rowText(problem));
    row->setForeground(problem.kind == Problem::Kind::Error ? colors().failed : colors().warning);
  }
  rows_->scrollToTop();
  const bool any = problems_.count() > 0;
  rows_->setVisible(any);
  empty_->setVisible(!any);
  for (QToolButton* button : {copy_all_, clear_}) button->setEnabled(any);
  copy_all_->setToolTip(any ? "Copy every problem as text" : "There are no problems to copy");
  clear_->setToolTip(any ? "Empty the list; what is still wrong is told again" : "There are no problems");
  if (title() == told_) return;
  told_ = title();
  Q_EMIT titleChanged(told_);
}

void ProblemsPanel::copy(bool all) {
  QStringList lines;
  for (int i = 0; i < rows_->count(); ++i) {
    if (all || rows_->item(i)->isSelected()) lines << rows_->item(i)->text();
  }
  if (lines.isEmpty()) {
    Q_EMIT told("No problem is chosen; nothing was copied");
    return;
  }
  QApplication::clipboard()->setText(lines.join("\n"));
  Q_EMIT told(all ? "All copied: " + countText(lines.size(), "problem")
                  : "Copied: " + lines.join(" · ").simplified());
}

}  // namespace beam
