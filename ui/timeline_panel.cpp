// SPDX-License-Identifier: Apache-2.0
#include "ui/timeline_panel.h"

#include <QAbstractItemView>
#include <QAction>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QMenu>
#include <QPainter>
#include <QScrollArea>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>

#include "ui/elided_label.h"
#include "ui/quiet_combo.h"
#include "ui/theme.h"
#include "ui/words.h"

namespace beam {
namespace {

constexpr int kSides = 16, kSpacing = 4;
constexpr int kLeastLetters = 5;     // of the words beside the buttons
constexpr double kDockShare = 0.38;  // of the window's height that the dock may insist on
constexpr double kOtherLines = 6.5;  // lines of text that its title, tabs and the transport row take

QToolButton* button(QHBoxLayout* row, const QString& name) {
  auto* made = new QToolButton;
  made->setAccessibleName(name);
  made->setFocusPolicy(Qt::TabFocus);  // a click leaves the keys with the view
  row->addWidget(made);
  return made;
}

// Keys go to the transport, not to the scroll bars.
class LaneScroll final : public QScrollArea {
 protected:
  void keyPressEvent(QKeyEvent* event) override { event->ignore(); }
};

enum class Sign { Play, Pause, Back, Next, First, Last };

// The style's own are dark, on dark, too.
QIcon iconOf(Sign sign) {
  QPixmap picture(32, 32);
  picture.fill(Qt::transparent);
  QPainter p(&picture);
  p.setRenderHint(QPainter::Antialiasing);
  p.setPen(Qt::NoPen);
  p.setBrush(colors().text);
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

}  // namespace

TimelinePanel::TimelinePanel(ProjectModel& model, Player& player, QWidget* parent)
    : QWidget(parent), model_(model), player_(player), lanes_(new TimelineLanes), scroll_(new LaneScroll) {
  scroll_->setWidgetResizable(true);
  scroll_->setFrameShape(QFrame::NoFrame);
  scroll_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll_->setFocusPolicy(Qt::NoFocus);
  scroll_->setWidget(lanes_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addLayout(makeTransport());
  column->addWidget(scroll_, 1);
  lanes_->setStages(model_.services().pipeline->stages.infos());
  connectModel();
  showIcons();
  showState();
}

QHBoxLayout* TimelinePanel::makeTransport() {
  auto* row = new QHBoxLayout;
  row->setContentsMargins(kSides / 2, 4, kSides / 2, 2);
  row->setSpacing(kSpacing);
  const auto act = [this](QToolButton* b, auto slot) { connect(b, &QToolButton::clicked, this, slot); };
  QToolButton* to_in =
      foldable(row, to_in_, "To the in point", [this] { player_.goTo(player_.range().first); });
  back_ = button(row, "Previous frame");
  act(back_, [this] { player_.step(-1); });
  play_ = button(row, "Play or pause");
  act(play_, [this] { player_.toggle(); });
  next_ = button(row, "Next frame");
  act(next_, [this] { player_.step(1); });
  QToolButton* to_out =
      foldable(row, to_out_, "To the out point", [this] { player_.goTo(player_.range().last); });
  for (QToolButton* with_icon : {to_in, back_, play_, next_, to_out}) with_icon->setObjectName("icon");
  makePoints(row);
  where_ = new ElidedLabel;
  where_->setObjectName("quiet");
  where_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  where_->setLeastLetters(kLeastLetters);
  row->addWidget(where_, 1);
  curves_ = new QuietCombo;
  curves_->setAccessibleName("Curve");
  curves_->setFocusPolicy(Qt::TabFocus);
  curves_->addItem("no curve", QString());
  row->addWidget(curves_);
  return row;
}

// A button where there is room for it, else an entry of the menu at the end.
QToolButton* TimelinePanel::foldable(QHBoxLayout* row, QAction*& action, const QString& text,
                                     std::function<void()> act) {
  action = new QAction(text, this);
  connect(action, &QAction::triggered, this, std::move(act));
  QToolButton* shown = button(row, text);
  shown->setDefaultAction(action);
  foldable_.push_back(shown);
  return shown;
}

void TimelinePanel::makePoints(QHBoxLayout* row) {
  foldable(row, in_, "In", [this] { player_.setIn(model_.frame().value); });
  foldable(row, out_, "Out", [this] { player_.setOut(model_.frame().value); });
  foldable(row, loop_, "Loop", [this] { player_.setLoop(loop_->isChecked()); });
  loop_->setCheckable(true);
  foldable(row, whole_, "All", [this] { player_.clearRange(); });
  more_ = new QToolButton;
  more_->setObjectName("icon");
  more_->setText("…");
  more_->setAccessibleName("More of the transport");
  more_->setToolTip("In and out points, loop");
  more_->setPopupMode(QToolButton::InstantPopup);
  more_->setFocusPolicy(Qt::TabFocus);
  more_->setMenu(new QMenu(more_));
  more_->menu()->setToolTipsVisible(true);
  row->addWidget(more_);
}

void TimelinePanel::connectModel() {
  connect(curves_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    showCurve();
    revealCurve();
  });
  connect(lanes_, &TimelineLanes::frameWanted, this, [this](int frame) { player_.goTo(frame); });
  connect(lanes_, &TimelineLanes::heightChanged, this, &TimelinePanel::fitHeight);
  connect(&model_, &ProjectModel::opened, this, [this] {
    survey_ = nullptr;
    lanes_->setSurvey(nullptr);
    fillCurves();
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
}

// Everything that can fold is folded.
QSize TimelinePanel::minimumSizeHint() const {
  int width = kSides + more_->sizeHint().width() + curves_->minimumSizeHint().width() +
              where_->minimumSizeHint().width() + 2 * kSpacing;
  for (const QToolButton* kept : {back_, play_, next_}) width += kept->sizeHint().width() + kSpacing;
  return {width, QWidget::minimumSizeHint().height()};
}

// What does not fit goes into the menu; what is left over goes to the name of the curve and to the words.
void TimelinePanel::fold() {
  const int menu = more_->sizeHint().width();
  int room = width() - minimumSizeHint().width() + menu, all = 0;
  for (const QToolButton* shown : foldable_) all += shown->sizeHint().width() + kSpacing;
  const bool folds = all > room;
  if (folds) room -= menu;
  more_->menu()->clear();
  bool full = false;
  for (QToolButton* shown : foldable_) {
    const int wanted = shown->sizeHint().width() + kSpacing;
    full = full || wanted > room;
    if (!full) room -= wanted;
    shown->setVisible(!full);
    if (full) more_->menu()->addAction(shown->defaultAction());
  }
  more_->setVisible(folds);
  const int least = curves_->minimumSizeHint().width();
  const int name = fontMetrics().horizontalAdvance(curves_->currentText()) + 3 * fontMetrics().height();
  curves_->setFixedWidth(std::clamp(name, least, least + std::max(0, room / 2)));
  layout()->activate();  // not a moment with the old row at the new width
}

// The lanes insist on their height as far as a share of the window has it; where that is low they scroll.
void TimelinePanel::fitHeight() {
  const int most =
      std::max(2 * fontMetrics().height(),
               static_cast<int>(kDockShare * window()->height() - kOtherLines * fontMetrics().height()));
  const int wanted = std::min(lanes_->sizeHint().height(), most);
  if (scroll_->minimumHeight() == wanted) return;
  scroll_->setMinimumHeight(wanted);
}

void TimelinePanel::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  fold();
}

void TimelinePanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  window()->installEventFilter(this);
  fold();
  fitHeight();
}

void TimelinePanel::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() != QEvent::FontChange && event->type() != QEvent::StyleChange) return;
  if (!more_) return;  // the base asks while it is being made
  showIcons();
  fold();
}

