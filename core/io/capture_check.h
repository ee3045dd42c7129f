// SPDX-License-Identifier: Apache-2.0
// What `beam check` says of a capture, a panorama or a splat file: what was understood and what is wrong.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/io/capture_reader.h"

namespace beam {

struct CameraCheck {
  std::string name;
  bool held_out = false;
  int width = 0, height = 0;
  Intrinsics intrinsics;
  int frames = 0;
  double mask_coverage = -1;  // share of the picture, first frame; < 0: no mask
};

struct PanoramaCheck {
  int width = 0, height = 0;
  vec3 mean_radiance{0}, brightest_direction{0};  // world axes
};

struct SplatCheck {
  std::size_t count = 0;
  int sh_degree = 0;
  bool has_materials = false;
  vec3 low{0}, high{0};
};

struct CheckReport {
  std::string path, kind;  // kind: "capture", "panorama", "splats"
  std::string layout, up;
  CapturePlacement placement;
  std::vector<std::string> frames;
  std::vector<CameraCheck> cameras;
  std::size_t seed_points = 0;
  std::optional<PanoramaCheck> panorama;
  std::optional<SplatCheck> splats;
  std::vector<std::string> warnings;
};

// Says why nothing can be solved of a capture whose pictures were looked at: fewer than two training cameras
// have a picture that can be used. Empty: something can.
std::string refusalOf(const CheckReport& report);

// Looks at every picture of the capture; damaged ones become warnings that name file, camera and frame.
// Throws Error{Data} when nothing usable is there, Cancelled when `progress` was asked to stop.
CheckReport checkPath(const std::filesystem::path& path, const ImportOptions& options = {},
                      Progress* progress = nullptr);

// The two halves of it for a capture that is open. What its description says, which is quick: no camera has
// pictures yet, and warnings are those of the import.
CheckReport checkDescription(const std::filesystem::path& path, const ImportedCapture& capture);
// What its pictures and its panorama say, into `report`; reads all of them.
void checkPictures(const CaptureSet& set, CheckReport& report, Progress& progress);

std::string toText(const CheckReport& report);
std::string toJson(const CheckReport& report);

}  // namespace beam
