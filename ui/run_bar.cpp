// SPDX-License-Identifier: Apache-2.0
#include "ui/run_bar.h"

#include <QAction>
#include <QHBoxLayout>
#include <QMenu>
#include <QProgressBar>
#include <QToolButton>
#include <QVBoxLayout>

#include <cmath>

#include "ui/command_table.h"
#include "ui/elided_label.h"

namespace beam {
namespace {

constexpr int kLeastLetters = 18, kWishedLetters = 44;  // of the words
constexpr double kLeastShare = 0.02, kLeast_s = 2;      // before that a share says nothing of the whole

QString percent(double fraction) {
  return QString("%1 %").arg(static_cast<int>(std::floor(100 * std::min(fraction, 1.0))));
}

QToolButton* splitButton(const QString& words) {
  auto* button = new QToolButton;
  button->setText(words);
  button->setPopupMode(QToolButton::MenuButtonPopup);
  button->setMenu(new QMenu(button));
  button->menu()->setToolTipsVisible(true);
  button->setFocusPolicy(Qt::StrongFocus);
  button->setEnabled(false);
  return button;
}

// "5.5 iterations a second", "12/s".
QString rateText(double rate, const std::string& unit) {
  const QString number = QString::number(rate, 'f', rate < 1 ? 2 : rate < 10 ? 1 : 0);
  return unit.empty() ? number + "/s" : number + ' ' + QString::fromStdString(unit) + " a second";
}

}  // namespace

RunBar::RunBar(QWidget* parent)
    : QWidget(parent),
      run_(splitButton("Run")),
      stop_(splitButton("Cancel")),
      bar_(new QProgressBar),
      plan_(new ElidedLabel),
      words_(new ElidedLabel) {
  run_->setObjectName("primary");
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
  setRunning(false);
}

void RunBar::bind(const std::vector<QAction*>& runs, const std::vector<QAction*>& until, QAction* stop,
                  const std::vector<QAction*>& later) {
  bindButton(run_, runs.front());
  for (QAction* action : runs) run_->menu()->addAction(action);
  run_->menu()->addSeparator();
  for (QAction* action : until) run_->menu()->addAction(action);
  bindButton(stop_, stop);
  for (QAction* action : later) stop_->menu()->addAction(action);
}

int RunBar::widthFor(int letters) const {
  return run_->sizeHint().width() + stop_->sizeHint().width() + 2 * layout()->spacing() +
         letters * fontMetrics().averageCharWidth();
}

// The words are Ignored: they ask for no room of their own.
QSize RunBar::sizeHint() const { return {widthFor(kWishedLetters), QWidget::sizeHint().height()}; }

QSize RunBar::minimumSizeHint() const {
  return {widthFor(kLeastLetters), QWidget::minimumSizeHint().height()};
}

void RunBar::setStages(const std::vector<StageInfo>& stages) { stages_ = stages; }

void RunBar::setPlan(const QString& plan) {
  plan_->setText(plan);
  showParts();
}

void RunBar::setRunning(bool running) {
  running_ = running;
  stopping_.clear();
  if (running) {
    remaining_.start();
    clock_.start();
  }
  showParts();
}

void RunBar::showParts() {
  bar_->setVisible(running_);
  plan_->setVisible(!running_ && !plan_->text().isEmpty());
  words_->setVisible(running_ || !words_->text().isEmpty() || plan_->text().isEmpty());
}

void RunBar::say(const QString& words) {
  words_->setText(stopping_.isEmpty() ? words : stopping_ + (words.isEmpty() ? "" : " · " + words));
}

void RunBar::showStarted(const QString& what) {
  what_ = what;
  setRunning(true);
  bar_->setValue(0);
  bar_->setFormat(percent(0));
  say(what);
}

void RunBar::showProgress(const StepProgress& p) {
  bar_->setValue(static_cast<int>(1000 * p.job_fraction));
  bar_->setFormat(percent(p.job_fraction));
  remaining_.feed(p.seconds_elapsed, p.seconds_left, p.job_fraction,
                  {p.seconds_left_low, p.seconds_left_high, p.countedLeft()});
  QString what = stepTitle(stages_, p.ref.step);
  if (!p.ref.frame_name.empty()) what += ", frame " + QString::fromStdString(p.ref.frame_name);
  if (p.ref.lead) what += " (again, for the frames after it to build on)";
  // The time first: it is what is left in a narrow window.
  QStringList parts{remaining_.text(), what};
  if (!p.report.label.empty() && p.report.label != p.ref.step.text())
    parts << QString::fromStdString(p.report.label);
  if (p.report.total > 0) parts << numberText(p.report.done) + " of " + numberText(p.report.total);
  if (p.rate > 0) parts << rateText(p.rate, p.report.unit);
  say(parts.join(" · "));
}

void RunBar::showReport(const ProgressReport& report) {
  bar_->setValue(static_cast<int>(1000 * report.fraction));
  bar_->setFormat(percent(report.fraction));
  const double elapsed_s = 1e-3 * static_cast<double>(clock_.elapsed());
  const bool says = report.fraction > kLeastShare && elapsed_s > kLeast_s;
  remaining_.feed(elapsed_s, says ? elapsed_s * (1 - report.fraction) / report.fraction : -1,
                  report.fraction);
  QStringList parts;
  if (remaining_.known()) parts << remaining_.text();
  if (!report.label.empty()) parts << QString::fromStdString(report.label);
  say(parts.isEmpty() ? what_ : what_ + ": " + parts.join(" · "));
}

void RunBar::showWaiting(const QString& text) {
  bar_->setFormat("waiting");
  say(text);
}

void RunBar::showStopping(const QString& how) {
  if (!running_) return;
  stopping_ = how.isEmpty() ? QString("Stopping") : "Stopping " + how;
  say({});
  showParts();
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
