// SPDX-License-Identifier: Apache-2.0
// dataset.json: everything of a capture in one file; x_camera = R x_capture + t, OpenCV axes.
#include <cmath>

#include "core/io/capture_description.h"
#include "core/io/json_reader.h"
#include "core/scene/capture_placement.h"

namespace beam {
namespace {

dmat3 matrixOf(const nlohmann::json& rows, const std::string& where) {
  const auto wrong = [&] {
    throw Error(Error::Kind::Data, fmt::format("{}: expected R as 3 rows of 3 finite numbers", where));
  };
  if (!rows.is_array() || rows.size() != 3) wrong();
  dmat3 m;
  for (int r = 0; r < 3; ++r) {
    if (!rows[r].is_array() || rows[r].size() != 3) wrong();
    for (int c = 0; c < 3; ++c) {
      if (!rows[r][c].is_number() || !std::isfinite(rows[r][c].get<double>())) wrong();
      m[c][r] = rows[r][c].get<double>();
    }
  }
  return m;
}

DescribedCamera cameraOf(const std::string& name, const nlohmann::json& c,
                         const std::filesystem::path& file) {
  const std::string where = fmt::format("\"{}\", camera \"{}\"", file.string(), name);
  DescribedCamera d;
  d.name = name;
  requirePlainName(name, where);
  d.camera.width = pictureSide(c, "width", where);
  d.camera.height = pictureSide(c, "height", where);
  d.camera.intrinsics = {finiteNumber(c, "fx", where), finiteNumber(c, "fy", where),
                         finiteNumber(c, "cx", where), finiteNumber(c, "cy", where)};
  if (!c.contains("R")) throw Error(Error::Kind::Data, fmt::format("{}: expected a rotation R", where));
  d.camera.camera_from_world.rotation = rotationFromMatrix(matrixOf(c["R"], where), where);
  const nlohmann::json t = c.value("t", nlohmann::json());
  if (!t.is_array() || t.size() != 3)
    throw Error(Error::Kind::Data, fmt::format("{}: expected t as 3 numbers", where));
  for (int k = 0; k < 3; ++k) {
    if (!t[k].is_number() || !std::isfinite(t[k].get<double>())) {
      throw Error(Error::Kind::Data,
                  fmt::format("{}: expected t as 3 finite numbers, found {}", where, t.dump()));
    }
    d.camera.camera_from_world.translation_m[k] = t[k].get<double>();
  }
  d.split = c.value("split", "train") == "test" ? Split::Test : Split::Train;
  return d;
}

std::optional<UpAxis> upOf(const nlohmann::json& j) {
  const std::string up = j.contains("world") ? j["world"].value("up", "") : "";
  if (up == "+Z" || up == "Z") return UpAxis::PlusZ;
  if (up == "+Y" || up == "Y") return UpAxis::PlusY;
  if (up == "-Y") return UpAxis::MinusY;
  return std::nullopt;
}

// world.unit, a word or metres a unit.
void readUnit(const nlohmann::json& j, const std::filesystem::path& file, CaptureDescription& d) {
  if (!j.contains("world") || !j["world"].contains("unit")) return;
  const nlohmann::json& unit = j["world"]["unit"];
  const std::string word = unit.is_string() ? unit.get<std::string>() : unit.dump();
  d.unit_m = unitNamed(word);
  if (!d.unit_m) {
    d.warnings.push_back(
        fmt::format("\"{}\": world.unit: expected m, cm, mm, inch, foot or metres a unit, found "
                    "\"{}\"; the subject's height tells instead, or --unit",
                    file.string(), word));
  }
}

// Nothing hangs on the rate but how fast a take plays.
void readRate(const nlohmann::json& j, const std::filesystem::path& file, CaptureDescription& d) {
  constexpr double kLeast = 0.01, kMost = 10000;
  if (!j.contains("fps")) return;
  const double rate = finiteNumber(j, "fps", fmt::format("\"{}\"", file.string()));
  if (rate >= kLeast && rate <= kMost) {
    d.frames_per_second = rate;
    return;
  }
  d.warnings.push_back(fmt::format("\"{}\": expected \"fps\" from {} to {}, found {}; {} is taken",
                                   file.string(), kLeast, kMost, rate, d.frames_per_second));
}

CaptureDescription describe(const nlohmann::json& j, const std::filesystem::path& folder,
                            const std::filesystem::path& file) {
  if (!j.is_object() || !j.contains("cameras") || !j["cameras"].is_object()) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\": expected an object \"cameras\"", file.string()));
  }
  CaptureDescription d;
  d.layout = "dataset.json";
  d.name = j.value("name", folder.filename().string());
  readRate(j, file, d);
  d.up = upOf(j);
  readUnit(j, file, d);
  for (const auto& [name, camera] : j["cameras"].items()) {
    DescribedCamera c = cameraOf(name, camera, file);
    c.pictures = picturesIn(folder / "images" / name);
    d.cameras.push_back(std::move(c));
  }
  return d;
}

}  // namespace

std::optional<CaptureDescription> readDatasetJson(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "dataset.json";
  if (!std::filesystem::exists(file)) return std::nullopt;
  return withJsonErrors(file, [&] { return describe(readJson(file), folder, file); });
}

}  // namespace beam
