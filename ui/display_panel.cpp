// SPDX-License-Identifier: Apache-2.0
#include "ui/display_panel.h"

#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>
#include <QVBoxLayout>

#include <cmath>

#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

constexpr float kDegrees = 180 / kPi;
constexpr float kStopsPerTick = 0.25f;

QSlider* newSlider(int low, int high) {
  auto* slider = new QSlider(Qt::Horizontal);
  slider->setRange(low, high);
  slider->setFocusPolicy(Qt::ClickFocus);
  return slider;
}

QLabel* quiet(const QString& text) {
  auto* label = new QLabel(text);
  label->setObjectName("quiet");
  label->setMinimumWidth(56);
  label->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  return label;
}

}  // namespace

DisplayPanel::DisplayPanel(SplatView& view, LightLibrary& lights, QWidget* parent)
    : QWidget(parent),
      view_(view),
      lights_(lights),
      channel_(new QComboBox),
      light_(new QComboBox),
      yaw_(newSlider(-180, 180)),
      exposure_(newSlider(-24, 24)),
      photo_(newSlider(0, 100)),
      yaw_words_(quiet({})),
      exposure_words_(quiet({})),
      photo_words_(quiet({})),
      sky_(new QCheckBox("Show the panorama behind the subject")) {
  for (int i = 0; i < kChannelCount; ++i) {
    channel_->addItem(QString("%1   %2").arg(i + 1).arg(infoOf(static_cast<Channel>(i)).title));
  }
  auto* open = new QPushButton("Open panorama…");
  auto* keys = new QLabel(
      "Left drag orbits, middle drag pans, the wheel zooms. F or H goes home. Shift + right drag turns the "
      "light. "
      "E and Shift+E change the exposure, R resets it. [ and ] look through the cameras, Esc leaves; the "
      "wheel then "
      "fades the photograph.");
  keys->setObjectName("quiet");
  keys->setWordWrap(true);
  auto* grid = new QGridLayout;
  grid->setColumnStretch(1, 1);
  int row = 0;
  const auto add = [&](const QString& words, QWidget* widget, QWidget* value) {
    grid->addWidget(new QLabel(words), row, 0);
    grid->addWidget(widget, row, 1, 1, value ? 1 : 2);
    if (value) grid->addWidget(value, row, 2);
    ++row;
  };
  add("Channel", channel_, nullptr);
  add("Light", light_, nullptr);
  add("", open, nullptr);
  add("Turn", yaw_, yaw_words_);
  add("Exposure", exposure_, exposure_words_);
  add("Photograph", photo_, photo_words_);
  grid->addWidget(sky_, 6, 0, 1, 3);
  auto* column = new QVBoxLayout(this);
  column->addLayout(grid);
  column->addSpacing(8);
  column->addWidget(keys);
  column->addStretch();

  connect(channel_, QOverload<int>::of(&QComboBox::activated), this,
          [this](int i) { view_.setChannel(static_cast<Channel>(i)); });
  connect(light_, QOverload<int>::of(&QComboBox::activated), &lights_, &LightLibrary::choose);
  connect(open, &QPushButton::clicked, this, &DisplayPanel::openLightWanted);
  connect(yaw_, &QSlider::valueChanged, this,
          [this](int degrees) { view_.setYaw(static_cast<float>(degrees) / kDegrees); });
  connect(exposure_, &QSlider::valueChanged, this,
          [this](int ticks) { view_.setExposure(kStopsPerTick * static_cast<float>(ticks)); });
  connect(photo_, &QSlider::valueChanged, this,
          [this](int percent) { view_.setPhotoOpacity(static_cast<float>(percent) / 100); });
  connect(sky_, &QCheckBox::toggled, &view_, &SplatView::setSky);
  connect(&view_, &SplatView::stateChanged, this, &DisplayPanel::mirror);
  connect(&lights_, &LightLibrary::entriesChanged, this, &DisplayPanel::fillLights);
  connect(&lights_, &LightLibrary::lightChanged, this, &DisplayPanel::fillLights);
  mirror(view_.state());
  fillLights();
}

void DisplayPanel::mirror(const ViewState& state) {
  const QSignalBlocker quiet_yaw(yaw_), quiet_exposure(exposure_), quiet_photo(photo_), quiet_sky(sky_);
  channel_->setCurrentIndex(static_cast<int>(state.channel));
  yaw_->setValue(static_cast<int>(std::lround(state.yaw_rad * kDegrees)));
  exposure_->setValue(static_cast<int>(std::lround(state.exposure_stops / kStopsPerTick)));
  photo_->setValue(static_cast<int>(std::lround(100 * state.photo_opacity)));
  photo_->setEnabled(state.look_through.has_value());
  sky_->setChecked(state.sky);
  yaw_words_->setText(QString("%1°").arg(yaw_->value()));
  exposure_words_->setText(QString::asprintf("%+.2f", state.exposure_stops));
  photo_words_->setText(QString("%1 %").arg(photo_->value()));
}

void DisplayPanel::fillLights() {
  light_->clear();
  for (const LightEntry& entry : lights_.entries()) light_->addItem(entry.name);
  light_->setCurrentIndex(lights_.chosen());
  light_->setEnabled(light_->count() > 0);
  if (light_->count() == 0) light_->setPlaceholderText("none: open a panorama");
}

}  // namespace beam
