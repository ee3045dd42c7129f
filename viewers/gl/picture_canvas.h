// SPDX-License-Identifier: Apache-2.0
// The widget under the splat view and the image view: two pictures as textured rectangles, the second over
// the first by opacity or beside it by a wipe, and words painted on top. Derived classes say where and what.
#pragma once

#include <QImage>
#include <QOpenGLWidget>
#include <QString>

#include <array>
#include <memory>
#include <optional>

#include "viewers/gl/painted_words.h"
#include "viewers/gl/quad_painter.h"

namespace beam {

using SharedPicture = std::shared_ptr<const Image<u8vec4>>;

// All in device-independent pixels of the widget.
struct PictureLayout {
  std::array<QRectF, 2> target;
  float over_opacity = 0;        // of the second picture
  std::optional<double> wipe_x;  // instead: the first left of it, the second right of it
  bool crisp = false;
};

// Where the words of the last painting are; empty: there are none.
struct WordBoxes {
  QRectF title, badge, foot, scale;
};

class PictureCanvas : public QOpenGLWidget {
  Q_OBJECT

 public:
  explicit PictureCanvas(QWidget* parent = nullptr);
  ~PictureCanvas() override;

  // What is not as usual with everything shown here ("stale: made with other settings"), in amber under the
  // title; empty: nothing. Costs a repaint, no rendering.
  void setBadge(const QString& badge);
  const QString& badge() const { return badge_; }
  // What is seen, with its words.
  QImage picture() { return grabFramebuffer(); }
  const WordBoxes& words() const { return words_; }

 protected:
  // `layer` 0 or 1; null takes the picture away.
  void setPicture(int layer, SharedPicture picture);
  bool hasPicture(int layer) const { return pictures_[layer] != nullptr; }
  virtual PictureLayout pictureLayout() const = 0;
  // Draws what is not a picture of the host in place of the first layer; false: there is nothing of the kind.
  // In pixels of the framebuffer, which is bound.
  virtual bool paintUnder(const QRectF& target_px, const QSizeF& framebuffer);
  virtual void paintOver(QPainter& painter) = 0;
  // Words at the left edge are no wider: what is looked at stands in the middle.
  double columnWidth() const;
  // The title in the upper left corner with the badge under it, and a note in the lower left one.
  void paintWords(QPainter& painter, const QString& title, const QString& foot);
  // The badge alone, for views that place their titles themselves; `top_px` is where they end, and from
  // `left_px` to `right_px` is that of which it is true.
  void paintBadge(QPainter& painter, double top_px, double left_px, double right_px);
  void paintFoot(QPainter& painter, const QString& foot);
  // The legend of false colours in the right column, clear of the words painted before.
  void paintLegend(QPainter& painter, const Limits& limits, const QString& unit);
  void titleIs(const QRectF& box) { words_.title = box; }

  void initializeGL() override;
  void paintGL() override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;

 private:
  std::array<SharedPicture, 2> pictures_;
  std::array<bool, 2> stale_{};  // the texture holds another picture
  std::array<Texture, 2> textures_;
  std::unique_ptr<QuadPainter> quads_;
  QString badge_;
  bool ring_ = false;  // the focus came by the keyboard
  WordBoxes words_;
};

}  // namespace beam
