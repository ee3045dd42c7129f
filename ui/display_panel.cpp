// SPDX-License-Identifier: Apache-2.0
#include "ui/display_panel.h"

#include <QCheckBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QSignalBlocker>
#include <QSlider>
#include <QVBoxLayout>
#include <QWheelEvent>

#include <cmath>

#include "ui/quiet_combo.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

constexpr float kDegrees = 180 / kPi;
constexpr float kStopsPerTick = 0.25f;

const char* const kHands =
    "Left drag orbits, middle drag pans, the wheel zooms to the pointer, a double-click sets the point to "
    "circle.\n"
    "F frames the subject, H goes home. 1, 3 and 7 of the number pad look from the front, the right and the "
    "top, with Ctrl from the other side.\n"
    "Shift and right drag turn the light. E and Shift+E change the exposure, R resets it.\n"
    "[ and ] look through the cameras, Esc leaves; the wheel then fades the photograph.";

// The wheel scrolls the panel unless the slider was chosen.
class QuietSlider final : public QSlider {
 public:
  QuietSlider(int low, int high) : QSlider(Qt::Horizontal) {
    setRange(low, high);
    setFocusPolicy(Qt::StrongFocus);
  }

 protected:
  void wheelEvent(QWheelEvent* event) override {
    if (!hasFocus()) return event->ignore();
    QSlider::wheelEvent(event);
  }
};

QLabel* quiet() {
  auto* label = new QLabel;
  label->setObjectName("quiet");
  label->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  return label;
}

// The name above what it names, the value at the end of the name's line: nothing is cut in a narrow panel.
void addRow(QVBoxLayout& column, const QString& name, QWidget* widget, QLabel* value = nullptr) {
  auto* line = new QHBoxLayout;
  auto* label = new QLabel(name);
  label->setBuddy(widget);
  line->addWidget(label);
  line->addStretch();
  if (value != nullptr) line->addWidget(value);
  column.addLayout(line);
  column.addWidget(widget);
  column.addSpacing(4);
}

}  // namespace

DisplayPanel::DisplayPanel(SplatView& view, LightLibrary& lights, QWidget* parent)
    : QWidget(parent),
      view_(view),
      lights_(lights),
      channel_(new QuietCombo),
      light_(new QuietCombo),
      yaw_(new QuietSlider(-180, 180)),
      exposure_(new QuietSlider(-24, 24)),
      photo_(new QuietSlider(0, 100)),
      yaw_words_(quiet()),
      exposure_words_(quiet()),
      photo_words_(quiet()),
      sky_(new QCheckBox("Show panorama")),
      lock_depth_(new QCheckBox("Lock depth limits")),
      open_(new QPushButton("Open panorama…")) {
  for (int i = 0; i < kChannelCount; ++i) {
    channel_->addItem(QString("%1   %2").arg(i + 1).arg(infoOf(static_cast<Channel>(i)).title));
  }
  makeRows();
  connectParts();
  mirror(view_.state());
  fillLights();
}

void DisplayPanel::makeRows() {
  auto* hands = new QLabel(kHands);
  hands->setObjectName("quiet");
  hands->setWordWrap(true);
  auto* inside = new QWidget;
  auto* rows = new QVBoxLayout(inside);
  rows->setContentsMargins(8, 8, 8, 8);
  addRow(*rows, "Channel", channel_);
  addRow(*rows, "Light", light_);
  rows->addWidget(open_);
  rows->addSpacing(4);
  addRow(*rows, "Turn of light", yaw_, yaw_words_);
  addRow(*rows, "Exposure", exposure_, exposure_words_);
  addRow(*rows, "Photograph", photo_, photo_words_);
  rows->addWidget(sky_);
  rows->addWidget(lock_depth_);
  rows->addSpacing(8);
  rows->addWidget(hands);
  rows->addStretch();
  auto* scroll = new QScrollArea;
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setFocusPolicy(Qt::NoFocus);
  scroll->setWidget(inside);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(scroll);
}

