// SPDX-License-Identifier: Apache-2.0
#include "core/scene/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/field_text.h"
#include "core/scene/described_values.h"

namespace beam {
namespace {

constexpr std::size_t kLongestName = 100;

bool isChoice(const FieldInfo& info, const std::string& word) {
  return info.choices.empty() ||
         std::find(info.choices.begin(), info.choices.end(), word) != info.choices.end();
}

// Writes what holds at one time into every field that it is shown.
class Moment final : public Fields {
 public:
  Moment(const std::map<std::string, Curve>& curves, double time_s) : curves_(curves), time_s_(time_s) {}

 protected:
  void visit(const FieldInfo& info, FieldPointer target) override {
    if (std::string* const* word = std::get_if<std::string*>(&target)) {
      if (!isChoice(info, **word)) **word = info.choices.front();
      return;
    }
    const auto found = curves_.find(info.name);
    if (found == curves_.end() || found->second.keys.empty()) return;
    const Curve& curve = found->second;
    if (double* const* number = std::get_if<double*>(&target)) **number = valueAt(curve, time_s_);
    if (int* const* count = std::get_if<int*>(&target))
      **count = static_cast<int>(heldValueAt(curve, time_s_));
    if (bool* const* on = std::get_if<bool*>(&target)) **on = heldValueAt(curve, time_s_) != 0;
  }

 private:
  const std::map<std::string, Curve>& curves_;
  double time_s_;
};

// Whether a key of a curve may have this value for the field.
bool fits(const Field& field, double value) {
  if (std::holds_alternative<bool>(field.value)) return value == 0 || value == 1;
  if (std::holds_alternative<int>(field.value) && value != std::floor(value)) return false;
  return std::holds_alternative<std::string>(field.value) ||
         (value >= field.info.min && value <= field.info.max);
}

void validateCurve(const std::string& path, const Curve& curve, const std::map<std::string, Field>& fields) {
  try {
    validate(curve);
  } catch (const Error& e) {
    throw Error(e.kind(), fmt::format("curves.{}.{}", path, e.what()));
  }
  const auto driven = fields.find(path);
  if (driven == fields.end()) return;
  for (std::size_t i = 0; i < curve.keys.size(); ++i) {
    if (fits(driven->second, curve.keys[i].value)) continue;
    const bool is_switch = std::holds_alternative<bool>(driven->second.value);
    throw Error(Error::Kind::Data,
                fmt::format("curves.{}.keys[{}].value: expected {}, found {}", path, i,
                            is_switch ? "0 or 1" : expectedText(driven->second.info, driven->second.value),
                            curve.keys[i].value));
  }
}

std::map<std::string, Field> fieldsByPath(const Look& look) {
  std::map<std::string, Field> fields;
  for (Field& field : fieldsOf(look)) fields.emplace(field.info.name, field);
  return fields;
}

bool isOfUnknownLight(const Look& look, std::string_view path) {
  constexpr std::string_view kLights = "lights.";
  if (!path.starts_with(kLights)) return false;
  path.remove_prefix(kLights.size());
  const Light* light = lightOf(look.lighting, path.substr(0, path.find('.')));
  return light && std::holds_alternative<UnknownLight>(light->kind);
}

// Empty: the curve does what it says.
std::string remarkOn(const Look& look, const std::map<std::string, Field>& fields, const std::string& path,
                     const Curve& curve) {
  const auto driven = fields.find(path);
  if (driven == fields.end()) {
    return isOfUnknownLight(look, path)
               ? ""
               : fmt::format("curve \"{}\" drives nothing: the look has no such field", path);
  }
  if (std::holds_alternative<std::string>(driven->second.value))
    return fmt::format("curve \"{}\" drives nothing: the field is a text", path);
  if (curve.keys.empty()) return fmt::format("curve \"{}\" drives nothing: it has no keys", path);
  for (CurveKey key : curve.keys) {
    FieldList list;
    describe(list, key);
    for (const Field& field : list.fields) {
      const std::string* word = std::get_if<std::string>(&field.value);
      if (!word || isChoice(field.info, *word)) continue;
      return fmt::format("curve \"{}\" has the easing \"{}\", which this program does not know: {} holds",
                         path, *word, field.info.choices.front());
    }
  }
  return "";
}

}  // namespace

void describe(Fields& f, Background& background) {
  f.field({.name = "kind",
           .label = "Background",
           .help = "What is behind the subject where the environment is not.",
           .choices = {"transparent", "color"}},
          background.kind);
  describeColor(f, "color",
                {.name = "", .label = "Background colour", .help = "Scene-linear, before the exposure."},
                background.color);
}

void describe(Fields& f, CameraPath& path) {
  f.field({.name = "kind",
           .label = "Camera path",
           .help = "How the camera moves.",
           .choices = {"none", "turntable", "file"}},
          path.kind);
  describeFile(f, "file", {.name = "", .label = "Path file", .help = "With the kind file: the path."},
               path.file);
}

void describe(Fields& f, Look& look) {
  describe(f, look.lighting);
  f.field({.name = "exposure_stops",
           .label = "Exposure",
           .help = "Each stop doubles the light of the picture.",
           .min = -30,
           .max = 30,
           .unit = "stops"},
          look.exposure_stops);
  f.field({.name = "view_transform",
           .label = "View transform",
           .help = "From scene-linear light to what is shown; raw is for EXR.",
           .choices = {"standard", "neutral", "aces", "agx", "raw"}},
          look.view_transform);
  f.group("background", [&] { describe(f, look.background); });
  f.group("camera_path", [&] { describe(f, look.camera_path); });
}

bool isLookName(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && name.front() != '.' &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return c >= 0x20 && c != 0x7f && c != '/' && c != '\\'; });
}

