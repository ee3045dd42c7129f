// SPDX-License-Identifier: Apache-2.0
// How a lens bends the picture of a pinhole. Points are normalised image points, (x/z, y/z) of camera axes:
// distort() leads from where a pinhole would see something to where the lens shows it, undistort() back.
// Pixels come after: Intrinsics turn a distorted point into a position in the picture.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/types.h"

namespace beam {

struct Camera;

inline constexpr std::size_t kMostLensParameters = 12;
using LensParameters = std::array<double, kMostLensParameters>;

struct Lens {
  std::string model = "pinhole";   // one of lensModels()
  LensParameters parameters = {};  // the model's, in its order; 0 beyond them

  bool operator==(const Lens&) const = default;
};

// "pinhole", which has no parameters.
const std::vector<std::string>& lensModels();
std::size_t parameterCount(const Lens& lens);  // throws Error{Bug} for an unknown model, as all below
inline bool isPinhole(const Lens& lens) { return lens == Lens{}; }

// Throws Error{Data} naming `name`: an unknown model, a parameter that is not finite or beyond the model's.
void validate(const Lens& lens, std::string_view name);

// A point on the other side of the lens and how it moves; columns of parameters beyond the model's are 0.
struct LensPoint {
  dvec2 point;
  dmat2 by_point;                                       // [column]: by that coordinate of the point given
  std::array<dvec2, kMostLensParameters> by_parameter;  // [i]: by that parameter, the point given held
};
LensPoint distort(const Lens& lens, const dvec2& undistorted);
// Nothing where no point within the valid region's radius is shown at `distorted`.
std::optional<LensPoint> undistort(const Lens& lens, const dvec2& distorted);

// What a picture shows and the lens tells: undistorted points nearer to the axis than `radius`, beyond which
// distort() is not one to one, whose distorted points lie in the picture, from `low` to `high`.
struct LensRegion {
  double radius;    // infinite for a pinhole
  dvec2 low, high;  // corners of the picture as distorted points
};
LensRegion validRegion(const Camera& camera);

// The engine and the method know pinholes only; pictures are undistorted when they are decoded. Throws
// Error{Bug} naming `who` for a camera with another lens.
void requirePinhole(const Camera& camera, std::string_view who);

}  // namespace beam
