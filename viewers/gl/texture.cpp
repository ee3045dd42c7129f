// SPDX-License-Identifier: Apache-2.0
#include "viewers/gl/texture.h"

namespace beam {

void Texture::upload(const Image<u8vec4>& picture) {
  auto& gl = currentGl();
  if (id_ == 0) gl.glGenTextures(1, &id_);
  gl.glBindTexture(GL_TEXTURE_2D, id_);
  gl.glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (picture.width == width_ && picture.height == height_) {
    gl.glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE,
                       picture.pixels.data());
  } else {
    width_ = picture.width;
    height_ = picture.height;
    gl.glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_, height_, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                    picture.pixels.data());
    gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  gl.glGenerateMipmap(GL_TEXTURE_2D);
}

void Texture::release() {
  if (id_ != 0) currentGl().glDeleteTextures(1, &id_);
  id_ = 0;
  width_ = height_ = 0;
}

void Texture::bind(bool crisp) const {
  auto& gl = currentGl();
  gl.glActiveTexture(GL_TEXTURE0);
  gl.glBindTexture(GL_TEXTURE_2D, id_);
  gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, crisp ? GL_NEAREST : GL_LINEAR);
}

}  // namespace beam