void validate(const Look& look) {
  validate(look.lighting);
  validateFields(fieldsOf(look));
  if (look.curves.size() > kMostCurves) {
    throw Error(Error::Kind::Data,
                fmt::format("curves: expected at most {}, found {}", kMostCurves, look.curves.size()));
  }
  const std::map<std::string, Field> fields = fieldsByPath(look);
  for (const auto& [path, curve] : look.curves) validateCurve(path, curve, fields);
}

std::vector<std::string> remarks(const Look& look) {
  std::vector<std::string> found;
  for (const Light& light : look.lighting.lights) {
    if (!std::holds_alternative<UnknownLight>(light.kind)) continue;
    found.push_back(
        fmt::format("light \"{}\" is of the kind \"{}\", which this program does not know: it is "
                    "kept and not drawn",
                    light.id, kindOf(light)));
  }
  const std::map<std::string, Field> fields = fieldsByPath(look);
  for (const auto& [path, field] : fields) {
    const std::string* word = std::get_if<std::string>(&field.value);
    if (!word || isChoice(field.info, *word)) continue;
    found.push_back(fmt::format("{} is \"{}\", which this program does not know: {} holds", path, *word,
                                field.info.choices.front()));
  }
  for (const auto& [path, curve] : look.curves) {
    if (std::string remark = remarkOn(look, fields, path, curve); !remark.empty())
      found.push_back(std::move(remark));
  }
  return found;
}

Look at(const Look& look, double time_s) {
  Look now = look;
  now.curves.clear();
  Moment moment(look.curves, time_s);
  describe(moment, now);
  return now;
}

void setField(Look& look, const std::string& path, const FieldValue& value) {
  FieldSetter setter(path, value);
  describe(setter, look);
  if (setter.found) return;
  std::vector<std::string> names;
  for (const Field& field : fieldsOf(look)) names.push_back(field.info.name);
  throw Error(Error::Kind::Usage, noSuchName("setting of a look", path, names,
                                             fmt::format("there are {}", fmt::join(names, ", "))));
}

}  // namespace beam
