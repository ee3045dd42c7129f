// SPDX-License-Identifier: Apache-2.0
#include "viewers/image/image_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

constexpr double kWipeReach_px = 8;
constexpr double kCrispFrom = 2;  // zoom at which pixels become squares
constexpr int kWheelUnits = 120;

// Same limits on both sides, so that colours compare: those of `other` where it has some of the same unit.
Limits limitsFor(const Picture& own, const Picture* other) {
  const bool common = other != nullptr && other->false_color && other->unit == own.unit;
  return own.unit.empty() ? Limits{} : robustLimits((common ? *other : own).values.values);
}

}  // namespace

ImageView::ImageView(QWidget* parent) : PictureCanvas(parent) {}
ImageView::~ImageView() = default;

void ImageView::setPicture(int side, const QString& label, PictureLoader loader) {
  sides_[side].label = label;
  sides_[side].note.clear();
  sides_[side].loader = std::move(loader);
  sides_[side].picture = nullptr;
  PictureCanvas::setPicture(side, nullptr);
  refresh(side);
}

ImageView::Answer ImageView::answerOf(const PictureLoader& loader, std::shared_ptr<const Picture> loaded,
                                      const std::shared_ptr<const Picture>& other, float exposure_stops) {
  Answer answer;
  try {
    answer.picture = loaded ? std::move(loaded) : std::make_shared<const Picture>(loader());
    const Limits limits = limitsFor(*answer.picture, other.get());
    answer.pixels = std::make_shared<Image<u8vec4>>(displayed(*answer.picture, exposure_stops, limits));
  } catch (const std::exception& e) {  // the border of this thread: said in the view
    answer.note = QString::fromStdString(e.what());
  }
  return answer;
}

void ImageView::refresh(int side) {
  Side& s = sides_[side];
  const std::uint64_t ticket = ++s.ticket;
  if (!s.loader) {
    s.seen = ticket;
    update();
    return;
  }
  const std::shared_ptr<const Picture> other = side == 1 ? sides_[0].picture : nullptr;
  workers_[side].submit(
      [this, side, ticket, other, loader = s.loader, loaded = s.picture, exposure = exposure_stops_] {
        const Answer answer = answerOf(loader, loaded, other, exposure);
        QMetaObject::invokeMethod(
            this, [this, side, ticket, answer] { take(side, ticket, answer); }, Qt::QueuedConnection);
      });
}

void ImageView::take(int side, std::uint64_t ticket, const Answer& answer) {
  Side& s = sides_[side];
  if (s.ticket != ticket) return;
  s.seen = ticket;
  s.picture = answer.picture;
  s.note = answer.note;
  PictureCanvas::setPicture(side, answer.pixels);
  Q_EMIT pictureShown();
}

bool ImageView::settled() const {
  return std::all_of(sides_.begin(), sides_.end(), [](const Side& s) { return s.seen == s.ticket; });
}

void ImageView::setWipe(bool on) {
  if (wipe_on_ == on) return;
  wipe_on_ = on;
  update();
  Q_EMIT wipeChanged(on);
}

void ImageView::setExposure(float stops) {
  exposure_stops_ = std::clamp(stops, -10.0f, 10.0f);
  refresh(0);
  refresh(1);
}

void ImageView::fit() {
  zoom_ = 0;
  update();
}

void ImageView::swapSides() {
  std::swap(sides_[0].label, sides_[1].label);
  std::swap(sides_[0].loader, sides_[1].loader);
  std::swap(sides_[0].picture, sides_[1].picture);
  std::swap(sides_[0].note, sides_[1].note);
  refresh(0);
  refresh(1);
  Q_EMIT sidesSwapped();
}

