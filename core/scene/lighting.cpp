// SPDX-License-Identifier: Apache-2.0
#include "core/scene/lighting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/scene/described_values.h"

namespace beam {
namespace {

constexpr std::size_t kLongestId = 64;

bool isId(const std::string& text) {
  return !text.empty() && text.size() <= kLongestId && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

const FieldInfo& colorInfo() {
  static const FieldInfo kInfo{
      .name = "", .label = "Colour", .help = "Of the light, scene-linear; times the intensity."};
  return kInfo;
}

void describeIntensity(Fields& f, const char* help, double& intensity, dvec3& color) {
  f.field({.name = "intensity", .label = "Intensity", .help = help, .min = 0}, intensity);
  describeColor(f, "color", colorInfo(), color);
}

void describeShadows(Fields& f, bool& shadows) {
  f.field({.name = "shadows", .label = "Shadows", .help = "Whether what stands in its way keeps it off."},
          shadows);
}

void describePlace(Fields& f, dvec3& position_m) {
  describePosition(f, "position_m", {.name = "", .label = "Position", .help = "Where the light is."},
                   position_m);
}

void describeAim(Fields& f, dvec3& position_m, dvec3& target_m) {
  describePlace(f, position_m);
  describePosition(f, "target_m", {.name = "", .label = "Target", .help = "What the light points at."},
                   target_m);
}

void describeRange(Fields& f, double& range_m) {
  f.field({.name = "range_m",
           .label = "Range",
           .help = "Beyond it the light is nothing; 0: it has no end.",
           .min = 0,
           .unit = "m",
           .advanced = true},
          range_m);
}

void describeSide(Fields& f, const char* name, const char* label, double& length_m) {
  f.field({.name = name, .label = label, .help = "Of the surface that shines.", .min = 0.001, .unit = "m"},
          length_m);
}

void describeCone(Fields& f, const char* name, const char* label, const char* help, double& angle_deg) {
  f.field({.name = name, .label = label, .help = help, .min = 0, .max = 90, .unit = "deg"}, angle_deg);
}

}  // namespace

FieldInfo environmentShadowsInfo(std::string name) {
  return {.name = std::move(name),
          .label = "Environment shadows",
          .help =
              "How a panorama's light is kept off: by the visibility of each Gaussian (transfer), by "
              "ambient occlusion alone as in the paper (ao), or by the first where it was baked (auto).",
          .choices = {"auto", "transfer", kOcclusionAlone}};
}

void describe(Fields& f, EnvironmentLight& light) {
  f.field({.name = "enabled", .label = "Environment", .help = "Whether light comes from all around."},
          light.enabled);
  describeFile(
      f, "file",
      {.name = "", .label = "Panorama", .help = "Empty: the light that the performance was captured in."},
      light.file);
  f.field({.name = "rotation_deg",
           .label = "Rotation",
           .help = "About the vertical; positive moves the light from +Z towards +X.",
           .unit = "deg"},
          light.rotation_deg);
  f.field({.name = "gain", .label = "Gain", .help = "Times the panorama's own radiance.", .min = 0},
          light.gain);
  f.field(environmentShadowsInfo("shadows"), light.shadows);
  f.field({.name = "background",
           .label = "As background",
           .help = "Whether the panorama is seen behind the subject; else the look's background is."},
          light.background);
}

void describe(Fields& f, DirectionalLight& light) {
  f.field({.name = "azimuth_deg",
           .label = "Azimuth",
           .help = "Of where the light comes from; 0 is +Z, 90 is +X.",
           .unit = "deg"},
          light.azimuth_deg);
  f.field({.name = "elevation_deg",
           .label = "Elevation",
           .help = "Of where the light comes from; 90 is straight from above.",
           .min = -90,
           .max = 90,
           .unit = "deg"},
          light.elevation_deg);
  describeIntensity(f, "Irradiance on a surface that faces the light, in radiance x sr.", light.intensity,
                    light.color);
  describeShadows(f, light.shadows);
}

void describe(Fields& f, PointLight& light) {
  describePlace(f, light.position_m);
  describeIntensity(f, "Irradiance at a distance of 1 m, in radiance x sr.", light.intensity, light.color);
  describeRange(f, light.range_m);
  describeShadows(f, light.shadows);
}

void describe(Fields& f, SpotLight& light) {
  describeAim(f, light.position_m, light.target_m);
  describeCone(f, "inner_deg", "Inner angle", "From the axis to where the light begins to fall.",
               light.inner_deg);
  describeCone(f, "outer_deg", "Outer angle", "From the axis to where the light ends.", light.outer_deg);
  describeIntensity(f, "Irradiance at a distance of 1 m, in radiance x sr.", light.intensity, light.color);
  describeRange(f, light.range_m);
  describeShadows(f, light.shadows);
}

void describe(Fields& f, RectangleLight& light) {
  describeAim(f, light.position_m, light.target_m);
  f.field({.name = "roll_deg", .label = "Roll", .help = "About the line to the target.", .unit = "deg"},
          light.roll_deg);
  describeSide(f, "width_m", "Width", light.width_m);
  describeSide(f, "height_m", "Height", light.height_m);
  describeIntensity(f, "Radiance of its surface, in that of the environment.", light.intensity, light.color);
  describeShadows(f, light.shadows);
}

void describe(Fields& f, Light& light) {
  f.field({.name = "title", .label = "Name", .help = "As shown; empty: the light's id."}, light.title);
  f.field({.name = "enabled", .label = "On", .help = "Whether the light shines."}, light.enabled);
  std::visit([&](auto& kind) { describe(f, kind); }, light.kind);
}

void describe(Fields& f, Lighting& lighting) {
  f.group("environment", [&] { describe(f, lighting.environment); });
  f.group("lights", [&] {
    for (Light& light : lighting.lights) f.group(light.id, [&] { describe(f, light); });
  });
}

void validate(const Lighting& lighting) {
  if (lighting.lights.size() > kMostLights) {
    throw Error(Error::Kind::Data,
                fmt::format("lights: expected at most {}, found {}", kMostLights, lighting.lights.size()));
  }
  std::set<std::string> ids;
  for (std::size_t i = 0; i < lighting.lights.size(); ++i) {
    const std::string& id = lighting.lights[i].id;
    if (!isId(id)) {
      throw Error(
          Error::Kind::Data,
          fmt::format("lights[{}]: expected an id of 1 to {} letters, digits, '_' or '-', found \"{}\"", i,
                      kLongestId, id));
    }
    if (!ids.insert(id).second)
      throw Error(Error::Kind::Data, fmt::format("lights[{}]: the id \"{}\" is there twice", i, id));
  }
  validateFields(fieldsOf(lighting));
}

const std::vector<std::string>& lightKinds() {
  static const std::vector<std::string> kKinds = {"directional", "point", "spot", "rectangle"};
  return kKinds;
}

std::string kindOf(const Light& light) {
  if (const auto* unknown = std::get_if<UnknownLight>(&light.kind)) return unknown->kind;
  return lightKinds()[light.kind.index()];
}

Light newLight(std::string id, std::string_view kind) {
  Light light;
  light.id = std::move(id);
  if (kind == "directional") {
    light.kind = DirectionalLight{};
  } else if (kind == "point") {
    light.kind = PointLight{};
  } else if (kind == "spot") {
    light.kind = SpotLight{};
  } else if (kind == "rectangle") {
    light.kind = RectangleLight{};
  } else {
    light.kind = UnknownLight{std::string(kind)};
  }
  return light;
}

const Light* lightOf(const Lighting& lighting, std::string_view id) {
  const auto found = std::find_if(lighting.lights.begin(), lighting.lights.end(),
                                  [&](const Light& light) { return light.id == id; });
  return found == lighting.lights.end() ? nullptr : &*found;
}

bool castsShadows(const Light& light) {
  return std::visit(
      [](const auto& kind) {
        if constexpr (requires { kind.shadows; }) return kind.shadows;
        return false;
      },
      light.kind);
}

dvec3 directionTo(const DirectionalLight& light) {
  const double azimuth = glm::radians(light.azimuth_deg), elevation = glm::radians(light.elevation_deg);
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
          std::cos(elevation) * std::cos(azimuth)};
}

dmat3 aimed(const dvec3& position_m, const dvec3& target_m, double roll_deg) {
  const dvec3 to_target = target_m - position_m;
  const double distance_m = glm::length(to_target);
  const dvec3 back = distance_m > 0 ? -to_target / distance_m : dvec3(0, 1, 0);
  const dvec3 level = glm::cross(dvec3(0, 1, 0), back);
  const double sine = glm::length(level);  // of the angle to the vertical
  const dvec3 right = sine > 1e-9 ? level / sine : dvec3(1, 0, 0);
  const dvec3 up = glm::cross(back, right);
  const double c = std::cos(glm::radians(roll_deg)), s = std::sin(glm::radians(roll_deg));
  return {c * right + s * up, c * up - s * right, back};
}

}  // namespace beam
