// SPDX-License-Identifier: Apache-2.0
// A relit picture as a look shows it: exposure, background, view transform; and as a file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/image/image.h"
#include "core/io/written_by.h"
#include "core/scene/camera.h"
#include "core/scene/environment.h"
#include "core/scene/look.h"

namespace beam {

inline constexpr const char* kRawTransform = "raw";  // scene-linear, into OpenEXR alone

// "png", "exr" of raw. Throws Error{Usage} for a view transform that is not drawn.
std::string_view lookFileExtension(const Look& look);

// What a look may put behind the subject.
struct Behind {
  Camera camera;
  const Environment* panorama = nullptr;  // as it was opened; null: none
};

struct LookPicture {
  Planes light;                // R G B A, premultiplied, scene-linear times the exposure, at most 65504
  std::string view_transform;  // of the look
  bool opaque = false;         // something is behind everywhere
};

// `relit`: 3 planes, scene-linear, premultiplied; `alpha`: 1. `look`: of the moment, without curves.
LookPicture lookPicture(const Planes& relit, const Planes& alpha, const Look& look, const Behind& behind);

// PNG of 8 bits, sRGB as the view transform says, with straight alpha where it is not opaque; of raw EXR,
// half precision. Throws Error{Storage}.
void writeLookPicture(const std::filesystem::path& file, const LookPicture& picture, const FileNotes& notes);

// For films, which have no alpha; not of raw.
Image<u8vec3> onBlack(const LookPicture& picture);

}  // namespace beam
