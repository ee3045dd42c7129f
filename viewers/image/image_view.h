// SPDX-License-Identifier: Apache-2.0
// The image view: one picture, two under a wipe that the hand moves, or how far the two are apart. Reading,
// comparing and encoding happen on background threads; zoom, pan and wipe are the graphics device's.
#pragma once

#include <map>

#include "viewers/gl/picture_canvas.h"
#include "viewers/image/difference.h"
#include "viewers/image/picture.h"
#include "viewers/latest_worker.h"

class QKeyEvent;

namespace beam {

// What the false colours in view mean; `shown` false: there are none.
struct LegendState {
  bool shown = false, locked = false;
  Limits limits;
  QString unit;
};

class ImageView final : public PictureCanvas {
  Q_OBJECT

 public:
  explicit ImageView(QWidget* parent = nullptr);
  ~ImageView() override;

  // `side` 0 = A, 1 = B. An empty loader takes the picture away. `label` is shown until the picture brings
  // its own.
  // `badged`: what the badge tells is true of it.
  void setPicture(int side, const QString& label, PictureLoader loader, bool badged = true);
  // Wipe and difference take turns: either takes the other away.
  void setWipe(bool on);
  bool wipe() const { return wipe_on_; }
  void setDifference(bool on);
  bool difference() const { return difference_on_; }
  void setExposure(float stops);
  float exposure() const { return exposure_stops_; }
  void fit();
  void swapSides();
  // Empty, no wipe, no difference, exposure and zoom as at first, limits automatic.
  void resetState();

  LegendState legend() const;
  // Holds the limits of the false colours in view, also over frames and cameras; nothing: automatic again.
  // Each unit has limits of its own, and differences have theirs.
  void lockLimits(std::optional<Limits> limits);
  // The figures of the difference in view, or why there is none.
  QString verdict() const;

  // Why what was asked for on this side cannot be shown; empty: nothing to say.
  const QString& note(int side) const { return sides_[side].note; }

  bool handleKey(const QKeyEvent& event);
  bool settled() const;

 Q_SIGNALS:
  void hovered(const QString& reading);
  void wipeChanged(bool on);
  void differenceChanged(bool on);
  void exposureChanged(float stops);
  void sidesSwapped();
  void legendChanged();
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
  void focusOutEvent(QFocusEvent* event) override;

 private:
  struct Side {
    QString label, note;
    std::shared_ptr<const Picture> picture;
    PictureLoader loader;
    SharedPicture pixels;
    Limits limits;                       // of `pixels`, where these are false colours
    std::uint64_t ticket = 0, seen = 0;  // asked for last, answered last
    bool badged = true;
  };
  struct Answer {
    std::shared_ptr<const Picture> picture;
    SharedPicture pixels;
    Limits limits;
    QString note;
  };
  struct Compared {
    std::array<std::shared_ptr<const Picture>, 2> of;
    std::shared_ptr<const Difference> difference;
    Limits limits;
    SharedPicture pixels;
    QString note;  // why there is no difference
  };
  using Locks = std::map<std::string, Limits>;  // by unit

  static Answer answerOf(const PictureLoader& loader, std::shared_ptr<const Picture> loaded,
                         const std::shared_ptr<const Picture>& other, float exposure_stops,
                         const Locks& locked);
  static Compared comparedOf(Compared known, const Locks& locked);
  void take(int side, std::uint64_t ticket, const Answer& answer);
  void refresh(int side);
  void compare();
  void arrange();
  bool comparing() const { return difference_on_ && sides_[0].picture && sides_[1].picture; }
  // The view is of the difference, which is there or on its way.
  bool apart() const { return comparing() && compared_.note.isEmpty(); }
  bool showsDifference() const { return apart() && !peek_ && compared_.pixels; }
  bool showsWipe() const { return wipe_on_ && sides_[0].picture && sides_[1].picture; }
  void setPeek(bool on);
  bool nearWipe(QPointF position) const;
  const Picture* anyPicture() const;
  const Side* falseColored() const;
  QRectF pictureRect() const;
  void reportHover(QPointF position);
  QString sideText(int side) const;
  QString pairText() const;
  QString footText() const;
  void paintTitles(QPainter& painter);

  std::array<Side, 2> sides_;
  float exposure_stops_ = 0;
  bool wipe_on_ = false, difference_on_ = false;
  Compared compared_;
  std::uint64_t compare_ticket_ = 0, compare_seen_ = 0;
  Locks locked_, locked_differences_;
  double wipe_share_ = 0.5;  // of the widget's width
  bool peek_ = false;        // Shift held: B instead of A
  double zoom_ = 0;          // widget pixels a picture pixel; 0: fitted
  QPointF center_;           // picture position (pixels) at the widget's centre; of the zoomed view
  enum class Drag { None, Pan, Wipe } drag_ = Drag::None;
  QPointF last_mouse_;
  std::array<LatestWorker, 2> workers_;  // these last: they stop first
  LatestWorker compare_worker_;
};

}  // namespace beam
