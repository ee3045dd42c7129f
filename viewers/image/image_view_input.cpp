// SPDX-License-Identifier: Apache-2.0
// Mouse and keys of the image view: those of the other views where they mean the same.
#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>

#include "viewers/image/image_view.h"
#include "viewers/view_keys.h"

namespace beam {
namespace {

constexpr double kWipeReach_px = 8;

}  // namespace

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
    const Picture* p = anyPicture();
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
  const Picture* p = anyPicture();
  if (p == nullptr) return;
  const QRectF before = pictureRect();
  const double zoom_before = before.width() / p->values.width;
  const double zoom_after = std::clamp(zoom_before * std::pow(1.2, wheelSteps(*event)), 0.05, 64.0);
  const QPointF under = (event->position() - before.topLeft()) / zoom_before;
  zoom_ = zoom_after;
  // The pixel under the hand stays there.
  center_ = under + (QPointF(width() / 2.0, height() / 2.0) - event->position()) / zoom_after;
  update();
}

void ImageView::reportHover(QPointF position) {
  const bool second = peek_ || !sides_[0].picture || (showsWipe() && position.x() >= wipe_share_ * width());
  const bool apart = showsDifference();
  const Picture* p = apart ? &compared_.difference->map : sides_[second ? 1 : 0].picture.get();
  const QRectF target = pictureRect();
  if (p == nullptr || !target.contains(position)) {
    Q_EMIT hovered({});
    return;
  }
  const auto pixel = [&](double share, int size) {
    return std::clamp(static_cast<int>(share * size), 0, size - 1);
  };
  const int x = pixel((position.x() - target.left()) / target.width(), p->values.width);
  const int y = pixel((position.y() - target.top()) / target.height(), p->values.height);
  Q_EMIT hovered(QString("%1  x %2  y %3   %4")
                     .arg(apart    ? "|A − B|"
                          : second ? "B"
                                   : "A")
                     .arg(x)
                     .arg(y)
                     .arg(QString::fromStdString(describePixel(*p, x, y))));
}

bool ImageView::handleKey(const QKeyEvent& event) {
  if (event.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) return false;
  const bool shift = (event.modifiers() & Qt::ShiftModifier) != 0;
  switch (event.key()) {
    case Qt::Key_W:
      setWipe(!wipe_on_);
      return true;
    case Qt::Key_D:
      setDifference(!difference_on_);
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
    setPeek(true);
  } else if (!handleKey(*event)) {
    PictureCanvas::keyPressEvent(event);
  }
}

void ImageView::keyReleaseEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Shift) setPeek(false);
  PictureCanvas::keyReleaseEvent(event);
}

// The key may be let go elsewhere.
void ImageView::focusOutEvent(QFocusEvent* event) {
  setPeek(false);
  PictureCanvas::focusOutEvent(event);
}

void ImageView::setPeek(bool on) {
  if (peek_ == on) return;
  peek_ = on;
  arrange();
}

}  // namespace beam
