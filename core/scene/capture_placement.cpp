// SPDX-License-Identifier: Apache-2.0
#include "core/scene/capture_placement.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace beam {
namespace {

constexpr double kSmallest_m = 0.3, kTallest_m = 4;   // a subject in metres: a child's head to a jump
constexpr double kNearest_m = 0.3, kFarthest_m = 30;  // cameras of a rig in metres
constexpr double kRig_m = 3;
constexpr double kFar_m = 10;  // of the subject from the origin; floats are to resolve a skin

struct NamedUnit {
  double unit_m;
  const char* plural;
  std::array<std::string_view, 7> words;
};
constexpr std::array<NamedUnit, 5> kUnits = {
    {{1, "metres", {"m", "metre", "metres", "meter", "meters"}},
     {0.001, "millimetres", {"mm", "millimetre", "millimetres", "millimeter", "millimeters"}},
     {0.01, "centimetres", {"cm", "centimetre", "centimetres", "centimeter", "centimeters"}},
     {0.0254, "inches", {"in", "inch", "inches"}},
     {0.3048, "feet", {"ft", "foot", "feet"}}}};

constexpr std::array<std::pair<UnitFrom, const char*>, 5> kSources = {{{UnitFrom::Convention, "convention"},
                                                                       {UnitFrom::Given, "given"},
                                                                       {UnitFrom::Description, "description"},
                                                                       {UnitFrom::Height, "height"},
                                                                       {UnitFrom::Cameras, "cameras"}}};

// Four digits; 1,712.
std::string amount(double value) {
  if (value < 1000 || value > 1e12) return fmt::format("{:.4g}", value);
  const std::string digits = fmt::format("{:.0f}", value);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

bool plausible(double height_m) { return height_m >= kSmallest_m && height_m <= kTallest_m; }

double unitOf(const SubjectMeasure& m, double height, CapturePlacement& placement) {
  if (height > 0) {
    placement.from = UnitFrom::Height;
    return unitOfHeight(height);
  }
  const double distance = m.focus ? m.focus->distance_m : 1;
  if (!m.focus || (distance >= kNearest_m && distance <= kFarthest_m)) return 1;
  placement.from = UnitFrom::Cameras;
  return kRig_m / distance;
}

// Where the subject stands, or what the cameras look at and are near; nothing where that is not far.
std::optional<dvec3> farPlace(const SubjectMeasure& m, double unit_m) {
  const auto far = [&](const dvec3& x) { return unit_m * glm::length(x) > kFar_m; };
  if (m.subject) {
    const dvec3 middle = 0.5 * (m.subject->low + m.subject->high);
    if (far(middle)) return dvec3(middle.x, m.subject->low.y, middle.z);
  } else if (m.focus && far(m.focus->point) && far(m.focus->middle)) {
    return m.focus->point;
  }
  return std::nullopt;
}

}  // namespace

std::string toText(UnitFrom from) {
  for (const auto& [source, word] : kSources) {
    if (source == from) return word;
  }
  return kSources[0].second;
}

UnitFrom parseUnitFrom(std::string_view text) {
  for (const auto& [source, word] : kSources) {
    if (text == word) return source;
  }
  throw Error(Error::Kind::Data,
              fmt::format("expected convention, given, description, height or cameras, found \"{}\"", text));
}

void validate(const CapturePlacement& p) {
  if (!(p.unit_m > 0) || !std::isfinite(p.unit_m) || !std::isfinite(1 / p.unit_m))
    throw Error(Error::Kind::Data, fmt::format("expected a unit of more than 0 m, found {}", p.unit_m));
  if (!std::isfinite(glm::length(p.origin)))
    throw Error(Error::Kind::Data, "expected an origin of 3 finite numbers");
  if (!(p.height >= 0) || !std::isfinite(p.height))
    throw Error(Error::Kind::Data, fmt::format("expected a height of 0 or more, found {}", p.height));
}

Similarity3 worldFromCapture(UpAxis up, const CapturePlacement& placement) {
  Similarity3 world_from_capture{worldFromCapture(up), placement.unit_m};
  if (placement.origin != dvec3(0))
    world_from_capture.translation = -placement.unit_m * (world_from_capture.rotation * placement.origin);
  return world_from_capture;
}

std::optional<double> unitNamed(std::string_view word) {
  for (const NamedUnit& unit : kUnits) {
    for (const std::string_view known : unit.words) {
      if (!word.empty() && word == known) return unit.unit_m;
    }
  }
  double unit_m = 0;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), unit_m);
  const bool number = failed == std::errc() && end == word.data() + word.size();
  if (!number || !(unit_m >= 1e-9 && unit_m <= 1e9)) return std::nullopt;
  return unit_m;
}

