// SPDX-License-Identifier: Apache-2.0
#include "viewers/splat/splat_view.h"

#include <QPainter>

#include <algorithm>
#include <cmath>

#include "viewers/encode.h"
#include "viewers/splat/channel_painter.h"

namespace beam {
namespace {

constexpr int kRest_ms = 160;            // without movement before the full picture
constexpr double kMovingBudget_ms = 45;  // a coarse picture should take no longer
constexpr int kCoarsest = 4;

SharedPicture pictureOf(const Image<u8vec3>& photo) {
  auto picture = std::make_shared<Image<u8vec4>>(photo.width, photo.height);
  std::transform(photo.pixels.begin(), photo.pixels.end(), picture->pixels.begin(),
                 [](u8vec3 c) { return u8vec4(c, 255); });
  return picture;
}

}  // namespace

Bounds boundsOf(const std::vector<vec3>& positions_m) {
  if (positions_m.empty()) return {};
  Bounds bounds;
  std::vector<float> values(positions_m.size());
  const auto quantile = [&](double share) {
    const auto nth =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = positions_m[i][axis];
    bounds.center_m[axis] = 0.5f * (quantile(0.02) + quantile(0.98));
  }
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = glm::distance(positions_m[i], bounds.center_m);
  bounds.radius_m = std::max(1.1f * quantile(0.98), 1e-3f);
  return bounds;
}

SplatView::SplatView(SceneRendererFactory new_renderer, QWidget* parent)
    : PictureCanvas(parent),
      new_renderer_(std::move(new_renderer)),
      renderer_(std::make_shared<SplatRenderer>(new_renderer_())) {
  rest_timer_.setSingleShot(true);
  rest_timer_.setInterval(kRest_ms);
  connect(&rest_timer_, &QTimer::timeout, this, [this] { request(1); });
}

SplatView::~SplatView() { leaveContext(); }

void SplatView::initializeGL() {
  PictureCanvas::initializeGL();
  newContext();
}

void SplatView::setScene(std::vector<RenderInstance> instances, const QString& caption) {
  std::erase_if(instances, [](const RenderInstance& i) { return !i.cloud || i.cloud->size() == 0; });
  scene_.instances = std::move(instances);
  caption_ = caption;
  if (!hasScene()) {
    shown_ = {};
    read_back_.clear();
    shown_ticket_ = ++newest_ticket_;
    setPicture(0, nullptr);
    return;
  }
  if (!framed_) turnHome();
  framed_ = true;
  if (passing_ == 0) return changed(Pace::Resting);
  request(passing_);
  update();
}

void SplatView::setPassing(int divisor) {
  const bool rests = passing_ > 0 && divisor == 0;
  passing_ = divisor;
  if (passing_ == 0) half_milliseconds_ = 0;
  if (rests) changed(Pace::Resting);
}

void SplatView::setCapture(std::shared_ptr<const CaptureSet> capture, FrameIndex frame) {
  const bool same = capture == capture_;
  if (same && frame.value == frame_.value) return;
  capture_ = std::move(capture);
  frame_ = frame;
  dropPhoto();  // of another frame
  if (same) return loadPhoto();
  framed_ = false;
  lookThrough(std::nullopt);
}

void SplatView::setLight(std::shared_ptr<const Environment> light, const QString& name, bool reading) {
  light_being_read_ = reading && !light ? name : QString();
  update();
  if (!light_being_read_.isEmpty() && scene_.environment) return;
  const bool same = light == scene_.environment;
  scene_.environment = std::move(light);
  light_name_ = name;
  if (!same) changed(Pace::Resting);
}

void SplatView::setLighting(const Lighting& lighting) {
  if (lighting == scene_.lighting) return;
  scene_.lighting = lighting;
  changed(Pace::Resting);
}

void SplatView::resetState() {
  state_ = {};
  keep_photo_opacity_ = false;
  framed_ = hasScene();
  scene_.environment = nullptr;
  light_name_.clear();
  light_being_read_.clear();
  dropPhoto();
  setBadge({});
  turnHome();
  changed(Pace::Resting);
}

void SplatView::setState(const ViewState& state) {
  const bool other_camera = state.look_through != state_.look_through;
  state_ = state;
  framed_ = true;
  if (other_camera) loadPhoto();
  changed(Pace::Resting);
}

void SplatView::setChannel(const ChannelInfo& channel) {
  state_.channel = channel;
  changed(Pace::Resting);
}

void SplatView::setExposure(float stops) {
  state_.exposure_stops = std::clamp(stops, -10.0f, 10.0f);
  changed(Pace::Moving);
}

void SplatView::setYaw(float yaw_rad) {
  state_.yaw_rad = std::remainder(yaw_rad, 2 * kPi);
  changed(Pace::Moving);
}

void SplatView::setSky(bool shown) {
  state_.sky = shown;
  changed(Pace::Resting);
}

void SplatView::setPhotoOpacity(float opacity) {
  state_.photo_opacity = std::clamp(opacity, 0.0f, 1.0f);
  keep_photo_opacity_ = true;
  update();
  Q_EMIT stateChanged(state_);
}

void SplatView::lockDepth(bool on) {
  if (on && shown_.channel.id == kDepthChannel && hasShown()) state_.depth_limits = shown_.limits;
  if (!on) state_.depth_limits.reset();
  changed(Pace::Resting);
}

void SplatView::lookThrough(std::optional<ViewIndex> view) {
  if (view && !capture_) return;
  state_.look_through = view;
  if (view && !keep_photo_opacity_) state_.photo_opacity = 0.5f;
  loadPhoto();
  changed(Pace::Resting);
}

void SplatView::leaveCamera() {
  if (!state_.look_through) return;
  const Camera& camera = capture_->views[state_.look_through->value].camera;
  const Bounds bounds = sceneBounds();
  const dvec3 to_center = camera.camera_from_world * dvec3(bounds.center_m);
  state_.orbit = orbitOf(camera, std::max(static_cast<float>(to_center.z), 0.1f));
  lookThrough(std::nullopt);
}

Bounds SplatView::sceneBounds() const {
  std::vector<vec3> positions;
  for (const RenderInstance& instance : scene_.instances) {
    for (const vec3& p : instance.cloud->position_m)
      positions.emplace_back(instance.world_from_cloud * dvec3(p));
  }
  if (!positions.empty()) return boundsOf(positions);
  return capture_ ? boundsOf(capture_->seed_points.position_m) : Bounds{};
}

void SplatView::turnHome() {
  const float field_of_view = state_.orbit.field_of_view_rad;
  state_.orbit = OrbitCamera{};
  if (capture_ && !capture_->views.empty()) {
    state_.orbit = orbitOf(capture_->views.front().camera, 1);
    state_.orbit.elevation_rad = std::clamp(state_.orbit.elevation_rad, -0.2f, 0.3f);
  }
  state_.orbit.field_of_view_rad = field_of_view;
  state_.orbit.frame(sceneBounds());
}

void SplatView::goHome() {
  turnHome();
  lookThrough(std::nullopt);
}

void SplatView::frameSubject() {
  leaveCamera();
  state_.orbit.frame(sceneBounds());
  changed(Pace::Resting);
}

void SplatView::setPreset(ViewPreset preset) {
  leaveCamera();
  state_.orbit.turnTo(preset);
  changed(Pace::Resting);
}

void SplatView::changed(Pace pace) {
  if (pace == Pace::Moving) {
    const double factor = std::sqrt(full_milliseconds_ / kMovingBudget_ms);
    request(std::clamp(static_cast<int>(std::ceil(factor)), 1, kCoarsest));
    rest_timer_.start();
  } else {
    request(1);
  }
  Q_EMIT stateChanged(state_);
  update();
}

Camera SplatView::cameraFor(int width_px, int height_px) const {
  if (state_.look_through && capture_) {
    return fittedTo(capture_->views[state_.look_through->value].camera, width_px, height_px);
  }
  return state_.orbit.camera(width_px, height_px);
}

void SplatView::dropPhoto() {
  photo_of_.reset();
  ++photo_ticket_;
  photo_note_.clear();
  setPicture(1, nullptr);
}

void SplatView::loadPhoto() {
  if (state_.look_through == photo_of_) return;
  dropPhoto();
  photo_of_ = state_.look_through;
  if (!photo_of_ || !capture_ || !capture_->source) return;
  if (!capture_->source->has(*photo_of_, frame_)) {
    photo_note_ = QString("camera %1 has no photograph of frame %2: only the render is shown")
                      .arg(QString::fromStdString(capture_->views[photo_of_->value].name),
                           QString::fromStdString(capture_->frames[frame_.value]));
    return;
  }
  photo_worker_.submit([this, capture = capture_, view = *photo_of_, frame = frame_, ticket = photo_ticket_] {
    SharedPicture picture;
    QString note;
    try {
      picture = pictureOf(capture->source->photo(view, frame));
    } catch (const std::exception& e) {
      note = QString::fromStdString(e.what());
    }
    QMetaObject::invokeMethod(
        this,
        [this, picture, note, ticket] {
          if (ticket != photo_ticket_) return;
          photo_note_ = note;
          setPicture(1, picture);
        },
        Qt::QueuedConnection);
  });
}

QRectF SplatView::photoFrame() const {
  const Camera& camera = capture_->views[state_.look_through->value].camera;
  const double scale =
      std::min(static_cast<double>(width()) / camera.width, static_cast<double>(height()) / camera.height);
  const QSizeF size(scale * camera.width, scale * camera.height);
  return {QPointF((width() - size.width()) / 2, (height() - size.height()) / 2), size};
}

PictureLayout SplatView::pictureLayout() const {
  PictureLayout layout;
  layout.target[0] = rect();
  if (state_.look_through && capture_) {
    layout.target[1] = photoFrame();
    layout.over_opacity = state_.photo_opacity;
  }
  return layout;
}

QString lightWords(const QString& name, float yaw_rad) {
  return QString("light %1 turned %2°").arg(name).arg(std::lround(yaw_rad * 180 / kPi));
}

QString SplatView::title() const {
  const ChannelInfo& channel = shown_.channel;
  QStringList parts{QString::fromStdString(channel.title), QString::fromStdString(channel.legend)};
  if (channel.id == kRelightChannel && !light_name_.isEmpty()) {
    parts << lightWords(light_name_, state_.yaw_rad);
  }
  if (state_.look_through && capture_) {
    const View& view = capture_->views[state_.look_through->value];
    parts << QString("camera %1 (%2)")
                 .arg(QString::fromStdString(view.name), view.split == Split::Test ? "test" : "train");
    if (state_.photo_opacity > 0 && hasPicture(1)) {
      parts << QString("photograph over it %1 %").arg(std::lround(100 * state_.photo_opacity));
    }
  } else {
    parts << "free camera";
  }
  if (const QString& caption = hasShown() ? shown_caption_ : caption_; !caption.isEmpty()) parts << caption;
  if (state_.exposure_stops != 0) parts << QString::asprintf("exposure %+.2f stops", state_.exposure_stops);
  return parts.join(" · ");
}

QString SplatView::lackText() const {
  const bool replaced = shown_.channel.id != shown_.wanted.id;
  const QString then =
      replaced ? QString("; %1 is shown").arg(QString::fromStdString(shown_.channel.title).toLower()) : "";
  const QString wanted = QString::fromStdString(shown_.wanted.title);
  switch (shown_.lack) {
    case Lack::None:
      return {};
    case Lack::Light:
      if (!light_being_read_.isEmpty()) return "reading the light" + then;
      return "No light chosen" + then + ". Choose or open a panorama under Display.";
    case Lack::Materials:
      return wanted + " needs materials, which are not solved yet" + then + ". Run until Materials.";
    case Lack::Attribute:
      return wanted + " is not in these Gaussians" + then + ".";
  }
  return {};
}

QString SplatView::noteText() const {
  QStringList notes;
  if (!shown_.error.empty()) notes << QString::fromStdString(shown_.error);
  if (!photo_note_.isEmpty()) notes << photo_note_;
  const QString lack = lackText();
  if (!lack.isEmpty()) notes << lack;
  for (const std::string& sentence : shown_.left_out) notes << QString::fromStdString(sentence);
  const bool waits = (state_.channel.id == kRelightChannel || state_.sky) && !light_being_read_.isEmpty();
  if (lack.isEmpty() && waits) notes << "reading the light " + light_being_read_;
  return notes.join("\n");
}

void SplatView::paintOver(QPainter& painter) {
  if (!hasScene()) {
    if (!capture_) {
      paintMessage(painter, rect(), "Drop a capture folder here, or open the sample",
                   "File > Open capture, File > Open project and File > Open sample do the same.");
    } else {
      paintMessage(painter, rect(), "No Gaussians yet", "Press Run to compute them from the photographs.");
    }
    paintBadge(painter, 0, 0, width());
    return;
  }
  if (state_.look_through && capture_) {
    painter.setPen(QPen(QColor(255, 255, 255, 90), 1));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(photoFrame().adjusted(0.5, 0.5, -0.5, -0.5));
  }
  paintWords(painter, title(), noteText());
  if (hasShown() && shown_.lack == Lack::None && shown_.channel.false_color)
    paintLegend(painter, shown_.limits, QString::fromStdString(shown_.channel.unit));
}

void SplatView::resizeGL(int, int) { changed(Pace::Moving); }

}  // namespace beam
