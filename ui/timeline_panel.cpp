// SPDX-License-Identifier: Apache-2.0
#include "ui/timeline_panel.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPainter>
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

// Words that take what room is left; the row never gets wider for them.
QLabel* quietLabel(QHBoxLayout* row, Qt::Alignment alignment) {
  auto* label = new QLabel;
  label->setObjectName("quiet");
  label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  label->setAlignment(alignment | Qt::AlignVCenter);
  row->addWidget(label, 1);
  return label;
}

enum class Sign { Play, Pause, Back, Next, First, Last };

// The style's own are dark on dark.
QIcon iconOf(Sign sign) {
  QPixmap picture(32, 32);
  picture.fill(Qt::transparent);
  QPainter p(&picture);
  p.setRenderHint(QPainter::Antialiasing);
  p.setPen(Qt::NoPen);
  p.setBrush(QColor("#d9dce1"));
  if (sign == Sign::Back || sign == Sign::First) {
    p.translate(32, 0);
    p.scale(-1, 1);
  }
  switch (sign) {
    case Sign::Play:
      p.drawPolygon(QPolygonF({{8, 4}, {28, 16}, {8, 28}}));
      break;
    case Sign::Pause:
      p.drawRect(7, 5, 7, 22);
      p.drawRect(18, 5, 7, 22);
      break;
    case Sign::Back:
    case Sign::Next:
      p.drawRect(6, 7, 3, 18);
      p.drawPolygon(QPolygonF({{12, 7}, {27, 16}, {12, 25}}));
      break;
    case Sign::First:
    case Sign::Last:
      p.drawPolygon(QPolygonF({{6, 7}, {21, 16}, {6, 25}}));
      p.drawRect(22, 7, 4, 18);
      break;
  }
  return QIcon(picture);
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
  auto* to_in = button(row, {}, "To the in point (Home)");
  to_in->setIcon(iconOf(Sign::First));
  act(to_in, [this] { player_.goTo(player_.range().first); });
  auto* back = button(row, {}, "Previous frame (left arrow, or comma)");
  back->setIcon(iconOf(Sign::Back));
  act(back, [this] { player_.step(-1); });
  play_ = button(row, {}, "Play or pause (Space)");
  act(play_, [this] { player_.toggle(); });
  auto* next = button(row, {}, "Next frame (right arrow, or full stop)");
  next->setIcon(iconOf(Sign::Next));
  act(next, [this] { player_.step(1); });
  auto* to_out = button(row, {}, "To the out point (End)");
  to_out->setIcon(iconOf(Sign::Last));
  act(to_out, [this] { player_.goTo(player_.range().last); });
  loop_ = button(row, "Loop", "Play again from the in point (L)");
  loop_->setCheckable(true);
  act(loop_, [this] { player_.setLoop(loop_->isChecked()); });
  act(button(row, "In", "In point here (I)"), [this] { player_.setIn(model_.frame().value); });
  act(button(row, "Out", "Out point here (O)"), [this] { player_.setOut(model_.frame().value); });
  whole_ = button(row, "All", "The whole take: in and out points go away");
  act(whole_, [this] { player_.clearRange(); });
  where_ = quietLabel(row, Qt::AlignLeft);
  row->setSpacing(4);
  curves_ = new QComboBox;
  curves_->setToolTip("The curve below the lanes; press it to go to a frame");
  curves_->setFocusPolicy(Qt::NoFocus);
  curves_->setMinimumContentsLength(16);
  curves_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  curves_->addItem("no curve", QString());
  row->addWidget(curves_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addLayout(row);
  column->addWidget(lanes_);
  column->addStretch();

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

QString TimelinePanel::text() const { return where_->text(); }

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
  play_->setIcon(iconOf(player_.playing() ? Sign::Pause : Sign::Play));
  if (!open) return where_->setText({});
  QStringList words{player_.rateText()};
  if (!note_.isEmpty()) words << note_;
  if (!player_.clock().wholeTake())
    words << QString("%1 of %2 frames").arg(range.size()).arg(player_.clock().frames());
  if (player_.clock().dropped() > 0) words << QString("%1 left out").arg(player_.clock().dropped());
  where_->setText("  " + words.join(" · "));
  where_->setToolTip(where_->text());
}

void TimelinePanel::showMemory() {
  const std::size_t frames = model_.capture() ? model_.capture()->frames.size() : 0;
  const std::vector<bool> held = model_.cache().held(frames);
  lanes_->setMemory(held);
  lanes_->setMemoryWords(QString("%1 frames in memory, %2 of %3 MB")
                             .arg(std::count(held.begin(), held.end(), true))
                             .arg(1e-6 * static_cast<double>(model_.cache().bytes()), 0, 'f', 0)
                             .arg(1e-6 * static_cast<double>(model_.cache().budget()), 0, 'f', 0));
}

}  // namespace beam
