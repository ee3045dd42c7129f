// SPDX-License-Identifier: Apache-2.0
// Draws a channel that is a texture of the current context (render/scene_renderer.h) on the screen, and reads
// such textures back. Made, used and destroyed with the same context current.
#pragma once

#include <QOpenGLShaderProgram>
#include <QOpenGLVertexArrayObject>
#include <QRectF>

#include "core/scene/channel.h"
#include "viewers/gl/functions.h"
#include "viewers/splat/channel_picture.h"

namespace beam {

class ChannelPainter {
 public:
  ChannelPainter();  // throws Error{Bug} with the compiler's words when a shader does not compile
  ~ChannelPainter();
  ChannelPainter(const ChannelPainter&) = delete;
  ChannelPainter& operator=(const ChannelPainter&) = delete;

  // As channelPicture(). `target` and `framebuffer` in pixels, y down. Sets how the texture is sampled.
  void draw(std::uint32_t texture, const ChannelInfo& channel, const Image<vec3>& sky,
            const ChannelOptions& options, const QRectF& target, const QSizeF& framebuffer);

 private:
  QOpenGLShaderProgram program_;
  QOpenGLVertexArrayObject no_attributes_;
  GLuint palette_ = 0, sky_ = 0;
};

// `channels` 1: R; 3: R G B. A of a texture as `alpha`.
Planes readTexture(std::uint32_t texture, int channels, Planes& alpha);

}  // namespace beam
