// SPDX-License-Identifier: Apache-2.0
// Draws textures as rectangles of the current framebuffer, blended over what is there.
#pragma once

#include <QOpenGLShaderProgram>
#include <QOpenGLVertexArrayObject>
#include <QRectF>
#include <QVector4D>

#include <limits>

#include "viewers/gl/texture.h"

namespace beam {

struct QuadStyle {
  float opacity = 1;
  bool crisp = false;
  float first_column =
      -std::numeric_limits<float>::max();  // framebuffer pixels that may be painted, half-open
  float end_column = std::numeric_limits<float>::max();
};

// The shaders of the viewers are found from then on: resources of a static library are linked only when
// named.
void nameShaders();

// Left, top, right, bottom in normalised device coordinates; both in pixels, y down.
QVector4D clipRectangle(const QRectF& target, const QSizeF& framebuffer);

class QuadPainter {
 public:
  QuadPainter();  // throws Error{Bug} with the compiler's words when a shader does not compile
  // `target` and `framebuffer` in pixels, y down.
  void draw(const Texture& texture, const QRectF& target, const QSizeF& framebuffer, const QuadStyle& style);

 private:
  QOpenGLShaderProgram program_;
  QOpenGLVertexArrayObject no_attributes_;  // core profile draws nothing without one
};

}  // namespace beam
