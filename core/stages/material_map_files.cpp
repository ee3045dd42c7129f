// SPDX-License-Identifier: Apache-2.0
#include "core/stages/material_map_files.h"

#include <vector>

#include "core/io/image_file.h"

namespace beam {
namespace {

const std::vector<std::string> kOne = {"Y"}, kThree = {"R", "G", "B"};

std::filesystem::path mapFile(const std::filesystem::path& folder, const std::string& camera,
                              const char* map) {
  return folder / (camera + "." + map + ".exr");
}

}  // namespace

void writeMaterialMaps(const std::filesystem::path& folder, const std::string& camera,
                       const MaterialMaps& maps) {
  const auto write = [&](const char* map, const Planes& values, const std::vector<std::string>& channels,
                         ExrPrecision precision) {
    if (!values.empty()) writeExr(mapFile(folder, camera, map), values, channels, precision);
  };
  write("ao", maps.ambient_occlusion, kOne, ExrPrecision::Half);
  write("base_color", maps.base_color, kThree, ExrPrecision::Half);
  // Weights span more decades than halves hold.
  write("ao_weight", maps.ao_weight, kOne, ExrPrecision::Float);
  write("base_color_weight", maps.base_color_weight, kOne, ExrPrecision::Float);
}

bool hasMaterialMaps(const std::filesystem::path& folder, const std::string& camera) {
  return std::filesystem::exists(mapFile(folder, camera, "ao"));
}

MaterialMaps readMaterialWeights(const std::filesystem::path& folder, const std::string& name,
                                 const Camera& camera) {
  return {camera,
          {},
          {},
          readExr(mapFile(folder, name, "ao_weight"), kOne),
          readExr(mapFile(folder, name, "base_color_weight"), kOne)};
}

MaterialMaps readMaterialMaps(const std::filesystem::path& folder, const std::string& name,
                              const Camera& camera) {
  return {camera, readExr(mapFile(folder, name, "ao"), kOne),
          readExr(mapFile(folder, name, "base_color"), kThree),
          readExr(mapFile(folder, name, "ao_weight"), kOne),
          readExr(mapFile(folder, name, "base_color_weight"), kOne)};
}

}  // namespace beam
