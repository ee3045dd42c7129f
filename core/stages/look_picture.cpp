// SPDX-License-Identifier: Apache-2.0
#include "core/stages/look_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"
#include "core/image/view_transform.h"
#include "core/io/image_file.h"
#include "core/math/color.h"

namespace beam {
namespace {

constexpr const char* kColorBackground = "color";
constexpr std::size_t kRows = 16;
constexpr float kBrightest = 65504;  // of half precision

// Radiance behind a pixel.
class Backdrop {
 public:
  Backdrop(const Look& look, const Behind& behind)
      : camera_(behind.camera), world_from_camera_(glm::conjugate(camera_.camera_from_world.rotation)) {
    const EnvironmentLight& light = look.lighting.environment;
    if (light.enabled && light.background && behind.panorama) {
      panorama_ = *behind.panorama;
      panorama_->yaw_rad += static_cast<float>(light.rotation_deg * kPi / 180);
      panorama_->gain *= static_cast<float>(light.gain);
    }
    there_ = panorama_ || look.background.kind == kColorBackground;
    color_ = vec3(look.background.color);
  }
  bool isThere() const { return there_; }
  vec3 at(int x, int y) const {
    if (!panorama_) return color_;
    return radianceFrom(
        *panorama_, vec3(glm::normalize(world_from_camera_ * rayOf(camera_.intrinsics, {x + 0.5, y + 0.5}))));
  }

 private:
  Camera camera_;
  dquat world_from_camera_;
  std::optional<Environment> panorama_;
  bool there_ = false;
  vec3 color_{0};
};

// Light without end is as bright as a file can say.
float storable(float light) { return std::isfinite(light) ? std::min(light, kBrightest) : kBrightest; }

// Premultiplied, 4 planes, with what is behind.
Planes exposed(const Planes& relit, const Planes& alpha, const Look& look, const Backdrop& backdrop) {
  Planes out(relit.width, relit.height, 4);
  const auto exposure = static_cast<float>(std::exp2(look.exposure_stops));
  parallelFor(static_cast<std::size_t>(out.height), kRows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      for (int x = 0; x < out.width; ++x) {
        const std::size_t i = y * static_cast<std::size_t>(out.width) + static_cast<std::size_t>(x);
        const float a = std::clamp(alpha.plane(0)[i], 0.0f, 1.0f);
        vec3 light(relit.plane(0)[i], relit.plane(1)[i], relit.plane(2)[i]);
        if (backdrop.isThere()) light += (1 - a) * backdrop.at(x, static_cast<int>(y));
        for (int c = 0; c < 3; ++c) out.plane(c)[i] = storable(exposure * light[c]);
        out.plane(3)[i] = backdrop.isThere() ? 1 : a;
      }
    }
  });
  return out;
}

template <class Pixel>
Image<Pixel> shown(const Planes& p, ViewTransform transform) {
  Image<Pixel> out(p.width, p.height, Pixel(0), Encoding::Srgb);
  parallelFor(out.pixels.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float a = p.plane(3)[i];
      if (a <= 0) continue;
      const vec3 c = transform(vec3(p.plane(0)[i], p.plane(1)[i], p.plane(2)[i]) / a);
      for (int k = 0; k < 3; ++k) out.pixels[i][k] = byteOf(c[k]);
      if constexpr (Pixel::length() == 4) out.pixels[i][3] = byteOf(a);
    }
  });
  return out;
}

}  // namespace

std::string_view lookFileExtension(const Look& look) {
  if (look.view_transform == kRawTransform) return "exr";
  viewTransformOf(look.view_transform);
  return "png";
}

void writeLookPicture(const std::filesystem::path& file, const Planes& relit, const Planes& alpha,
                      const Look& look, const Behind& behind, const FileNotes& notes) {
  const Backdrop backdrop(look, behind);
  const Planes picture = exposed(relit, alpha, look, backdrop);
  if (look.view_transform == kRawTransform)
    return writeExr(file, picture, {"R", "G", "B", "A"}, ExrPrecision::Half, notes);
  const ViewTransform transform = viewTransformOf(look.view_transform);
  if (backdrop.isThere())
    writePng(file, shown<u8vec3>(picture, transform), notes);
  else
    writePng(file, shown<u8vec4>(picture, transform), notes);
}

}  // namespace beam
