// SPDX-License-Identifier: Apache-2.0
#include "ui/image_page.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>

#include "viewers/image/image_view.h"

namespace beam {

ImagePage::ImagePage(const ProjectModel& model, QWidget* parent)
    : QWidget(parent), model_(model), cameras_(new QComboBox), wipe_(new QToolButton), view_(new ImageView) {
  auto* row = new QHBoxLayout;
  row->setContentsMargins(10, 6, 8, 6);
  row->setSpacing(8);
  const auto add = [&](const QString& words, QWidget* widget, int stretch) {
    auto* label = new QLabel(words);
    label->setObjectName("quiet");
    row->addWidget(label);
    row->addWidget(widget, stretch);
  };
  for (auto& box : pictures_) box = new QComboBox;
  add("Camera", cameras_, 0);
  add("A", pictures_[0], 1);
  add("B", pictures_[1], 1);
  for (QComboBox* box : {cameras_, pictures_[0], pictures_[1]}) {
    box->setMinimumWidth(110);
    box->setFocusPolicy(Qt::ClickFocus);
    box->setMaxVisibleItems(30);
  }
  wipe_->setText("Wipe");
  wipe_->setCheckable(true);
  wipe_->setToolTip(
      "A left, B right of a line that the hand moves (W); T swaps the sides, hold Shift to see B alone");
  row->addWidget(wipe_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addLayout(row);
  column->addWidget(view_, 1);
  connect(cameras_, QOverload<int>::of(&QComboBox::activated), this, [this](int i) {
    fillPictures();
    Q_EMIT cameraChosen(ViewIndex{i});
  });
  for (int side = 0; side < 2; ++side) {
    connect(pictures_[side], QOverload<int>::of(&QComboBox::activated), this, [this, side] {
      wanted_[side] = chosenId(side);
      show(side);
      if (side == 1) view_->setWipe(!chosenId(1).isEmpty());
    });
  }
  connect(wipe_, &QToolButton::toggled, view_, &ImageView::setWipe);
  connect(view_, &ImageView::wipeChanged, wipe_, &QToolButton::setChecked);
  connect(view_, &ImageView::sidesSwapped, this, [this] {
    std::swap(wanted_[0], wanted_[1]);
    for (int side = 0; side < 2; ++side) {
      pictures_[side]->setCurrentIndex(std::max(0, pictures_[side]->findData(wanted_[side])));
    }
  });
}

void ImagePage::setLight(const PictureLight& light) {
  light_ = light;
  refresh();
}

void ImagePage::refresh() {
  const int before = cameras_->currentIndex();
  cameras_->clear();
  if (model_.capture()) {
    for (const View& view : model_.capture()->views) {
      cameras_->addItem(QString::fromStdString(view.name) + (view.split == Split::Test ? "  (test)" : ""));
    }
  }
  if (cameras_->count() > 0)
    cameras_->setCurrentIndex(before >= 0 && before < cameras_->count() ? before : 0);
  fillPictures();
}

void ImagePage::choose(ViewIndex view) {
  if (view.value == cameras_->currentIndex() || view.value >= cameras_->count()) return;
  cameras_->setCurrentIndex(view.value);
  fillPictures();
}

void ImagePage::choosePictures(const QString& a, const QString& b) {
  wanted_ = {a, b};
  fillPictures();
  view_->setWipe(!b.isEmpty());
}

QString ImagePage::chosenId(int side) const { return pictures_[side]->currentData().toString(); }

void ImagePage::fillPictures() {
  sources_.clear();
  if (cameras_->currentIndex() >= 0)
    sources_ = pictureSources(model_, ViewIndex{cameras_->currentIndex()}, light_);
  for (int side = 0; side < 2; ++side) {
    pictures_[side]->clear();
    if (side == 1) pictures_[side]->addItem("none", QString());
    for (const PictureSource& source : sources_) pictures_[side]->addItem(source.title, source.id);
    pictures_[side]->setCurrentIndex(std::max(0, pictures_[side]->findData(wanted_[side])));
    show(side);
  }
}

void ImagePage::show(int side) {
  const QString id = chosenId(side);
  for (const PictureSource& source : sources_) {
    if (source.id == id) return view_->setPicture(side, source.title, source.loader);
  }
  view_->setPicture(side, {}, {});
}

}  // namespace beam
