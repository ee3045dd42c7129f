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

#include <algorithm>
#include <cmath>

#include "ui/quiet_combo.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

constexpr float kDegrees = 180 / kPi;
constexpr float kStopsPerTick = 0.25f;

// By view.
const char* const kHands[] = {
    "Left drag orbits, middle drag pans, the wheel zooms to the pointer, a double-click sets the point to "
    "circle.\n"
    "F frames the subject, H goes home. 1, 3 and 7 of the number pad look from the front, the right and the "
    "top, with Ctrl from the other side.\n"
    "Shift and right drag turn the light. E and Shift+E change the exposure, R resets it.\n"
    "[ and ] look through the cameras, Esc leaves; the wheel then fades the photograph.",
    "A drag moves the picture, the wheel zooms to the pointer, F or a double-click fits it into the view.\n"
    "W wipes between A and B: drag the line. D shows their difference, T swaps them, and while Shift is held "
    "B is seen alone.\n"
    "E and Shift+E change the exposure of photographs and renders, R resets it.",
    "Left drag orbits, middle drag pans, the wheel zooms to the pointer, a double-click sets the point to "
    "circle.\n"
    "A press marks a camera, a double-click looks through it, and so do [ and ]; Esc leaves.\n"
    "F frames the subject, H goes home. 1, 3 and 7 of the number pad look from the front, the right and the "
    "top, with Ctrl from the other side.\n"
    "K, G and J show and hide cameras, grid and joints."};

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

// `why_not`: why it cannot be used; empty: it can.
void allow(QWidget& widget, const QString& why_not, const QString& tip) {
  widget.setEnabled(why_not.isEmpty());
  widget.setToolTip(why_not.isEmpty() ? tip : why_not);
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
      hands_(new QLabel(kHands[0])),
      sky_(new QCheckBox("Show panorama")),
      lock_depth_(new QCheckBox("Lock depth limits")),
      open_(new QPushButton("Open panorama…")) {
  for (const ChannelInfo& channel : shownChannels())
    channel_->addItem(QString("%1   %2").arg(channel.key).arg(QString::fromStdString(channel.title)));
  makeRows();
  connectParts();
  mirror(view_.state());
  fillLights();
}

void DisplayPanel::makeRows() {
  hands_->setObjectName("quiet");
  hands_->setWordWrap(true);
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
  rows->addWidget(hands_);
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
          [this](int i) { view_.setChannel(shownChannels()[static_cast<std::size_t>(i)]); });
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
  const auto& all = shownChannels();
  channel_->setCurrentIndex(static_cast<int>(std::find(all.begin(), all.end(), state.channel) - all.begin()));
  yaw_->setValue(static_cast<int>(std::lround(state.yaw_rad * kDegrees)));
  exposure_->setValue(static_cast<int>(std::lround(state.exposure_stops / kStopsPerTick)));
  photo_->setValue(static_cast<int>(std::lround(100 * state.photo_opacity)));
  const QString not_used = notUsed();
  channel_->setEnabled(not_used.isEmpty());
  channel_->setHelp(not_used.isEmpty() ? QString("What is shown of the Gaussians (1 to 7)") : not_used);
  allow(*exposure_, shown_ == StudioView::Scene ? not_used : QString(),
        "Of light and photographs (E, Shift+E; R resets it)");
  allow(*photo_,
        !not_used.isEmpty() ? not_used
        : state.look_through
            ? QString()
            : QString("Look through a camera first ([ and ]): its photograph is laid over the render."),
        "How much of the photograph lies over the render");
  sky_->setChecked(state.sky);
  const bool depth = state.channel.id == kDepthChannel;
  lock_depth_->setChecked(state.depth_limits.has_value());
  allow(*lock_depth_,
        !not_used.isEmpty() ? not_used
        : depth             ? QString()
                            : QString("Choose the channel Depth first: its colours have limits to keep."),
        "Keep these limits of the colours while camera and frame change");
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
  light_->setPlaceholderText(names.isEmpty() ? "none" : "none chosen");
  allowLights();
}

void DisplayPanel::allowLights() {
  const QString not_used = notUsed(), unlit = shown_ == StudioView::Scene ? not_used : QString();
  const bool any = light_->count() > 0, lit = lights_.light() != nullptr || lights_.reading();
  light_->setEnabled(any && unlit.isEmpty());
  light_->setHelp(!unlit.isEmpty()    ? unlit
                  : !any              ? "There is no panorama yet: open one below."
                  : lights_.reading() ? "reading the light"
                                      : "The panorama that lights the subject");
  allow(*yaw_,
        !unlit.isEmpty() ? unlit
        : lit            ? QString()
                         : QString("There is no light to turn: choose or open a panorama."),
        "Turns the panorama about the vertical");
  allow(*sky_,
        !not_used.isEmpty() ? not_used
        : lit               ? QString()
                            : QString("There is no panorama to show: choose or open one."),
        "Behind the subject, in Relit, Colour and Base colour");
}

QString DisplayPanel::notUsed() const {
  switch (shown_) {
    case StudioView::Splat:
      break;
    case StudioView::Image:
      return "The view Images shows what A and B above it choose.";
    case StudioView::Scene:
      return "The view Scene shows where things are, in colours of its own.";
  }
  return {};
}

void DisplayPanel::setShown(StudioView shown) {
  shown_ = shown;
  hands_->setText(kHands[static_cast<int>(shown)]);
  mirror(view_.state());
  allowLights();
}

}  // namespace beam
