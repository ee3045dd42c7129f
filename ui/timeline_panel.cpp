// SPDX-License-Identifier: Apache-2.0
#include "ui/timeline_panel.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QScrollArea>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

namespace beam {
namespace {

QToolButton* button(QHBoxLayout* row, const QString& text, const QString& tip) {
  auto* made = new QToolButton;
  made->setText(text);
  made->setToolTip(tip);
  made->setFocusPolicy(Qt::NoFocus);
  row->addWidget(made);
  return made;
}

QLabel* quietLabel(QHBoxLayout* row) {
  auto* label = new QLabel;
  label->setObjectName("quiet");
  row->addWidget(label);
  return label;
}

// "surface.fit.gaussians" -> "Surface fit: gaussians"
QString titleOf(const std::string& curve) {
  QStringList parts = QString::fromStdString(curve).split('.');
  if (parts.size() < 3) return QString::fromStdString(curve);
  const QString score = QStringList(parts.mid(2)).join(' ').replace('_', ' ');
  parts[0][0] = parts[0][0].toUpper();
  return QString("%1 %2: %3").arg(parts[0], parts[1], score);
}

}  // namespace

TimelinePanel::TimelinePanel(ProjectModel& model, Player& player, QWidget* parent)
    : QWidget(parent), model_(model), player_(player), lanes_(new TimelineLanes) {
  auto* row = new QHBoxLayout;
  row->setContentsMargins(8, 4, 8, 2);
  row->setSpacing(4);
  const auto act = [this](QToolButton* b, auto slot) { connect(b, &QToolButton::clicked, this, slot); };
  const auto icon = [this](QToolButton* b, QStyle::StandardPixmap name) {
    b->setIcon(style()->standardIcon(name));
  };
  auto* to_in = button(row, {}, "To the in point (Home)");
  icon(to_in, QStyle::SP_MediaSkipBackward);
  act(to_in, [this] { player_.goTo(player_.range().first); });
  auto* back = button(row, {}, "Previous frame (left arrow, or comma)");
  icon(back, QStyle::SP_MediaSeekBackward);
  act(back, [this] { player_.step(-1); });
  play_ = button(row, {}, "Play or pause (Space)");
  act(play_, [this] { player_.toggle(); });
  auto* next = button(row, {}, "Next frame (right arrow, or full stop)");
  icon(next, QStyle::SP_MediaSeekForward);
  act(next, [this] { player_.step(1); });
  auto* to_out = button(row, {}, "To the out point (End)");
  icon(to_out, QStyle::SP_MediaSkipForward);
  act(to_out, [this] { player_.goTo(player_.range().last); });
  loop_ = button(row, "Loop", "Play again from the in point (L)");
  loop_->setCheckable(true);
  act(loop_, [this] { player_.setLoop(loop_->isChecked()); });
  act(button(row, "In", "In point here (I)"), [this] { player_.setIn(model_.frame().value); });
  act(button(row, "Out", "Out point here (O)"), [this] { player_.setOut(model_.frame().value); });
  whole_ = button(row, "Whole take", "Take in and out points away");
  act(whole_, [this] { player_.clearRange(); });
  where_ = quietLabel(row);
  rate_ = quietLabel(row);
  row->addStretch();
  memory_ = quietLabel(row);
  curves_ = new QComboBox;
  curves_->setToolTip("The curve below the lanes; press it to go to a frame");
  curves_->setFocusPolicy(Qt::NoFocus);
  curves_->addItem("no curve", QString());
  row->addWidget(curves_);
  auto* scroll = new QScrollArea;
  scroll->setWidget(lanes_);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addLayout(row);
  column->addWidget(scroll, 1);

  connect(curves_, QOverload<int>::of(&QComboBox::activated), this,
          [this] { lanes_->setCurve(curves_->currentData().toString()); });
  connect(lanes_, &TimelineLanes::frameWanted, this, [this](int frame) { player_.goTo(frame); });
  connect(&model_, &ProjectModel::opened, this, [this] {
    survey_ = nullptr;
    lanes_->setSurvey(nullptr);
    showState();
  });
  connect(&model_, &ProjectModel::frameChanged, this, &TimelinePanel::showState);
  connect(&model_, &ProjectModel::stagesChanged, this, [this] {
    if (model_.survey() == survey_) return;  // only the frame is another
    survey_ = model_.survey();
    lanes_->setSurvey(survey_);
    fillCurves();
  });
  connect(&model_, &ProjectModel::memoryChanged, this, &TimelinePanel::showMemory);
  for (const auto signal : {&Player::playingChanged, &Player::rangeChanged, &Player::rateChanged})
    connect(&player_, signal, this, &TimelinePanel::showState);
  showState();
}

bool TimelinePanel::handleKey(const QKeyEvent& event) {
  if (event.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier | Qt::ShiftModifier))
    return false;
  switch (event.key()) {
    case Qt::Key_Space:
      player_.toggle();
      return true;
    case Qt::Key_Left:
    case Qt::Key_Comma:
      player_.step(-1);
      return true;
    case Qt::Key_Right:
    case Qt::Key_Period:
      player_.step(1);
      return true;
    case Qt::Key_Home:
      player_.goTo(player_.range().first);
      return true;
    case Qt::Key_End:
      player_.goTo(player_.range().last);
      return true;
    case Qt::Key_I:
      player_.setIn(model_.frame().value);
      return true;
    case Qt::Key_O:
      player_.setOut(model_.frame().value);
      return true;
    case Qt::Key_L:
      player_.setLoop(!player_.clock().loop());
      return true;
    default:
      return false;
  }
}

