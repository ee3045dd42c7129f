// SPDX-License-Identifier: Apache-2.0
#include "viewers/gl/picture_canvas.h"
#include "viewers/focus_ring.h"

#include <QOpenGLPaintDevice>
#include <QPainter>

#include <algorithm>

namespace beam {
namespace {

constexpr float kBackdrop[3] = {27 / 255.0f, 28 / 255.0f, 30 / 255.0f};
constexpr double kMargin_px = 10, kGap_px = 6;
constexpr double kLeastColumn_letters = 24, kColumnShare = 0.36;  // of the width

}  // namespace

PictureCanvas::PictureCanvas(QWidget* parent) : QOpenGLWidget(parent) {
  setFormat(surfaceFormat());
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
}

PictureCanvas::~PictureCanvas() {
  if (context() == nullptr) return;
  makeCurrent();
  for (Texture& texture : textures_) texture.release();
  quads_ = nullptr;
  doneCurrent();
}

void PictureCanvas::setPicture(int layer, SharedPicture picture) {
  update();
  if (picture == pictures_[layer]) return;
  pictures_[layer] = std::move(picture);
  stale_[layer] = true;
}

void PictureCanvas::initializeGL() {
  quads_ = std::make_unique<QuadPainter>();
  stale_.fill(true);
}

bool PictureCanvas::paintUnder(const QRectF&, const QSizeF&) { return false; }

void PictureCanvas::paintGL() {
  auto& gl = currentGl();
  gl.glClearColor(kBackdrop[0], kBackdrop[1], kBackdrop[2], 1);
  gl.glClear(GL_COLOR_BUFFER_BIT);
  for (int i = 0; i < 2; ++i) {
    if (!stale_[i]) continue;
    if (pictures_[i]) textures_[i].upload(*pictures_[i]);
    stale_[i] = false;
  }
  const PictureLayout layout = pictureLayout();
  const double ratio = devicePixelRatioF();
  const QSizeF framebuffer(width() * ratio, height() * ratio);
  const auto scaled = [&](const QRectF& r) { return QRectF(r.topLeft() * ratio, r.size() * ratio); };
  QuadStyle style{.opacity = 1, .crisp = layout.crisp};
  if (layout.wipe_x) style.end_column = static_cast<float>(*layout.wipe_x * ratio);
  if (!paintUnder(scaled(layout.target[0]), framebuffer) && pictures_[0])
    quads_->draw(textures_[0], scaled(layout.target[0]), framebuffer, style);
  style = {.opacity = layout.wipe_x ? 1 : layout.over_opacity, .crisp = layout.crisp};
  if (layout.wipe_x) style.first_column = static_cast<float>(*layout.wipe_x * ratio);
  if (pictures_[1] && style.opacity > 0)
    quads_->draw(textures_[1], scaled(layout.target[1]), framebuffer, style);

  // Not QPainter(this): when a parent is grabbed, Qt would send its strokes elsewhere.
  QOpenGLPaintDevice device(framebuffer.toSize());
  device.setDevicePixelRatio(ratio);
  QPainter painter(&device);
  painter.setFont(font());
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setRenderHint(QPainter::TextAntialiasing);
  words_ = {};
  paintOver(painter);
  if (ring_) paintFocusRing(painter, *this);
}

void PictureCanvas::focusInEvent(QFocusEvent* event) {
  QOpenGLWidget::focusInEvent(event);
  ring_ = cameByKey(*event);
  update();
}

void PictureCanvas::focusOutEvent(QFocusEvent* event) {
  QOpenGLWidget::focusOutEvent(event);
  ring_ = false;
  update();
}

void PictureCanvas::setBadge(const QString& badge) {
  if (badge == badge_) return;
  badge_ = badge;
  update();
}

double PictureCanvas::columnWidth() const {
  const double least = kLeastColumn_letters * fontMetrics().averageCharWidth();
  return std::min(width() - 2 * kMargin_px, std::max(least, kColumnShare * width()));
}

void PictureCanvas::paintWords(QPainter& painter, const QString& title, const QString& foot) {
  words_.title = paintLabel(painter, {kMargin_px, kMargin_px}, Qt::AlignLeft | Qt::AlignTop, title,
                            {.width_px = columnWidth()});
  paintBadge(painter, words_.title.bottom(), 0, width());
  paintFoot(painter, foot);
}

void PictureCanvas::paintBadge(QPainter& painter, double top_px, double left_px, double right_px) {
  const double room = std::min(columnWidth(), right_px - left_px - 2 * kMargin_px);
  words_.badge = paintLabel(painter, {left_px + kMargin_px, top_px + kGap_px}, Qt::AlignLeft | Qt::AlignTop,
                            badge_, {.width_px = room, .tone = LabelTone::Warning});
}

void PictureCanvas::paintFoot(QPainter& painter, const QString& foot) {
  words_.foot = paintLabel(painter, {kMargin_px, height() - kMargin_px}, Qt::AlignLeft | Qt::AlignBottom,
                           foot, {.width_px = width() - 2 * kMargin_px});
}

void PictureCanvas::paintLegend(QPainter& painter, const Limits& limits, const QString& unit) {
  const double left = width() - kMargin_px - scaleWidth(painter, limits, unit) - kGap_px;
  double top = kMargin_px, bottom = height() - kMargin_px;
  for (const QRectF& box : {words_.title, words_.badge}) {
    if (box.right() > left) top = std::max(top, box.bottom() + kGap_px);
  }
  if (words_.foot.right() > left) bottom = words_.foot.top() - kGap_px;
  words_.scale =
      paintScale(painter, QRectF(QPointF(left, top), QPointF(width() - kMargin_px, bottom)), limits, unit);
}

}  // namespace beam
