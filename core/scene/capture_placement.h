// SPDX-License-Identifier: Apache-2.0
// Where a capture lies in the world: its unit and its origin, and the rule that finds them, so that
// results do not depend on either. A capture in metres near its origin is only turned.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/capture.h"
#include "core/scene/measure_subject.h"

namespace beam {

inline constexpr double kPerson_m = 1.75;  // tall; as what nothing tells the size of is taken

// What told the unit; kept in projects by these names.
enum class UnitFrom {
  Convention,   // nothing else did: metres
  Given,        // --unit
  Description,  // the capture's own
  Height,       // of the subject
  Cameras,      // their distance, without masks
};
std::string toText(UnitFrom from);              // "convention", "given", "description", "height", "cameras"
UnitFrom parseUnitFrom(std::string_view text);  // throws Error{Data}

struct CapturePlacement {
  double unit_m = 1;        // metres a unit of the capture, > 0
  dvec3 origin = dvec3(0);  // of the world, in the capture's own axes and unit
  UnitFrom from = UnitFrom::Convention;
  double height = 0;  // of the subject, in the capture's unit; 0: not known
  bool operator==(const CapturePlacement&) const = default;
};
// Throws Error{Data} that says what is no number or no size.
void validate(const CapturePlacement& placement);

// The pure turn of the axes where the unit is the metre and the origin is the capture's own.
Similarity3 worldFromCapture(UpAxis up, const CapturePlacement& placement);

// Metres a unit: "m", "cm", "mm", "inch", "foot", their long names, or a number; nothing for other words.
std::optional<double> unitNamed(std::string_view word);
std::string nameOfUnit(double unit_m);  // "millimetres", "units of 0.35 m"

struct UnitHints {
  std::optional<double> given_m, described_m;  // metres a unit
};
// `subject` as measured in the capture's own unit, its axes turned by `up`.
CapturePlacement placementOf(const SubjectMeasure& subject, const UnitHints& hints, UpAxis up);

// The metres of a unit in which a subject of `height` units has a person's size: exactly 1 for 0.3 to 4.
double unitOfHeight(double height);

// "the subject is 1,712 units tall: taken as millimetres"; with where it is moved from.
std::string toText(const CapturePlacement& placement);
// What is to be doubted of it, each a whole sentence that names `capture`.
std::vector<std::string> doubtsOf(const CapturePlacement& placement, std::string_view capture);

}  // namespace beam