bool TimelinePanel::chooseCurve(const QString& name) {
  const int i = curves_->findData(name);
  if (i < 0) return false;
  curves_->setCurrentIndex(i);
  lanes_->setCurve(name);
  return true;
}

void TimelinePanel::setPictureNote(const QString& note) {
  if (note == note_) return;
  note_ = note;
  showState();
}

QString TimelinePanel::text() const { return where_->text() + "   " + rate_->text(); }

void TimelinePanel::fillCurves() {
  const QString chosen = curves_->currentData().toString();
  curves_->clear();
  curves_->addItem("no curve", QString());
  if (model_.survey()) {
    for (const SurveyCurve& curve : model_.survey()->curves)
      curves_->addItem(titleOf(curve.name), QString::fromStdString(curve.name));
  }
  curves_->setCurrentIndex(std::max(0, curves_->findData(chosen)));
  lanes_->setCurve(curves_->currentData().toString());
}

void TimelinePanel::showState() {
  const FrameRange range = player_.range();
  const bool open = model_.isOpen() && range.size() > 0;
  lanes_->setFrame(model_.frame().value);
  lanes_->setRange(range);
  loop_->setChecked(player_.clock().loop());
  whole_->setEnabled(open && !player_.clock().wholeTake());
  play_->setIcon(style()->standardIcon(player_.playing() ? QStyle::SP_MediaPause : QStyle::SP_MediaPlay));
  if (!open) {
    where_->setText({});
    rate_->setText({});
    return;
  }
  where_->setText(QString("  %1 of %2").arg(model_.frame().value + 1).arg(player_.clock().frames()));
  if (!player_.clock().wholeTake()) {
    const auto& names = model_.capture()->frames;
    where_->setText(QString("%1 · in %2, out %3: %4 frames")
                        .arg(where_->text(), QString::fromStdString(names[range.first]),
                             QString::fromStdString(names[range.last]))
                        .arg(range.size()));
  }
  QString rate = " · " + player_.rateText();
  if (player_.clock().dropped() > 0) rate += QString(" · %1 left out").arg(player_.clock().dropped());
  if (!note_.isEmpty()) rate += " · " + note_;
  rate_->setText(rate);
}

void TimelinePanel::showMemory() {
  const std::size_t frames = model_.capture() ? model_.capture()->frames.size() : 0;
  const std::vector<bool> held = model_.cache().held(frames);
  lanes_->setMemory(held);
  memory_->setText(QString("%1 frames in memory, %2 of %3 MB  ")
                       .arg(std::count(held.begin(), held.end(), true))
                       .arg(1e-6 * static_cast<double>(model_.cache().bytes()), 0, 'f', 0)
                       .arg(1e-6 * static_cast<double>(model_.cache().budget()), 0, 'f', 0));
}

}  // namespace beam
