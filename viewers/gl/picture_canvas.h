// SPDX-License-Identifier: Apache-2.0
// The widget under the splat view and the image view: two pictures as textured rectangles, the second over
// the first by opacity or beside it by a wipe, and words painted on top. Derived classes say where and what.
#pragma once

#include <QOpenGLWidget>
#include <QString>

#include <array>
#include <memory>
#include <optional>

#include "viewers/false_color.h"
#include "viewers/gl/quad_painter.h"

class QPainter;

namespace beam {

using SharedPicture = std::shared_ptr<const Image<u8vec4>>;

// All in device-independent pixels of the widget.
struct PictureLayout {
  std::array<QRectF, 2> target;
  float over_opacity = 0;        // of the second picture
  std::optional<double> wipe_x;  // instead: the first left of it, the second right of it
  bool crisp = false;
};

class PictureCanvas : public QOpenGLWidget {
  Q_OBJECT

 public:
  explicit PictureCanvas(QWidget* parent = nullptr);
  ~PictureCanvas() override;

 protected:
  // `layer` 0 or 1; null takes the picture away.
  void setPicture(int layer, SharedPicture picture);
  bool hasPicture(int layer) const { return pictures_[layer] != nullptr; }
  virtual PictureLayout pictureLayout() const = 0;
  virtual void paintOver(QPainter& painter) = 0;

  void initializeGL() override;
  void paintGL() override;

 private:
  std::array<SharedPicture, 2> pictures_;
  std::array<bool, 2> stale_{};  // the texture holds another picture
  std::array<Texture, 2> textures_;
  std::unique_ptr<QuadPainter> quads_;
};

// A label in a rounded box with its corner at `at`; `alignment` says which corner (Qt::AlignLeft |
// Qt::AlignTop ...).
QRectF paintLabel(QPainter& painter, QPointF at, Qt::Alignment alignment, const QString& text);
// The legend of false colours: a bar with values beside it, its upper right corner at `at`.
void paintScale(QPainter& painter, QPointF at, const Limits& limits, const QString& unit);
// Several lines, centred, for empty states.
void paintMessage(QPainter& painter, const QRectF& area, const QString& title, const QString& body);

}  // namespace beam
