// SPDX-License-Identifier: Apache-2.0
#include "ui/image_page.h"

#include <QCheckBox>
#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QSignalBlocker>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>

#include "ui/quiet_combo.h"
#include "viewers/image/image_view.h"

namespace beam {
namespace {

constexpr const char* kPhotograph = "photo";
constexpr const char* kRender = "render.rgb";
constexpr int kSpacing_px = 8;

QLabel* quiet(const QString& words) {
  auto* label = new QLabel(words);
  label->setObjectName("quiet");
  return label;
}

QToolButton* toggle(const QString& words) {
  auto* button = new QToolButton;
  button->setText(words);
  button->setCheckable(true);
  button->setFocusPolicy(Qt::StrongFocus);
  return button;
}

QHBoxLayout* rowIn(QWidget* widget) {
  auto* row = new QHBoxLayout(widget);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(kSpacing_px);
  return row;
}

void markWrong(QLineEdit* line, bool wrong) {
  line->setProperty("wrong", wrong);
  line->style()->unpolish(line);
  line->style()->polish(line);
}

}  // namespace

ImagePage::ImagePage(const ProjectModel& model, QWidget* parent)
    : QWidget(parent),
      model_(model),
      wanted_{kPhotograph, {}},
      cameras_(new QuietCombo),
      pictures_{new QuietCombo, new QuietCombo},
      wipe_(toggle("Wipe")),
      difference_(toggle("Difference")),
      lock_(new QCheckBox("Lock limits")),
      limits_{new QLineEdit, new QLineEdit},
      choice_(makeChoice()),
      comparing_(makeComparing()),
      holding_(makeHolding()),
      rows_(new QWidget),
      row_layout_(new QBoxLayout(QBoxLayout::LeftToRight, rows_)),
      judging_layout_(new QBoxLayout(QBoxLayout::LeftToRight)),
      view_(new ImageView) {
  row_layout_->setContentsMargins(10, 6, 8, 6);
  row_layout_->setSpacing(kSpacing_px);
  judging_layout_->setSpacing(kSpacing_px);
  judging_layout_->addWidget(comparing_);
  judging_layout_->addWidget(holding_, 1);
  row_layout_->addWidget(choice_, 1);
  row_layout_->addLayout(judging_layout_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(rows_);
  column->addWidget(view_, 1);
  connectParts();
  mirrorLegend();
  refuseWhatIsNotThere();
}

QWidget* ImagePage::makeChoice() {
  auto* widget = new QWidget;
  choice_layout_ = rowIn(widget);
  const auto add = [](QBoxLayout* layout, const QString& words, QuietCombo* box, int stretch) {
    auto* pair = new QWidget;
    QHBoxLayout* row = rowIn(pair);
    row->addWidget(quiet(words));
    row->addWidget(box, 1);
    layout->addWidget(pair, stretch);
  };
  add(choice_layout_, "Camera", cameras_, 1);
  auto* sides = new QWidget;
  QHBoxLayout* row = rowIn(sides);
  add(row, "A", pictures_[0], 1);
  add(row, "B", pictures_[1], 1);
  choice_layout_->addWidget(sides, 4);
  return widget;
}

QWidget* ImagePage::makeComparing() {
  auto* widget = new QWidget;
  QHBoxLayout* row = rowIn(widget);
  row->addWidget(wipe_);
  row->addWidget(difference_);
  row->addStretch();
  return widget;
}

QWidget* ImagePage::makeHolding() {
  auto* widget = new QWidget;
  QHBoxLayout* row = rowIn(widget);
  row->addWidget(lock_);
  row->addWidget(limits_[0]);
  row->addWidget(quiet("to"));
  row->addWidget(limits_[1]);
  row->addStretch();
  return widget;
}

void ImagePage::connectParts() {
  connect(cameras_, QOverload<int>::of(&QComboBox::activated), this, [this](int i) {
    fillPictures();
    Q_EMIT cameraChosen(ViewIndex{i});
  });
  for (int side = 0; side < 2; ++side) {
    connect(pictures_[side], QOverload<int>::of(&QComboBox::activated), this,
            [this, side] { takeChoice(side); });
    connect(limits_[side], &QLineEdit::editingFinished, this, &ImagePage::takeLimits);
  }
  connect(wipe_, &QToolButton::toggled, view_, &ImageView::setWipe);
  connect(difference_, &QToolButton::toggled, view_, &ImageView::setDifference);
  connect(view_, &ImageView::wipeChanged, this, [this](bool on) {
    wipe_->setChecked(on);
    if (on) requireB();
  });
  connect(view_, &ImageView::differenceChanged, this, [this](bool on) {
    difference_->setChecked(on);
    if (on) requireB();
  });
  connect(view_, &ImageView::sidesSwapped, this, [this] {
    std::swap(wanted_[0], wanted_[1]);
    std::swap(shown_[0], shown_[1]);
    for (int side = 0; side < 2; ++side) fillChoices(side);
  });
  connect(view_, &ImageView::legendChanged, this, &ImagePage::mirrorLegend);
  connect(lock_, &QCheckBox::toggled, this, [this](bool on) {
    const LegendState legend = view_->legend();
    view_->lockLimits(on ? std::optional(legend.limits) : std::nullopt);
    mirrorLegend();
  });
}

void ImagePage::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  arrangeRows();
}

void ImagePage::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) arrangeRows();
}

