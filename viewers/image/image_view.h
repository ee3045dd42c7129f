// SPDX-License-Identifier: Apache-2.0
// The image view: one picture, or two under a wipe that the hand moves. Reading and encoding happen on
// background threads; zoom, pan and wipe are the graphics device's.
#pragma once

#include "viewers/gl/picture_canvas.h"
#include "viewers/image/picture.h"
#include "viewers/latest_worker.h"

class QKeyEvent;

namespace beam {

class ImageView final : public PictureCanvas {
  Q_OBJECT

 public:
  explicit ImageView(QWidget* parent = nullptr);
  ~ImageView() override;

  // `side` 0 = A, 1 = B. An empty loader takes the picture away. `label` is shown until the picture brings
  // its own.
  void setPicture(int side, const QString& label, PictureLoader loader);
  void setWipe(bool on);
  bool wipe() const { return wipe_on_; }
  void setExposure(float stops);
  float exposure() const { return exposure_stops_; }
  void fit();
  void swapSides();

  bool handleKey(const QKeyEvent& event);
  bool settled() const;

 Q_SIGNALS:
  void hovered(const QString& reading);
  void wipeChanged(bool on);
  void sidesSwapped();
  void pictureShown();

 protected:
  PictureLayout pictureLayout() const override;
  void paintOver(QPainter& painter) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;

 private:
  struct Side {
    QString label, note;
    std::shared_ptr<const Picture> picture;
    PictureLoader loader;
    std::uint64_t ticket = 0, seen = 0;  // asked for last, answered last
  };
  struct Answer {
    std::shared_ptr<const Picture> picture;
    SharedPicture pixels;
    QString note;
  };
  static Answer answerOf(const PictureLoader& loader, std::shared_ptr<const Picture> loaded,
                         const std::shared_ptr<const Picture>& other, float exposure_stops);
  void take(int side, std::uint64_t ticket, const Answer& answer);
  void refresh(int side);
  bool showsWipe() const { return wipe_on_ && sides_[0].picture && sides_[1].picture; }
  bool nearWipe(QPointF position) const;
  QRectF pictureRect() const;
  void reportHover(QPointF position);
  void paintSideLabels(QPainter& painter) const;
  void paintLegend(QPainter& painter) const;

  std::array<Side, 2> sides_;
  float exposure_stops_ = 0;
  bool wipe_on_ = false;
  double wipe_share_ = 0.5;  // of the widget's width
  bool peek_ = false;        // Shift held: B instead of A
  double zoom_ = 0;          // widget pixels a picture pixel; 0: fitted
  QPointF center_;           // picture position (pixels) at the widget's centre; of the zoomed view
  enum class Drag { None, Pan, Wipe } drag_ = Drag::None;
  QPointF last_mouse_;
  std::array<LatestWorker, 2> workers_;  // last: they stop first
};

}  // namespace beam
