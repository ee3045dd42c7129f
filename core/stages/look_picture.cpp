// SPDX-License-Identifier: Apache-2.0
#include "core/stages/look_picture.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/image/view_transform.h"
#include "core/io/image_file.h"
#include "core/math/color.h"
#include "core/render/sky_picture.h"

namespace beam {
namespace {

constexpr const char* kColorBackground = "color";
constexpr float kBrightest = 65504;  // of half precision

// Radiance behind the subject; empty: nothing is there.
Image<vec3> backdropOf(const Look& look, const Behind& behind) {
  const EnvironmentLight& light = look.lighting.environment;
  if (light.enabled && light.background && behind.panorama)
    return skyPicture(behind.camera, light, *behind.panorama);
  if (look.background.kind != kColorBackground) return {};
  return {behind.camera.width, behind.camera.height, vec3(look.background.color), Encoding::Linear};
}

// Light without end is as bright as a file can say.
float storable(float light) { return std::isfinite(light) ? std::min(light, kBrightest) : kBrightest; }

// Premultiplied, 4 planes, with what is behind.
Planes exposed(const Planes& relit, const Planes& alpha, const Image<vec3>& backdrop, double stops) {
  Planes out(relit.width, relit.height, 4);
  const auto exposure = static_cast<float>(std::exp2(stops));
  parallelFor(alpha.values.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float a = std::clamp(alpha.values[i], 0.0f, 1.0f);
      vec3 light(relit.plane(0)[i], relit.plane(1)[i], relit.plane(2)[i]);
      if (!backdrop.empty()) light += (1 - a) * backdrop.pixels[i];
      for (int c = 0; c < 3; ++c) out.plane(c)[i] = storable(exposure * light[c]);
      out.plane(3)[i] = backdrop.empty() ? a : 1;
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

LookPicture lookPicture(const Planes& relit, const Planes& alpha, const Look& look, const Behind& behind) {
  const Image<vec3> backdrop = backdropOf(look, behind);
  return {exposed(relit, alpha, backdrop, look.exposure_stops), look.view_transform, !backdrop.empty()};
}

void writeLookPicture(const std::filesystem::path& file, const LookPicture& picture, const FileNotes& notes) {
  if (picture.view_transform == kRawTransform)
    return writeExr(file, picture.light, {"R", "G", "B", "A"}, ExrPrecision::Half, notes);
  const ViewTransform transform = viewTransformOf(picture.view_transform);
  if (picture.opaque)
    writePng(file, shown<u8vec3>(picture.light, transform), notes);
  else
    writePng(file, shown<u8vec4>(picture.light, transform), notes);
}

Image<u8vec3> onBlack(const LookPicture& picture) {
  Planes light = picture.light;
  std::fill_n(light.plane(3), light.values.size() / 4, 1.0f);
  return shown<u8vec3>(light, viewTransformOf(picture.view_transform));
}

}  // namespace beam
