// SPDX-License-Identifier: Apache-2.0
#include "ui/run_bar.h"

#include <QAction>
#include <QHBoxLayout>
#include <QMenu>
#include <QProgressBar>
#include <QToolButton>
#include <QVBoxLayout>

#include <cmath>

#include "ui/elided_label.h"

namespace beam {
namespace {

constexpr int kLeastLetters = 18, kWishedLetters = 44;  // of the words
constexpr double kLeastShare = 0.02, kLeast_s = 2;      // before that a share says nothing of the whole

QString percent(double fraction) {
  return QString("%1 %").arg(static_cast<int>(std::floor(100 * std::min(fraction, 1.0))));
}

QAction* entry(QMenu* menu, const QString& text, const QString& tip) {
  QAction* action = menu->addAction(text);
  action->setToolTip(tip);
  return action;
}

}  // namespace

RunBar::RunBar(QWidget* parent)
    : QWidget(parent),
      run_(new QToolButton),
      stop_(new QToolButton),
      bar_(new QProgressBar),
      plan_(new ElidedLabel),
      words_(new ElidedLabel),
      refusal_("Open a capture or a project first") {
  run_->setObjectName("primary");
  run_->setText("Run");
  run_->setPopupMode(QToolButton::MenuButtonPopup);
  run_->setMenu(new QMenu(run_));
  run_->menu()->setToolTipsVisible(true);
  run_->setFocusPolicy(Qt::StrongFocus);
  makeStop();
  bar_->setRange(0, 1000);
  bar_->setTextVisible(true);
  bar_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  for (ElidedLabel* label : {plan_, words_}) {
    label->setObjectName("quiet");
    label->setLeastLetters(kLeastLetters);
    label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  }
  auto* column = new QVBoxLayout;
  column->setSpacing(2);
  column->addStretch();
  column->addWidget(bar_);
  column->addWidget(plan_);
  column->addWidget(words_);
  column->addStretch();
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(8);
  row->addWidget(run_);
  row->addWidget(stop_);
  row->addLayout(column, 1);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  // What is Ignored asks for no room of its own.
  column->addSpacerItem(new QSpacerItem(kWishedLetters * fontMetrics().averageCharWidth(), 0,
                                        QSizePolicy::Preferred, QSizePolicy::Fixed));
  connect(run_, &QToolButton::clicked, this, [this] { Q_EMIT runWanted({}); });
  setRunning(false);
}

void RunBar::makeStop() {
  stop_->setText("Cancel");
  stop_->setPopupMode(QToolButton::MenuButtonPopup);
  stop_->setFocusPolicy(Qt::StrongFocus);
  auto* menu = new QMenu(stop_);
  menu->setToolTipsVisible(true);
  after_step_ = entry(menu, "Stop after this step", "The step at work ends and its result is kept");
  after_frame_ = entry(menu, "Stop after this frame", "All steps of the frame at work end and are kept");
  stop_->setMenu(menu);
  connect(stop_, &QToolButton::clicked, this, &RunBar::stopWanted);
  connect(after_step_, &QAction::triggered, this, &RunBar::stopAfterStepWanted);
  connect(after_frame_, &QAction::triggered, this, &RunBar::stopAfterFrameWanted);
}

QSize RunBar::minimumSizeHint() const {
  const int words = kLeastLetters * fontMetrics().averageCharWidth();
  return {run_->sizeHint().width() + stop_->sizeHint().width() + 2 * layout()->spacing() + words,
          QWidget::minimumSizeHint().height()};
}

void RunBar::setStages(const std::vector<StageInfo>& stages) {
  stages_ = stages;
  QMenu* menu = run_->menu();
  menu->clear();
  connect(entry(menu, "This frame", "Compute what is missing of the frame in view"), &QAction::triggered,
          this, [this] { Q_EMIT runWanted({}); });
  connect(entry(menu, "In–out range", "Every frame from the in point to the out point of the timeline"),
          &QAction::triggered, this, &RunBar::rangeWanted);
  connect(entry(menu, "Scout the in–out range…",
                "A quick look at the motion: solve every so manieth frame and interpolate between them"),
          &QAction::triggered, this, &RunBar::scoutWanted);
  connect(entry(menu, "Whole take", "Every frame of the capture"), &QAction::triggered, this,
          &RunBar::takeWanted);
  menu->addSeparator();
  for (const StageInfo& stage : stages) {
    const QString title = QString::fromStdString(stage.title);
    connect(entry(menu, "This frame until " + title, "Stop when " + title + " is done"), &QAction::triggered,
            this, [this, id = stage.id] { Q_EMIT runWanted(QString::fromStdString(id)); });
  }
}

void RunBar::setRefusal(const QString& why) {
  refusal_ = why;
  showButtons();
}

void RunBar::setPlan(const QString& plan) {
  plan_->setText(plan);
  showButtons();
}

void RunBar::setRunning(bool running) {
  running_ = running;
  can_stop_ = running;
  stopping_.clear();
  if (running) {
    remaining_.start();
    clock_.start();
  }
  showButtons();
}

void RunBar::showButtons() {
  run_->setEnabled(refusal_.isEmpty() && !running_);
  QString tip =
      "Compute what is missing of this frame (Ctrl+Enter); the arrow chooses frames or the last stage";
  if (!plan_->text().isEmpty()) tip += "\n" + plan_->text();
  run_->setToolTip(running_ ? QString("A run is going on") : refusal_.isEmpty() ? tip : refusal_);
  stop_->setEnabled(can_stop_);
  stop_->setToolTip(can_stop_  ? "Stop now (Ctrl+.); finished steps are kept. The arrow: stop a little later"
                    : running_ ? "The run is stopping"
                               : "Nothing is running");
  bar_->setVisible(running_);
  plan_->setVisible(!running_ && !plan_->text().isEmpty());
  words_->setVisible(running_ || !words_->text().isEmpty() || plan_->text().isEmpty());
}

void RunBar::say(const QString& words) {
  words_->setText(stopping_.isEmpty() ? words : stopping_ + (words.isEmpty() ? "" : " · " + words));
}

void RunBar::showStarted(const QString& what) {
  setRunning(true);
  bar_->setValue(0);
  bar_->setFormat(percent(0));
  for (QAction* action : {after_step_, after_frame_}) action->setEnabled(true);
  say(what);
}

void RunBar::showProgress(const StepProgress& p) {
  bar_->setValue(static_cast<int>(1000 * p.job_fraction));
  bar_->setFormat(percent(p.job_fraction));
  remaining_.feed(p.seconds_elapsed, p.seconds_left, p.job_fraction);
  QString what = stepTitle(stages_, p.ref.step);
  if (!p.ref.frame_name.empty()) what += ", frame " + QString::fromStdString(p.ref.frame_name);
  if (p.ref.lead) what += " (again, for the frames after it to build on)";
  // The time first: it is what is left in a narrow window.
  QStringList parts{remaining_.text(), what};
  if (!p.report.label.empty() && p.report.label != p.ref.step)
    parts << QString::fromStdString(p.report.label);
  if (p.report.total > 0) parts << numberText(p.report.done) + " of " + numberText(p.report.total);
  if (p.rate > 0) parts << QString("%1 a second").arg(p.rate, 0, 'f', p.rate < 10 ? 1 : 0);
  say(parts.join(" · "));
}

void RunBar::showReport(const ProgressReport& report) {
  bar_->setValue(static_cast<int>(1000 * report.fraction));
  bar_->setFormat(percent(report.fraction));
  for (QAction* action : {after_step_, after_frame_}) action->setEnabled(false);
  const double elapsed_s = 1e-3 * static_cast<double>(clock_.elapsed());
  const bool says = report.fraction > kLeastShare && elapsed_s > kLeast_s;
  remaining_.feed(elapsed_s, says ? elapsed_s * (1 - report.fraction) / report.fraction : -1,
                  report.fraction);
  QStringList parts;
  if (remaining_.known()) parts << remaining_.text();
  if (!report.label.empty()) parts << QString::fromStdString(report.label);
  say(parts.join(" · "));
}

void RunBar::showWaiting(const QString& text) {
  bar_->setFormat("waiting");
  say(text);
}

void RunBar::showStopping(const QString& how) {
  if (!running_) return;
  can_stop_ = !how.isEmpty();
  stopping_ = how.isEmpty() ? QString("Stopping") : "Stopping " + how;
  for (QAction* action : {after_step_, after_frame_}) action->setEnabled(can_stop_);
  say({});
  showButtons();
}

void RunBar::showFinished(const QString& outcome) {
  stopping_.clear();
  say(outcome);
  setRunning(false);
}

QString RunBar::text() const {
  return running_ || !words_->text().isEmpty() ? words_->text() : plan_->text();
}

}  // namespace beam