// One row where there is room, else two or three; the page may become as narrow as the widest part.
void ImagePage::arrangeRows() {
  for (QLineEdit* line : limits_) line->setFixedWidth(line->fontMetrics().horizontalAdvance("-000.000") + 16);
  const QMargins margins = row_layout_->contentsMargins();
  const int around = margins.left() + margins.right();
  int choice = -kSpacing_px, widest_choice = 0;
  for (int i = 0; i < choice_layout_->count(); ++i) {
    const int pair = choice_layout_->itemAt(i)->minimumSize().width();
    choice += pair + kSpacing_px;
    widest_choice = std::max(widest_choice, pair);
  }
  const int comparing = comparing_->minimumSizeHint().width(), holding = holding_->minimumSizeHint().width();
  // A choice is worth a row of its own rather than an elided name.
  const int names = 30 * fontMetrics().averageCharWidth();
  const int judging = comparing + kSpacing_px + holding;
  const auto direction = [&](int needed) {
    return width() >= needed + around ? QBoxLayout::LeftToRight : QBoxLayout::TopToBottom;
  };
  rows_->setMinimumWidth(std::max({widest_choice, comparing, holding}) + around);
  choice_layout_->setDirection(direction(choice));
  row_layout_->setDirection(direction(choice + names + kSpacing_px + judging));
  judging_layout_->setDirection(direction(judging));
  // A row of its own is worth its height only where there are false colours.
  holding_->setVisible(view_->legend().shown || judging_layout_->direction() == QBoxLayout::LeftToRight);
}

void ImagePage::setLight(const PictureLight& light) {
  if (light == light_) return;
  light_ = light;
  refresh();
}

void ImagePage::refresh() {
  fillCameras();
  fillPictures();
  refuseWhatIsNotThere();
}

void ImagePage::reset() {
  light_ = {};
  wanted_ = {kPhotograph, {}};
  shown_ = {};
  cameras_->clear();
  view_->resetState();
  refresh();
}

void ImagePage::refuseWhatIsNotThere() {
  const bool ready = cameras_->count() > 0;
  const QString why = "Open a capture or a project first.";
  const auto refuse = [&](QWidget* widget, const QString& help) {
    widget->setEnabled(ready);
    widget->setToolTip(ready ? help : why);
  };
  refuse(wipe_,
         "A left, B right of a line that the hand moves (W); T swaps the sides, hold Shift to see B alone");
  refuse(difference_, "How far A and B are apart in each pixel, in false colours and in figures (D)");
  for (QuietCombo* box : {cameras_, pictures_[0], pictures_[1]}) {
    box->setEnabled(ready);
    box->setHelp(ready ? QString() : why);
  }
}

void ImagePage::fillCameras() {
  QStringList names;
  if (model_.capture()) {
    for (const View& view : model_.capture()->views)
      names << QString::fromStdString(view.name) + (view.split == Split::Test ? "  (test)" : "");
  }
  QStringList before;
  for (int i = 0; i < cameras_->count(); ++i) before << cameras_->itemText(i);
  if (names == before) return;
  const int index = cameras_->currentIndex();
  cameras_->clear();
  cameras_->addItems(names);
  if (!names.isEmpty()) cameras_->setCurrentIndex(index >= 0 && index < names.size() ? index : 0);
}

void ImagePage::choose(ViewIndex view) {
  if (view.value == cameras_->currentIndex() || view.value >= cameras_->count()) return;
  cameras_->setCurrentIndex(view.value);
  fillPictures();
}

void ImagePage::choosePictures(const QString& a, const QString& b) {
  wanted_ = {a, b};
  fillPictures();
  if (b.isEmpty()) view_->setDifference(false);
  if (!view_->difference()) view_->setWipe(!b.isEmpty());
}

