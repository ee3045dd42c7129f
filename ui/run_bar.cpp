// SPDX-License-Identifier: Apache-2.0
#include "ui/run_bar.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QProgressBar>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>

#include <cmath>

namespace beam {

QString durationText(double seconds) {
  const auto s = static_cast<long long>(std::llround(seconds));
  if (s < 60) return QString("%1 s").arg(s);
  if (s < 3600) return QString("%1 min %2 s").arg(s / 60).arg(s % 60, 2, 10, QChar('0'));
  return QString("%1 h %2 min").arg(s / 3600).arg(s % 3600 / 60, 2, 10, QChar('0'));
}

RunBar::RunBar(QWidget* parent)
    : QWidget(parent),
      run_(new QToolButton),
      stop_(new QPushButton("Cancel")),
      bar_(new QProgressBar),
      words_(new QLabel) {
  run_->setObjectName("primary");
  run_->setText("Run");
  run_->setToolTip(
      "Compute what is missing of this frame (Ctrl+Enter); the arrow chooses frames or the last stage");
  run_->setPopupMode(QToolButton::MenuButtonPopup);
  run_->setMenu(new QMenu(run_));
  run_->setMinimumHeight(30);
  stop_->setToolTip("Stop now (Ctrl+.); finished steps are kept");
  stop_->setMinimumHeight(30);
  bar_->setRange(0, 1000);
  bar_->setTextVisible(true);
  words_->setObjectName("quiet");
  words_->setMinimumWidth(330);
  auto* column = new QVBoxLayout;
  column->setSpacing(3);
  column->addWidget(bar_);
  column->addWidget(words_);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(8);
  row->addWidget(run_);
  row->addWidget(stop_);
  row->addLayout(column, 1);
  connect(run_, &QToolButton::clicked, this, [this] { Q_EMIT runWanted({}); });
  connect(stop_, &QPushButton::clicked, this, &RunBar::stopWanted);
  setRunning(false);
}

void RunBar::setStages(const std::vector<StageInfo>& stages) {
  run_->menu()->clear();
  run_->menu()->addAction("This frame", this, [this] { Q_EMIT runWanted({}); });
  run_->menu()->addAction("In–out range", this, &RunBar::rangeWanted);
  run_->menu()->addAction("Scout the in–out range…", this, &RunBar::scoutWanted);
  run_->menu()->addAction("Whole take", this, &RunBar::takeWanted);
  run_->menu()->addSeparator();
  for (const StageInfo& stage : stages) {
    run_->menu()->addAction("This frame until " + QString::fromStdString(stage.title), this,
                            [this, id = stage.id] { Q_EMIT runWanted(QString::fromStdString(id)); });
  }
}

void RunBar::setReady(bool project_open) {
  ready_ = project_open;
  setRunning(running_);
}

void RunBar::setRunning(bool running) {
  running_ = running;
  run_->setEnabled(ready_ && !running);
  stop_->setEnabled(running);
  bar_->setVisible(running);
}

void RunBar::showStarted(const QString& what) {
  setRunning(true);
  bar_->setValue(0);
  bar_->setFormat("%p %");
  words_->setText(what);
}

void RunBar::showProgress(const StepProgress& p) {
  bar_->setValue(static_cast<int>(1000 * p.job_fraction));
  bar_->setFormat(QString("%1 %").arg(100 * p.job_fraction, 0, 'f', 1));
  QStringList parts{QString::fromStdString(p.report.label.empty() ? p.ref.step : p.report.label)};
  if (!p.ref.frame_name.empty()) parts.front() += " of frame " + QString::fromStdString(p.ref.frame_name);
  if (p.ref.lead) parts.front() += " (lead)";
  if (p.report.total > 0) parts << QString("%L1 of %L2").arg(p.report.done).arg(p.report.total);
  if (p.rate > 0) parts << QString("%1 a second").arg(p.rate, 0, 'f', p.rate < 10 ? 1 : 0);
  parts << (p.seconds_left >= 0 ? "about " + durationText(p.seconds_left) + " left"
                                : QString("estimating the time"));
  words_->setText(parts.join(" · "));
}

void RunBar::showReport(const ProgressReport& report) {
  bar_->setValue(static_cast<int>(1000 * report.fraction));
  bar_->setFormat(QString("%1 %").arg(100 * report.fraction, 0, 'f', 0));
  words_->setText(QString::fromStdString(report.label));
}

void RunBar::showStopping() {
  stop_->setEnabled(false);
  words_->setText("Stopping");
}

void RunBar::showFinished(const QString& outcome) {
  setRunning(false);
  words_->setText(outcome);
  words_->setToolTip(outcome);
}

QString RunBar::text() const { return words_->text(); }

}  // namespace beam
