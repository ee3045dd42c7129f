// SPDX-License-Identifier: Apache-2.0
#include "viewers/gl/picture_canvas.h"

#include <QFontInfo>
#include <QOpenGLPaintDevice>
#include <QPainter>

namespace beam {
namespace {

constexpr float kBackdrop[3] = {27 / 255.0f, 28 / 255.0f, 30 / 255.0f};

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
  pictures_[layer] = std::move(picture);
  stale_[layer] = true;
  update();
}

void PictureCanvas::initializeGL() {
  quads_ = std::make_unique<QuadPainter>();
  stale_.fill(true);
}

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
  if (pictures_[0]) quads_->draw(textures_[0], scaled(layout.target[0]), framebuffer, style);
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
  paintOver(painter);
}

QRectF paintLabel(QPainter& painter, QPointF at, Qt::Alignment alignment, const QString& text) {
  if (text.isEmpty()) return {};
  const QRectF words = painter.fontMetrics().boundingRect(QRect(0, 0, 2000, 1000), Qt::AlignLeft, text);
  QRectF box(at, words.size() + QSizeF(16, 8));
  if (alignment & Qt::AlignRight) box.moveRight(at.x());
  if (alignment & Qt::AlignHCenter) box.moveLeft(at.x() - box.width() / 2);
  if (alignment & Qt::AlignBottom) box.moveBottom(at.y());
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(16, 17, 19, 200));
  painter.drawRoundedRect(box, 4, 4);
  painter.setPen(QColor(226, 228, 232));
  painter.drawText(box, Qt::AlignCenter, text);
  return box;
}

void paintScale(QPainter& painter, QPointF at, const Limits& limits, const QString& unit) {
  constexpr double kWidth = 14, kHeight = 180, kWords = 84;
  constexpr int kTicks = 4;
  const QRectF bar(at.x() - kWidth, at.y() + 10, kWidth, kHeight);
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(16, 17, 19, 200));
  painter.drawRoundedRect(bar.adjusted(-kWords, -14, 8, 14), 4, 4);
  for (int y = 0; y < static_cast<int>(kHeight); ++y) {
    const u8vec3 c = falseColor(1 - static_cast<float>(y) / static_cast<float>(kHeight));
    painter.fillRect(QRectF(bar.left(), bar.top() + y, kWidth, 1.2), QColor(c.x, c.y, c.z));
  }
  painter.setPen(QColor(206, 210, 216));
  for (int tick = 0; tick <= kTicks; ++tick) {
    const float value = limits.high - static_cast<float>(tick) / kTicks * (limits.high - limits.low);
    const QRectF where(bar.left() - kWords, bar.top() + kHeight * tick / kTicks - 9, kWords - 8, 18);
    painter.drawText(where, Qt::AlignRight | Qt::AlignVCenter, QString::asprintf("%.2f ", value) + unit);
  }
}

void paintMessage(QPainter& painter, const QRectF& area, const QString& title, const QString& body) {
  QFont font = painter.font();
  const QFont plain = font;
  font.setPixelSize(QFontInfo(plain).pixelSize() * 3 / 2);
  painter.setFont(font);
  painter.setPen(QColor(206, 210, 216));
  const QRectF upper(area.left(), area.top(), area.width(), area.height() / 2 - 6);
  painter.drawText(upper, Qt::AlignHCenter | Qt::AlignBottom, title);
  painter.setFont(plain);
  painter.setPen(QColor(146, 152, 160));
  const QRectF lower(area.left(), area.center().y() + 6, area.width(), area.height() / 2 - 6);
  painter.drawText(lower, Qt::AlignHCenter | Qt::AlignTop | Qt::TextWordWrap, body);
}

}  // namespace beam
