// SPDX-License-Identifier: Apache-2.0
// An 8-bit picture on the graphics device. Made, used and destroyed with the same context current.
#pragma once

#include "core/image/image.h"
#include "viewers/gl/functions.h"

namespace beam {

class Texture {
 public:
  Texture() = default;
  ~Texture() { release(); }
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  void upload(const Image<u8vec4>& picture);
  void release();
  bool empty() const { return width_ == 0; }
  // `crisp`: one flat square a pixel when enlarged.
  void bind(bool crisp) const;

 private:
  GLuint id_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace beam
