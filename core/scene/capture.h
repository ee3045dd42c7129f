// SPDX-License-Identifier: Apache-2.0
// CaptureSet: what a capture is, as understood by the importer, in the house's world (right-handed, +Y up,
// metres). Pictures are read from disk when asked for; nothing is ever written into a capture.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/math/similarity3.h"
#include "core/scene/camera.h"
#include "core/scene/ids.h"

namespace beam {

enum class Split {
  Train,
  Test,  // held out: never used for fitting
};

inline constexpr int kLeastTrainingCameras = 2;  // of which anything can be solved

struct View {
  std::string name;
  Camera camera;  // of the pictures as stored
  Split split = Split::Train;

  bool operator==(const View&) const = default;
};

struct PointCloud {
  std::vector<vec3> position_m;  // from `origin`
  std::vector<u8vec3> color;     // sRGB; empty or one per point
  // Other than 0 only in the axes of a capture that lies so far from its origin that single precision would
  // blur its points.
  dvec3 origin = dvec3(0);

  dvec3 position(std::size_t i) const {
    return origin == dvec3(0) ? dvec3(position_m[i]) : origin + dvec3(position_m[i]);
  }
};
// Points that are given in double precision.
PointCloud pointCloudOf(const std::vector<dvec3>& positions, std::vector<u8vec3> color);

// Reads pictures of a capture. Implementations are safe to call from several threads.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  // Whether the picture exists in the capture.
  virtual bool has(ViewIndex view, FrameIndex frame) const = 0;
  // The photograph as stored, sRGB-encoded. Throws Error{Data} with the file's name when it cannot be read or
  // has another size than the view's camera.
  virtual Image<u8vec3> photo(ViewIndex view, FrameIndex frame) const = 0;
  // Coverage of the subject, 255 = inside; empty where the capture has no masks.
  virtual Image<std::uint8_t> mask(ViewIndex view, FrameIndex frame) const = 0;
  // The files behind photo and mask, to tell by their bytes whether they changed; empty: there are none.
  virtual std::vector<std::string> files(ViewIndex, FrameIndex) const { return {}; }
};

// Where the masks of a capture are: in files of their own, in the pictures' alpha, or all pixels that are not
// the constant colour of the border.
enum class MaskKind { None, Files, Alpha, Key };

enum class UpAxis { PlusY, PlusZ, MinusY };
std::string toText(UpAxis up);  // "+Y", "+Z", "-Y"

struct CaptureSet {
  std::string name;
  std::vector<View> views;
  std::vector<std::string> frames;  // the capture's own frame names, in order
  double frames_per_second = 30;
  MaskKind masks = MaskKind::None;
  PointCloud seed_points;                       // in world axes; may be empty
  std::optional<std::string> environment_file;  // path of the capture's panorama
  UpAxis up = UpAxis::PlusY;                    // of the capture's own axes
  Similarity3 capture_from_world;               // back to the capture's own axes, unit and origin
  std::shared_ptr<const FrameSource> source;
};

// world_from_capture of an up axis: a permutation with signs, which turns without rounding.
dmat3 worldFromCapture(UpAxis up);

}  // namespace beam
