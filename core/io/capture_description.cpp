// SPDX-License-Identifier: Apache-2.0
#include "core/io/capture_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/word_list.h"
#include "core/io/file.h"
#include "core/scene/rig_focus.h"

namespace beam {
namespace {

constexpr double kStill = 4e-4;    // of the distance to the subject; COLMAP and transforms.json have no unit
constexpr double kDistance_m = 3;  // where the cameras do not tell it
constexpr double kStill_rad = 2e-3;    // about a pixel at the border of a 1000-pixel picture
constexpr double kOrthonormal = 1e-3;  // what rounding to four digits leaves

[[noreturn]] void bad(const std::string& where, const std::string& what) {
  throw Error(Error::Kind::Data, fmt::format("{}: {}", where, what));
}

}  // namespace

bool isPicture(const std::filesystem::path& file) {
  const std::string e = lowerCase(file.extension().string());
  return e == ".png" || e == ".jpg" || e == ".jpeg";
}

std::map<std::string, std::filesystem::path> picturesIn(const std::filesystem::path& folder) {
  std::map<std::string, std::filesystem::path> found;
  if (!std::filesystem::is_directory(folder)) return found;
  for (const std::filesystem::directory_entry& entry : entriesOf(folder)) {
    const std::filesystem::path& file = entry.path();
    const bool hidden = file.filename().string().front() == '.';  // macOS leaves "._name.png" beside pictures
    if (hidden || !isPicture(file) || !entry.is_regular_file()) continue;
    // Of two pictures with one stem the first by name counts: a folder lists them in no order.
    const auto [place, fresh] = found.emplace(file.stem().string(), file);
    if (!fresh) place->second = std::min(place->second, file);
  }
  return found;
}

dquat rotationFromMatrix(const dmat3& m, const std::string& where) {
  const dmat3 square = glm::transpose(m) * m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (!(std::abs(square[i][j] - (i == j)) < kOrthonormal))
        bad(where, "expected an orthonormal rotation matrix");
    }
  }
  if (glm::determinant(m) < 0) bad(where, "the rotation matrix is a mirror (determinant -1)");
  return glm::normalize(glm::quat_cast(m));
}

void addPose(DescribedCamera& known, const Camera& again, const std::string& where) {
  known.moved = std::max(known.moved, glm::length(centerOf(known.camera) - centerOf(again)));
  const dquat &p = known.camera.camera_from_world.rotation, &q = again.camera_from_world.rotation;
  const double turned_rad = 2 * std::acos(std::min(1.0, std::abs(glm::dot(p, q))));
  if (turned_rad > kStill_rad) {
    bad(where,
        fmt::format("camera \"{}\" turns between its pictures by {:.4f} rad; expected cameras that stand "
                    "still",
                    known.name, turned_rad));
  }
  if (known.camera.width != again.width || known.camera.height != again.height ||
      std::abs(known.camera.intrinsics.fx - again.intrinsics.fx) > 1e-3 * again.intrinsics.fx) {
    bad(where,
        fmt::format("camera \"{}\" changes its size or focal length between its pictures; expected one "
                    "calibration a camera",
                    known.name));
  }
}

void requireStill(const CaptureDescription& description, const std::string& where) {
  std::vector<Camera> cameras;
  for (const DescribedCamera& c : description.cameras) cameras.push_back(c.camera);
  const std::optional<RigFocus> focus = focusOf(cameras);
  const double most = kStill * (focus ? focus->distance_m : kDistance_m);
  for (const DescribedCamera& c : description.cameras) {
    if (c.moved <= most) continue;
    bad(where,
        fmt::format("camera \"{}\" moves between its pictures by {:.4g} units; expected cameras that stand "
                    "still, to {:.2g} units",
                    c.name, c.moved, most));
  }
}

void requirePlainName(const std::string& name, const std::string& where) {
  const std::filesystem::path path(name);
  const bool leaves = std::any_of(path.begin(), path.end(), [](const auto& part) { return part == ".."; });
  if (name.empty() || name.size() > 255 || path.is_absolute() || leaves) {
    bad(where,
        fmt::format("\"{}\" is no name for a camera or picture; expected a relative path without \"..\"",
                    name));
  }
}

}  // namespace beam