QRectF ImageView::pictureRect() const {
  const Picture* p = sides_[0].picture ? sides_[0].picture.get() : sides_[1].picture.get();
  if (p == nullptr) return {};
  const double w = p->values.width, h = p->values.height;
  if (zoom_ == 0) {
    const double scale = std::min((width() - 24) / w, (height() - 24) / h);
    return {QPointF((width() - scale * w) / 2, (height() - scale * h) / 2), QSizeF(scale * w, scale * h)};
  }
  return {QPointF(width() / 2.0 - zoom_ * center_.x(), height() / 2.0 - zoom_ * center_.y()),
          QSizeF(zoom_ * w, zoom_ * h)};
}

PictureLayout ImageView::pictureLayout() const {
  PictureLayout layout;
  const QRectF target = pictureRect();
  layout.target = {target, target};
  const Picture* p = sides_[0].picture ? sides_[0].picture.get() : sides_[1].picture.get();
  layout.crisp = p != nullptr && target.width() >= kCrispFrom * p->values.width;
  if (peek_ || !sides_[0].picture) {
    layout.over_opacity = 1;
  } else if (showsWipe()) {
    layout.wipe_x = wipe_share_ * width();
  }
  return layout;
}

void ImageView::paintOver(QPainter& painter) {
  const bool nothing = !sides_[0].picture && !sides_[1].picture;
  const QString note = !sides_[0].note.isEmpty() ? sides_[0].note : sides_[1].note;
  if (nothing && note.isEmpty()) {
    paintMessage(painter, rect(), !settled() ? "Reading" : "No picture chosen",
                 !settled() ? sides_[0].label : QString("Choose a camera and a picture above."));
    return;
  }
  if (nothing) {
    paintMessage(painter, rect().adjusted(60, 0, -60, 0), "This picture cannot be shown", note);
    return;
  }
  if (showsWipe() && !peek_) {
    const double x = wipe_share_ * width();
    painter.setPen(QPen(QColor(255, 255, 255, 210), 1.5));
    painter.drawLine(QPointF(x, 0), QPointF(x, height()));
    painter.setBrush(QColor(255, 255, 255, 230));
    painter.setPen(Qt::NoPen);
    painter.drawEllipse(QPointF(x, height() / 2.0), 6, 6);
  }
  paintSideLabels(painter);
  paintLegend(painter);
  paintLabel(painter, {10, height() - 10.0}, Qt::AlignLeft | Qt::AlignBottom, note);
}

void ImageView::paintSideLabels(QPainter& painter) const {
  const auto words = [&](int side) {
    const Side& s = sides_[side];
    QString text = s.picture ? QString::fromStdString(s.picture->label) : s.label;
    if (exposure_stops_ != 0) text += QString::asprintf(" · exposure %+.1f", exposure_stops_);
    return text;
  };
  if (showsWipe() && !peek_) {
    const double x = wipe_share_ * width();
    paintLabel(painter, {x - 10, 10}, Qt::AlignRight | Qt::AlignTop, "A  " + words(0));
    paintLabel(painter, {x + 10, 10}, Qt::AlignLeft | Qt::AlignTop, "B  " + words(1));
  } else {
    const int side = peek_ || !sides_[0].picture ? 1 : 0;
    paintLabel(painter, {10, 10}, Qt::AlignLeft | Qt::AlignTop, (side == 0 ? "A  " : "B  ") + words(side));
  }
}

void ImageView::paintLegend(QPainter& painter) const {
  const Picture* p = nullptr;
  for (const Side& s : sides_) {
    if (p == nullptr && s.picture && s.picture->false_color) p = s.picture.get();
  }
  if (p == nullptr) return;
  paintScale(painter, {width() - 18.0, 14}, limitsFor(*p, sides_[0].picture.get()),
             QString::fromStdString(p->unit));
}

bool ImageView::nearWipe(QPointF position) const {
  return showsWipe() && std::abs(position.x() - wipe_share_ * width()) < kWipeReach_px;
}