bool TimelinePanel::eventFilter(QObject* watched, QEvent* event) {
  if (watched == window() && event->type() == QEvent::Resize) fitHeight();
  return QWidget::eventFilter(watched, event);
}

void TimelinePanel::showIcons() {
  to_in_->setIcon(iconOf(Sign::First));
  back_->setIcon(iconOf(Sign::Back));
  play_->setIcon(iconOf(player_.playing() ? Sign::Pause : Sign::Play));
  next_->setIcon(iconOf(Sign::Next));
  to_out_->setIcon(iconOf(Sign::Last));
  const int side = fontMetrics().height();
  for (QToolButton* with_icon : findChildren<QToolButton*>("icon")) with_icon->setIconSize({side, side});
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
  showCurve();
  revealCurve();
  return true;
}

void TimelinePanel::showCurve() {
  const bool any = curves_->currentIndex() > 0;
  lanes_->setCurve(curves_->currentData().toString(), any ? curves_->currentText() : QString());
  // A name that is cut stands in the tooltip already.
  curves_->setHelp(curves_->count() < 2 ? "There are no curves yet: they come with the first result"
                                        : "The curve below the lanes; press it to go to a frame");
  fold();
}

// What was asked for is in view, once the lanes have their new height.
void TimelinePanel::revealCurve() {
  if (curves_->currentIndex() < 1) return;
  QTimer::singleShot(0, this, [this] {
    const QRect box = lanes_->curveBox().toAlignedRect();
    if (isVisible()) scroll_->ensureVisible(box.left(), box.bottom(), 0, 0);
  });
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
    const std::vector<StageInfo>& stages = model_.services().pipeline->stages.infos();
    for (const SurveyCurve& curve : model_.survey()->curves)
      curves_->addItem(curveTitle(stages, curve.name), QString::fromStdString(curve.name));
  }
  curves_->setEnabled(curves_->count() > 1);
  curves_->setCurrentIndex(std::max(0, curves_->findData(chosen)));
  curves_->view()->setMinimumWidth(curves_->view()->sizeHintForColumn(0) + 24);
  showCurve();
}

