// SPDX-License-Identifier: Apache-2.0
// A relit picture as a look shows it: exposure, background, view transform; and as a file.
#pragma once

#include <filesystem>
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

// `relit`: 3 planes, scene-linear, premultiplied; `alpha`: 1. `look`: of the moment, without curves. PNG is 8
// bits, sRGB as the view transform says, with straight alpha where nothing is behind; EXR half precision, R G
// B A, premultiplied, scene-linear times the exposure, at most 65504. Throws Error{Storage}.
void writeLookPicture(const std::filesystem::path& file, const Planes& relit, const Planes& alpha,
                      const Look& look, const Behind& behind, const FileNotes& notes);

}  // namespace beam