void ImageView::mousePressEvent(QMouseEvent* event) {
  setFocus();
  last_mouse_ = event->localPos();
  drag_ = event->button() == Qt::LeftButton && nearWipe(last_mouse_) ? Drag::Wipe : Drag::Pan;
}

void ImageView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF position = event->localPos(), move = position - last_mouse_;
  last_mouse_ = position;
  if (drag_ == Drag::Wipe) {
    wipe_share_ = std::clamp(position.x() / width(), 0.0, 1.0);
    update();
  } else if (drag_ == Drag::Pan) {
    const QRectF target = pictureRect();
    const Picture* p = sides_[0].picture ? sides_[0].picture.get() : sides_[1].picture.get();
    if (p == nullptr) return;
    zoom_ = target.width() / p->values.width;
    center_ = (rect().center() - target.topLeft() - move) / zoom_;
    update();
  }
  setCursor(nearWipe(position) || drag_ == Drag::Wipe ? Qt::SplitHCursor : Qt::ArrowCursor);
  reportHover(position);
}

void ImageView::mouseReleaseEvent(QMouseEvent*) { drag_ = Drag::None; }
void ImageView::mouseDoubleClickEvent(QMouseEvent*) { fit(); }
void ImageView::leaveEvent(QEvent*) { Q_EMIT hovered({}); }

void ImageView::wheelEvent(QWheelEvent* event) {
  const Picture* p = sides_[0].picture ? sides_[0].picture.get() : sides_[1].picture.get();
  if (p == nullptr) return;
  const QRectF before = pictureRect();
  const double zoom_before = before.width() / p->values.width;
  const double zoom_after =
      std::clamp(zoom_before * std::pow(1.2, event->angleDelta().y() / double(kWheelUnits)), 0.05, 64.0);
  const QPointF under = (event->position() - before.topLeft()) / zoom_before;
  zoom_ = zoom_after;
  // The pixel under the hand stays there.
  center_ = under + (QPointF(width() / 2.0, height() / 2.0) - event->position()) / zoom_after;
  update();
}

void ImageView::reportHover(QPointF position) {
  const bool second = peek_ || !sides_[0].picture || (showsWipe() && position.x() >= wipe_share_ * width());
  const Side& s = sides_[second ? 1 : 0];
  const QRectF target = pictureRect();
  if (!s.picture || !target.contains(position)) {
    Q_EMIT hovered({});
    return;
  }
  const auto pixel = [&](double share, int size) {
    return std::clamp(static_cast<int>(share * size), 0, size - 1);
  };
  const int x = pixel((position.x() - target.left()) / target.width(), s.picture->values.width);
  const int y = pixel((position.y() - target.top()) / target.height(), s.picture->values.height);
  Q_EMIT hovered(QString("%1  x %2  y %3   %4")
                     .arg(second ? "B" : "A")
                     .arg(x)
                     .arg(y)
                     .arg(QString::fromStdString(describePixel(*s.picture, x, y))));
}

bool ImageView::handleKey(const QKeyEvent& event) {
  if (event.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) return false;
  const bool shift = (event.modifiers() & Qt::ShiftModifier) != 0;
  switch (event.key()) {
    case Qt::Key_W:
      setWipe(!wipe_on_);
      return true;
    case Qt::Key_T:
      swapSides();
      return true;
    case Qt::Key_E:
      setExposure(exposure_stops_ + (shift ? -0.5f : 0.5f));
      return true;
    case Qt::Key_R:
      setExposure(0);
      return true;
    case Qt::Key_F:
    case Qt::Key_H:
      fit();
      return true;
    default:
      return false;
  }
}

void ImageView::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Shift && sides_[1].picture) {
    peek_ = true;
    update();
  } else if (!handleKey(*event)) {
    PictureCanvas::keyPressEvent(event);
  }
}

void ImageView::keyReleaseEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Shift) {
    peek_ = false;
    update();
  }
  PictureCanvas::keyReleaseEvent(event);
}

}  // namespace beam