std::string nameOfUnit(double unit_m) {
  for (const NamedUnit& unit : kUnits) {
    if (unit.unit_m == unit_m) return unit.plural;
  }
  return fmt::format("units of {:.4g} m", unit_m);
}

double unitOfHeight(double height) {
  if (plausible(height)) return 1;
  double best = 0;
  for (const NamedUnit& unit : kUnits) {
    const double height_m = height * unit.unit_m;
    if (height_m < 1.2 || height_m > 2.4) continue;
    if (best == 0 || std::abs(height_m - kPerson_m) < std::abs(height * best - kPerson_m)) best = unit.unit_m;
  }
  return best > 0 ? best : kPerson_m / height;
}

CapturePlacement placementOf(const SubjectMeasure& m, const UnitHints& hints, UpAxis up) {
  CapturePlacement p;
  if (m.subject) p.height = m.subject->high.y - m.subject->low.y;
  if (hints.given_m) {
    p.unit_m = *hints.given_m, p.from = UnitFrom::Given;
  } else if (hints.described_m) {
    p.unit_m = *hints.described_m, p.from = UnitFrom::Description;
  } else {
    p.unit_m = unitOf(m, p.height, p);
  }
  if (const std::optional<dvec3> place = farPlace(m, p.unit_m))
    p.origin = glm::transpose(worldFromCapture(up)) * *place;
  return p;
}

std::string toText(const CapturePlacement& p) {
  std::string text = p.height > 0 ? fmt::format("the subject is {} units tall", amount(p.height))
                                  : std::string("how tall the subject is no masks tell");
  text += ": taken as " + nameOfUnit(p.unit_m);
  if (p.from == UnitFrom::Given) text += ", as --unit says";
  if (p.from == UnitFrom::Description) text += ", as the description says";
  if (p.origin != dvec3(0))
    text += fmt::format("; moved to the origin from {} m away", amount(p.unit_m * glm::length(p.origin)));
  return text;
}

std::vector<std::string> doubtsOf(const CapturePlacement& p, std::string_view capture) {
  const bool named = p.from == UnitFrom::Given || p.from == UnitFrom::Description;
  if (named && p.height > 0 && !plausible(p.height * p.unit_m)) {
    const bool given = p.from == UnitFrom::Given;
    return {fmt::format(
        "\"{}\": expected a subject of {} to {} m, found {} m in {}, as {} says; {} units fit "
        "{}: {}",
        capture, kSmallest_m, kTallest_m, amount(p.height * p.unit_m), nameOfUnit(p.unit_m),
        given ? "--unit" : "the description", amount(p.height), nameOfUnit(unitOfHeight(p.height)),
        given ? "take --unit away or name that" : "name that with --unit")};
  }
  if (p.from == UnitFrom::Cameras) {
    return {
        fmt::format("\"{}\": without masks expected cameras {} to {} m from what they look at, found {} "
                    "units; scaled to {} m, name the capture's unit with --unit to have its true size",
                    capture, kNearest_m, kFarthest_m, amount(kRig_m / p.unit_m), kRig_m)};
  }
  return {};
}

}  // namespace beam
