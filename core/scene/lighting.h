// SPDX-License-Identifier: Apache-2.0
// Light as a person sets it: an environment by reference and lights of a few kinds. Plain values that
// describe() lists in full; what lights do over time stands beside them (scene/look.h). World axes, metres;
// angles in degrees; colours and intensities scene-linear Rec.709, in the radiance of the environment.
//
// A light sends `color` x `intensity`. The intensity of a directional light is the irradiance on a surface
// that faces it (radiance x sr); that of a point or spot light is radiant intensity (radiance x m^2), which
// divided by the square of the distance is irradiance; that of a rectangle is the radiance of its surface.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/fields.h"
#include "core/base/file_reference.h"
#include "core/math/types.h"

namespace beam {

// A panorama around everything (scene/environment.h has its axes).
struct EnvironmentLight {
  bool enabled = true;
  FileReference file = {};  // empty: the light that the performance was captured in
  double rotation_deg = 0;  // about +Y, further than the panorama's own; positive moves it from +Z towards +X
  double gain = 1;          // times the panorama's own, >= 0
  // What keeps it off: "transfer" is the visibility that was baked of each Gaussian, "ao" the paper's ambient
  // occlusion, "auto" the first where all Gaussians have some.
  std::string shadows = "auto";
  bool background = false;     // it is what is seen behind the subject; false: the look's background is
  std::string unknown = "{}";  // members of a later version, kept as they are (a JSON object)

  bool operator==(const EnvironmentLight&) const = default;
};
inline float yawOf(const EnvironmentLight& light) {
  return static_cast<float>(light.rotation_deg * kPi / 180);
}
inline constexpr const char* kOcclusionAlone = "ao";
// The one declaration of that choice: of an environment, and of a project for pictures without a look.
FieldInfo environmentShadowsInfo(std::string name);
void describe(Fields& f, EnvironmentLight& light);

// From infinitely far: a sun.
struct DirectionalLight {
  double azimuth_deg = 45;    // of where it comes from: 0 is +Z, 90 is +X
  double elevation_deg = 45;  // 90 is straight from above, +Y
  double intensity = 3;
  dvec3 color = dvec3(1);
  bool shadows = true;

  bool operator==(const DirectionalLight&) const = default;
};
void describe(Fields& f, DirectionalLight& light);

// From a point, the same to all sides. Over `range_m` it is as if multiplied by (1 - (d / range)^4)^2
// (methods 7.6), and beyond it is nothing.
struct PointLight {
  dvec3 position_m = dvec3(1, 2, 1);
  double intensity = 10;
  dvec3 color = dvec3(1);
  double range_m = 0;  // 0: without end
  bool shadows = true;

  bool operator==(const PointLight&) const = default;
};
void describe(Fields& f, PointLight& light);

// A point light in a cone around the line from position to target: whole inside `inner_deg`, nothing outside
// `outer_deg`, between them smoothstep squared in the angle (methods 7.6). Both are measured from the line;
// an inner angle over the outer counts as the outer.
struct SpotLight {
  dvec3 position_m = dvec3(1, 2, 1);
  dvec3 target_m = dvec3(0, 1, 0);
  double inner_deg = 20;
  double outer_deg = 30;
  double intensity = 10;
  dvec3 color = dvec3(1);
  double range_m = 0;  // as of a point light
  bool shadows = true;

  bool operator==(const SpotLight&) const = default;
};
void describe(Fields& f, SpotLight& light);

// A soft box: sends light from its side towards the target only, the same radiance in every direction.
struct RectangleLight {
  dvec3 position_m = dvec3(1, 2, 1);  // its centre
  dvec3 target_m = dvec3(0, 1, 0);
  double roll_deg = 0;  // about the line to the target; at 0 its width is level
  double width_m = 1;
  double height_m = 1;
  double intensity = 10;
  dvec3 color = dvec3(1);
  bool shadows = true;

  bool operator==(const RectangleLight&) const = default;
};
void describe(Fields& f, RectangleLight& light);

// Of a later version: kept whole (its members are in Light::unknown), drawn by nobody, named by remarks().
struct UnknownLight {
  std::string kind;

  bool operator==(const UnknownLight&) const = default;
};
inline void describe(Fields&, UnknownLight&) {}

struct Light {
  std::string id;     // unique among the lights: 1 to 64 letters, digits, '_' or '-'; part of a field's path
  std::string title;  // as shown; empty: the id is
  bool enabled = true;
  std::variant<DirectionalLight, PointLight, SpotLight, RectangleLight, UnknownLight> kind;
  std::string unknown = "{}";

  bool operator==(const Light&) const = default;
};
// What every light has, then its kind's.
void describe(Fields& f, Light& light);

inline constexpr std::size_t kMostLights = 256;

struct Lighting {
  EnvironmentLight environment;
  std::vector<Light> lights;

  bool operator==(const Lighting&) const = default;
};
// "environment.gain", "lights.<id>.intensity".
void describe(Fields& f, Lighting& lighting);

// Throws Error{Data}: more than kMostLights, an id that is none or is there twice, a number out of range.
void validate(const Lighting& lighting);

// "directional", "point", "spot", "rectangle".
const std::vector<std::string>& lightKinds();
// One of them, or what a light of a later version calls its own.
std::string kindOf(const Light& light);
// A light as it is when nothing is said of it; an UnknownLight for a kind that is not in lightKinds().
Light newLight(std::string id, std::string_view kind);
bool castsShadows(const Light& light);                                // whether it is meant to
const Light* lightOf(const Lighting& lighting, std::string_view id);  // null: there is none

// Unit, from anywhere to the light.
dvec3 directionTo(const DirectionalLight& light);
// world_from_light of what is aimed: it shines along its -Z, its +X is level and its +Y up at roll 0 (as in
// USD and glTF), which turns both counter-clockwise seen from behind the light. A target at the position
// counts as straight below it; of a light aimed up or down, +X is the world's at roll 0.
dmat3 aimed(const dvec3& position_m, const dvec3& target_m, double roll_deg);

}  // namespace beam