void DisplayPanel::connectParts() {
  connect(channel_, QOverload<int>::of(&QComboBox::activated), this,
          [this](int i) { view_.setChannel(static_cast<Channel>(i)); });
  connect(light_, QOverload<int>::of(&QComboBox::activated), &lights_, &LightLibrary::choose);
  connect(open_, &QPushButton::clicked, this, &DisplayPanel::openLightWanted);
  connect(yaw_, &QSlider::valueChanged, this,
          [this](int degrees) { view_.setYaw(static_cast<float>(degrees) / kDegrees); });
  connect(exposure_, &QSlider::valueChanged, this,
          [this](int ticks) { view_.setExposure(kStopsPerTick * static_cast<float>(ticks)); });
  connect(photo_, &QSlider::valueChanged, this,
          [this](int percent) { view_.setPhotoOpacity(static_cast<float>(percent) / 100); });
  connect(sky_, &QCheckBox::toggled, &view_, &SplatView::setSky);
  connect(lock_depth_, &QCheckBox::clicked, &view_, &SplatView::lockDepth);
  connect(&view_, &SplatView::stateChanged, this, &DisplayPanel::mirror);
  connect(&lights_, &LightLibrary::entriesChanged, this, &DisplayPanel::fillLights);
  connect(&lights_, &LightLibrary::lightChanged, this, &DisplayPanel::fillLights);
}

void DisplayPanel::mirror(const ViewState& state) {
  const QSignalBlocker quiet_yaw(yaw_), quiet_exposure(exposure_), quiet_photo(photo_), quiet_sky(sky_);
  channel_->setCurrentIndex(static_cast<int>(state.channel));
  yaw_->setValue(static_cast<int>(std::lround(state.yaw_rad * kDegrees)));
  exposure_->setValue(static_cast<int>(std::lround(state.exposure_stops / kStopsPerTick)));
  photo_->setValue(static_cast<int>(std::lround(100 * state.photo_opacity)));
  photo_->setEnabled(state.look_through.has_value());
  photo_->setToolTip(state.look_through
                         ? "How much of the photograph lies over the render"
                         : "Look through a camera ([ or ]) to lay its photograph over the render.");
  sky_->setChecked(state.sky);
  const bool depth = state.channel == Channel::Depth;
  lock_depth_->setEnabled(depth);
  lock_depth_->setChecked(state.depth_limits.has_value());
  lock_depth_->setToolTip(depth ? "Keep these limits of the colours while camera and frame change"
                                : "Choose the channel Depth first: its colours have limits to keep.");
  yaw_words_->setText(QString("%1°").arg(yaw_->value()));
  exposure_words_->setText(QString::asprintf("%+.2f stops", state.exposure_stops));
  photo_words_->setText(QString("%1 %").arg(photo_->value()));
}

void DisplayPanel::fillLights() {
  QStringList names;
  for (const LightEntry& entry : lights_.entries()) names << entry.name;
  QStringList before;
  for (int i = 0; i < light_->count(); ++i) before << light_->itemText(i);
  if (names != before) {
    light_->clear();
    light_->addItems(names);
  }
  light_->setCurrentIndex(lights_.chosen());
  light_->setEnabled(!names.isEmpty());
  light_->setPlaceholderText(names.isEmpty() ? "none" : "none chosen");
  light_->setHelp(names.isEmpty()     ? "There is no panorama yet: open one below."
                  : lights_.reading() ? "reading the light"
                                      : "The panorama that lights the subject");
  const bool lit = lights_.light() != nullptr || lights_.reading();
  yaw_->setEnabled(lit);
  sky_->setEnabled(lit);
  yaw_->setToolTip(lit ? "Turns the panorama about the vertical"
                       : "There is no light to turn: choose or open a panorama.");
  sky_->setToolTip(lit ? "Behind the subject, in Lit, Radiance and Base colour"
                       : "There is no panorama to show: choose or open one.");
}

}  // namespace beam
