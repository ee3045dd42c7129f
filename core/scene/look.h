// SPDX-License-Identifier: Apache-2.0
// Look: how a subject is lit and shown, with a name; what people keep, compare, undo and send on. Values and
// what drives them over time stand beside each other: at() gives the plain values of a moment.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/fields.h"
#include "core/base/file_reference.h"
#include "core/math/types.h"
#include "core/scene/curve.h"
#include "core/scene/lighting.h"

namespace beam {

// What is behind the subject where the environment is not.
struct Background {
  std::string kind = "transparent";  // or "color"
  dvec3 color = dvec3(0);            // scene-linear Rec.709, before exposure and view transform
  std::string unknown = "{}";        // members of a later version, kept as they are (a JSON object)

  bool operator==(const Background&) const = default;
};
void describe(Fields& f, Background& background);

// How the camera moves.
struct CameraPath {
  std::string kind = "none";  // it does not; or "turntable", or "file"
  FileReference file = {};    // of "file"
  std::string unknown = "{}";

  bool operator==(const CameraPath&) const = default;
};
void describe(Fields& f, CameraPath& path);

struct Look {
  std::string name;  // in a project: see isLookName; may be empty in a file of its own
  Lighting lighting;
  double exposure_stops = 0;  // pictures are multiplied by 2^stops before the view transform
  // From scene-linear to what is shown: "standard" (sRGB curve, clipped), "neutral" (Khronos PBR Neutral),
  // "aces", "agx", "raw" (scene-linear, for EXR).
  std::string view_transform = "standard";
  Background background;
  CameraPath camera_path;
  // By the path of the number or switch that they drive, as describe() lists it: "exposure_stops",
  // "environment.rotation_deg", "lights.<id>.intensity". Of a switch: 0 off, 1 on, held between keys.
  std::map<std::string, Curve> curves;
  std::string unknown = "{}";

  bool operator==(const Look&) const = default;
};
// Every scalar but the name; ids of lights, which keep it together, are part of the paths.
void describe(Fields& f, Look& look);

inline constexpr std::size_t kMostCurves = 4096;
inline constexpr std::size_t kMostLooks = 1000;  // of a project

// 1 to 100 bytes without '/', '\' and control characters, no dot at the beginning: it names files.
bool isLookName(std::string_view name);

// Throws Error{Data} that names the place: lighting or a number that is not valid, more than kMostCurves, a
// curve that is not valid or leaves the range of the field that it drives (0 or 1 of a switch). What this
// program does not know is no error; see remarks.
void validate(const Look& look);

// What is kept and has no effect, a sentence each: lights of a later version, words that are not among the
// choices of their field, curves without keys and those whose path names nothing that is there, or a text.
// A light that comes back finds its curves.
std::vector<std::string> remarks(const Look& look);

// The look at a moment, without curves; a word that is not among the choices of its field is replaced by the
// first of them, which holds when nothing is said. `look` is valid, `time_s` finite.
Look at(const Look& look, double time_s);

// Sets the field of that path, without regard to curves. Throws Error{Usage}: no such field (names the
// nearest), wrong type, out of range, not among the choices.
void setField(Look& look, const std::string& path, const FieldValue& value);

}  // namespace beam