void TimelinePanel::showState() {
  const FrameRange range = player_.range();
  const bool open = model_.isOpen() && range.size() > 0;
  lanes_->setFrame(model_.frame().value);
  lanes_->setRange(range);
  const QString closed = "Open a capture or a project first";
  const auto allow = [&](auto* control, bool can, const QString& tip, const QString& why) {
    control->setEnabled(can);
    control->setToolTip(can ? tip : open ? why : closed);
  };
  allow(to_in_, open, "To the in point (Home)", {});
  allow(back_, open, "Previous frame (left arrow, or comma)", {});
  allow(play_, open && range.size() > 1, "Play or pause (Space)", "A single frame cannot be played");
  allow(next_, open, "Next frame (right arrow, or full stop)", {});
  allow(to_out_, open, "To the out point (End)", {});
  allow(loop_, open, "Play again from the in point (L)", {});
  allow(in_, open, "In point here (I)", {});
  allow(out_, open, "Out point here (O)", {});
  allow(whole_, open && !player_.clock().wholeTake(), "The whole take: in and out points go away",
        "There are no in and out points: this is the whole take");
  loop_->setChecked(player_.clock().loop());
  play_->setIcon(iconOf(player_.playing() ? Sign::Pause : Sign::Play));
  if (!open) return where_->setText({});
  QStringList words{player_.rateText()};
  if (!note_.isEmpty()) words << note_;
  if (!player_.clock().wholeTake())
    words << QString("%1 of %2").arg(numberText(range.size()), countText(player_.clock().frames(), "frame"));
  if (player_.clock().dropped() > 0) words << numberText(player_.clock().dropped()) + " dropped";
  where_->setText(words.join(" · "));
  where_->setNote("Pictures a second; dropped: frames that were passed over to keep up");
}

void TimelinePanel::showMemory() {
  const auto sequence = model_.sequence();
  const std::vector<bool> held = sequence ? model_.cache().held(*sequence) : std::vector<bool>();
  lanes_->setMemory(held);
  const auto megabytes = [](std::size_t bytes) {
    return numberText(std::llround(1e-6 * static_cast<double>(bytes)));
  };
  lanes_->setMemoryWords(QString("%1 in memory, %2 of %3 MB")
                             .arg(countText(std::count(held.begin(), held.end(), true), "frame"),
                                  megabytes(model_.cache().bytes()), megabytes(model_.cache().budget())));
}

}  // namespace beam
