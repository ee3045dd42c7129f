// SPDX-License-Identifier: Apache-2.0
#include "core/scene/scene_document.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/error.h"
#include "core/scene/described_values.h"

namespace beam {
namespace {

constexpr double kRotationTolerance = 1e-6;

void describeSurface(Fields& f, dvec3& base_color, double& roughness) {
  describeColor(
      f, "base_color",
      {.name = "", .label = "Base colour", .help = "Share of the light that is sent back.", .max = 1},
      base_color);
  f.field({.name = "roughness",
           .label = "Roughness",
           .help = "From a mirror-like surface to a dull one.",
           .min = 0.04,
           .max = 1},
          roughness);
}

void validateSimilarity(const Similarity3& s, const char* name) {
  const dmat3 product = glm::transpose(s.rotation) * s.rotation;
  double largest = 0;
  bool finite = std::isfinite(s.scale);
  for (int i = 0; i < 3; ++i) {
    finite = finite && std::isfinite(s.translation[i]);
    for (int k = 0; k < 3; ++k) largest = std::fmax(largest, std::abs(product[i][k] - (i == k ? 1 : 0)));
  }
  if (!(largest <= kRotationTolerance) || !(glm::determinant(s.rotation) > 0)) {
    throw Error(Error::Kind::Data,
                fmt::format("{}.rotation: expected rows of length 1 at right angles to each other without a "
                            "mirror, found one that is off by {:.2g}",
                            name, largest));
  }
  if (!finite || !(s.scale > 0)) {
    throw Error(Error::Kind::Data,
                fmt::format("{}: expected a scale over 0 and a finite translation, found {} and {}, {}, {}",
                            name, s.scale, s.translation.x, s.translation.y, s.translation.z));
  }
}

void atMost(std::size_t most, std::size_t found, const char* what) {
  if (found > most)
    throw Error(Error::Kind::Data, fmt::format("{}: expected at most {}, found {}", what, most, found));
}

// Runs body(); what it throws begins with the place.
template <class Body>
void under(const std::string& place, Body&& body) {
  try {
    body();
  } catch (const Error& e) {
    throw Error(e.kind(), fmt::format("{}.{}", place, e.what()));
  }
}

}  // namespace

void describe(Fields& f, Performance& performance) {
  describeFile(f, "project", {.name = "", .label = "Project", .help = "The folder of the performance."},
               performance.project);
  f.field({.name = "frames", .label = "Frames", .help = "Those that are shown: all, 0-7 or 1,5 or 1-9x2."},
          performance.frames);
  f.field({.name = "time_offset_s",
           .label = "Start",
           .help = "When its first frame is due.",
           .min = -kFarthestTime_s,
           .max = kFarthestTime_s,
           .unit = "s"},
          performance.time_offset_s);
  f.field({.name = "speed",
           .label = "Speed",
           .help = "Times the rate that it was taken at; 0 stands still.",
           .min = 0,
           .max = 1000},
          performance.speed);
}

void describe(Fields& f, SceneMesh& mesh) {
  describeFile(f, "file", {.name = "", .label = "Mesh", .help = "The file of its triangles."}, mesh.file);
  describeSurface(f, mesh.base_color, mesh.roughness);
}

void describe(Fields& f, Ground& ground) {
  f.field({.name = "enabled", .label = "Ground", .help = "Whether there is one."}, ground.enabled);
  f.field({.name = "height_m", .label = "Height", .help = "Of the ground over the origin.", .unit = "m"},
          ground.height_m);
  describeSurface(f, ground.base_color, ground.roughness);
}

void validate(const SceneDocument& document) {
  atMost(kMostPerformances, document.performances.size(), "performances");
  atMost(kMostMeshes, document.meshes.size(), "meshes");
  for (std::size_t i = 0; i < document.performances.size(); ++i) {
    under(fmt::format("performances[{}]", i), [&] {
      validateFields(fieldsOf(document.performances[i]));
      validateSimilarity(document.performances[i].scene_from_performance, "scene_from_performance");
    });
  }
  for (std::size_t i = 0; i < document.meshes.size(); ++i) {
    under(fmt::format("meshes[{}]", i), [&] {
      validateFields(fieldsOf(document.meshes[i]));
      validateSimilarity(document.meshes[i].scene_from_mesh, "scene_from_mesh");
    });
  }
  under("ground", [&] { validateFields(fieldsOf(document.ground)); });
  under("look", [&] { validate(document.look); });
}

}  // namespace beam
