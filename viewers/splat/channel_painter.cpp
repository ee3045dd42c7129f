// SPDX-License-Identifier: Apache-2.0
#include "viewers/splat/channel_painter.h"

#include <QVector2D>
#include <QVector3D>

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "viewers/gl/quad_painter.h"

namespace beam {
namespace {

constexpr int kPaletteSize = 256;

// As channel.frag numbers them.
int formOf(const ChannelInfo& channel) {
  if (channel.quantity == Quantity::Color) return channel.encoding == Encoding::Srgb ? 1 : 0;
  if (channel.quantity == Quantity::Direction) return 2;
  return channel.false_color ? 4 : 3;
}

void bindLinear(QOpenGLFunctions_3_3_Core& gl, GLenum unit, GLuint texture) {
  gl.glActiveTexture(unit);
  gl.glBindTexture(GL_TEXTURE_2D, texture);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl.glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
}

GLuint newPalette() {
  // Four bytes a texel: the alignment of uploads stays as it is, which QPainter's glyphs count on.
  std::array<u8vec4, kPaletteSize> colors;
  for (int i = 0; i < kPaletteSize; ++i)
    colors[i] = u8vec4(falseColor(static_cast<float>(i) / (kPaletteSize - 1)), 255);
  auto& gl = currentGl();
  GLuint texture = 0;
  gl.glGenTextures(1, &texture);
  gl.glBindTexture(GL_TEXTURE_2D, texture);
  gl.glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kPaletteSize, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, colors.data());
  return texture;
}

}  // namespace

ChannelPainter::ChannelPainter() {
  nameShaders();
  const bool ready = program_.addShaderFromSourceFile(QOpenGLShader::Vertex, ":/shaders/picture.vert") &&
                     program_.addShaderFromSourceFile(QOpenGLShader::Fragment, ":/shaders/channel.frag") &&
                     program_.link() && no_attributes_.create();
  if (!ready) throw Error(Error::Kind::Bug, "channel shader: " + program_.log().toStdString());
  palette_ = newPalette();
  currentGl().glGenTextures(1, &sky_);
}

ChannelPainter::~ChannelPainter() {
  currentGl().glDeleteTextures(1, &palette_);
  currentGl().glDeleteTextures(1, &sky_);
}

void ChannelPainter::draw(std::uint32_t texture, const ChannelInfo& channel, const Image<vec3>& sky,
                          const ChannelOptions& options, const QRectF& target, const QSizeF& framebuffer) {
  auto& gl = currentGl();
  gl.glDisable(GL_DEPTH_TEST);
  gl.glDisable(GL_CULL_FACE);
  gl.glDisable(GL_BLEND);
  if (!sky.empty()) {
    gl.glBindTexture(GL_TEXTURE_2D, sky_);
    gl.glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, sky.width, sky.height, 0, GL_RGB, GL_FLOAT,
                    sky.pixels.data());
  }
  bindLinear(gl, GL_TEXTURE1, sky.empty() ? palette_ : sky_);
  bindLinear(gl, GL_TEXTURE2, palette_);
  bindLinear(gl, GL_TEXTURE0, texture);
  program_.bind();
  program_.setUniformValue("rectangle", clipRectangle(target, framebuffer));
  program_.setUniformValue("values", 0);
  program_.setUniformValue("behind", 1);
  program_.setUniformValue("palette", 2);
  program_.setUniformValue("sky", !sky.empty());
  program_.setUniformValue("form", formOf(channel));
  program_.setUniformValue("times_alpha", channel.times_alpha);
  program_.setUniformValue("least_alpha", channel.least_alpha);
  program_.setUniformValue("gain", std::exp2(options.exposure_stops));
  program_.setUniformValue("limits", QVector2D(options.limits.low, options.limits.high));
  program_.setUniformValue("backdrop", QVector3D(kBackdrop.x, kBackdrop.y, kBackdrop.z));
  QOpenGLVertexArrayObject::Binder binder(&no_attributes_);
  gl.glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  program_.release();
}

Planes readTexture(std::uint32_t texture, int channels, Planes& alpha) {
  auto& gl = currentGl();
  gl.glActiveTexture(GL_TEXTURE0);
  gl.glBindTexture(GL_TEXTURE_2D, texture);
  GLint width = 0, height = 0;
  gl.glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
  gl.glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &height);
  std::vector<vec4> pixels(static_cast<std::size_t>(width) * height);
  gl.glPixelStorei(GL_PACK_ALIGNMENT, 4);
  gl.glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, pixels.data());
  Planes values(width, height, channels);
  alpha = Planes(width, height, 1);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (int c = 0; c < channels; ++c) values.plane(c)[i] = pixels[i][c];
    alpha.values[i] = pixels[i].w;
  }
  return values;
}

}  // namespace beam