void ImagePage::takeChoice(int side) {
  wanted_[side] = pictures_[side]->currentData().toString();
  showPicture(side);
  if (side == 0) return;
  if (wanted_[1].isEmpty()) view_->setDifference(false);
  if (!view_->difference()) view_->setWipe(!wanted_[1].isEmpty());
}

void ImagePage::requireB() {
  if (!wanted_[1].isEmpty() || cameras_->count() == 0) return;
  wanted_[1] = wanted_[0] == kRender ? kPhotograph : kRender;
  fillChoices(1);
  showPicture(1);
}

void ImagePage::fillPictures() {
  sources_.clear();
  if (cameras_->currentIndex() >= 0)
    sources_ = pictureSources(model_, ViewIndex{cameras_->currentIndex()}, light_);
  for (int side = 0; side < 2; ++side) {
    fillChoices(side);
    showPicture(side);
  }
}

// Leaves a list as it is where nothing changed: it may be open.
void ImagePage::fillChoices(int side) {
  QuietCombo& box = *pictures_[side];
  const int none = side == 1 && !sources_.empty() ? 1 : 0;
  bool same = box.count() == static_cast<int>(sources_.size()) + none;
  for (int i = none; same && i < box.count(); ++i) same = box.itemData(i).toString() == sources_[i - none].id;
  if (!same) {
    box.clear();
    if (none) box.addItem("none", QString());
    for (const PictureSource& source : sources_) box.addItem(source.title, source.id);
  }
  if (box.count() > 0) box.setCurrentIndex(std::max(0, box.findData(wanted_[side])));
}

const PictureSource* ImagePage::chosen(int side) const {
  const QString id = pictures_[side]->currentData().toString();
  for (const PictureSource& source : sources_) {
    if (source.id == id) return &source;
  }
  return nullptr;
}

void ImagePage::showPicture(int side) {
  const PictureSource* source = chosen(side);
  if (source == nullptr) {
    shown_[side].reset();
    return view_->setPicture(side, {}, {});
  }
  const bool there =
      shown_[side] && shown_[side]->id == source->id && shown_[side]->made_of == source->made_of;
  if (there && view_->note(side).isEmpty()) return;
  shown_[side] = Shown{source->id, source->made_of};
  view_->setPicture(side, source->title, source->loader, source->of_values);
}

void ImagePage::mirrorLegend() {
  const LegendState legend = view_->legend();
  const bool typing = legend.locked && legend.unit == limits_unit_;  // what is typed waits until it is good
  limits_unit_ = legend.unit;
  const QSignalBlocker quiet_lock(lock_);
  lock_->setEnabled(legend.shown);
  lock_->setChecked(legend.locked);
  lock_->setToolTip(legend.shown
                        ? "Keep these limits of the false colours while camera, frame and picture change"
                        : "Nothing is in false colours: choose Difference, depth, roughness or a weight.");
  for (int i = 0; i < 2; ++i) {
    limits_[i]->setEnabled(legend.locked);
    limits_[i]->setToolTip(
        !legend.locked ? "Lock the limits to set them."
                       : QString(i == 0 ? "Value of the lowest colour%1" : "Value of the highest colour%1")
                             .arg(legend.unit.isEmpty() ? "" : ", in " + legend.unit));
    if (typing && limits_[i]->isModified()) continue;
    const float value = i == 0 ? legend.limits.low : legend.limits.high;
    limits_[i]->setText(legend.shown ? QString::number(value, 'g', 4) : QString());
    markWrong(limits_[i], false);
  }
  arrangeRows();
}

void ImagePage::takeLimits() {
  if (!limits_[0]->isModified() && !limits_[1]->isModified()) return;
  std::array<float, 2> values{};
  bool good = true;
  for (int i = 0; i < 2; ++i) {
    bool number = false;
    values[i] = limits_[i]->text().trimmed().toFloat(&number);
    number = number && std::isfinite(values[i]);
    markWrong(limits_[i], !number);
    good = good && number;
  }
  if (good && values[0] >= values[1]) {
    for (QLineEdit* line : limits_) markWrong(line, true);
    good = false;
  }
  if (!good) {
    for (QLineEdit* line : limits_)
      line->setToolTip("The limits are two numbers, the lower one first; the ones before are in force.");
    return;
  }
  for (QLineEdit* line : limits_) line->setModified(false);
  view_->lockLimits(Limits{values[0], values[1]});
}

}  // namespace beam
