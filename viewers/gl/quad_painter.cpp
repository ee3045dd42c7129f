// SPDX-License-Identifier: Apache-2.0
#include "viewers/gl/quad_painter.h"

#include <QVector2D>

#include "core/base/error.h"

// The macro must stand outside of namespaces.
static void initializeShaders() { Q_INIT_RESOURCE(shaders); }

namespace beam {

void nameShaders() { initializeShaders(); }

QVector4D clipRectangle(const QRectF& target, const QSizeF& framebuffer) {
  const auto x = [&](double v) { return static_cast<float>(2 * v / framebuffer.width() - 1); };
  const auto y = [&](double v) { return static_cast<float>(1 - 2 * v / framebuffer.height()); };
  return {x(target.left()), y(target.top()), x(target.right()), y(target.bottom())};
}

QuadPainter::QuadPainter() {
  nameShaders();
  const bool ready = program_.addShaderFromSourceFile(QOpenGLShader::Vertex, ":/shaders/picture.vert") &&
                     program_.addShaderFromSourceFile(QOpenGLShader::Fragment, ":/shaders/picture.frag") &&
                     program_.link() && no_attributes_.create();
  if (!ready) throw Error(Error::Kind::Bug, "picture shader: " + program_.log().toStdString());
}

void QuadPainter::draw(const Texture& texture, const QRectF& target, const QSizeF& framebuffer,
                       const QuadStyle& style) {
  if (texture.empty()) return;
  auto& gl = currentGl();
  gl.glDisable(GL_DEPTH_TEST);
  gl.glDisable(GL_CULL_FACE);
  gl.glEnable(GL_BLEND);
  gl.glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE);  // the window stays opaque
  program_.bind();
  program_.setUniformValue("rectangle", clipRectangle(target, framebuffer));
  program_.setUniformValue("picture", 0);
  program_.setUniformValue("opacity", style.opacity);
  program_.setUniformValue("columns", QVector2D(style.first_column, style.end_column));
  texture.bind(style.crisp);
  QOpenGLVertexArrayObject::Binder binder(&no_attributes_);
  gl.glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  program_.release();
}

}  // namespace beam
