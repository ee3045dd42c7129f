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
  writeExr(mapFile(folder, camera, "ao"), maps.ambient_occlusion, kOne, ExrPrecision::Half);
  writeExr(mapFile(folder, camera, "base_color"), maps.base_color, kThree, ExrPrecision::Half);
  // Weights span more decades than halves hold.
  writeExr(mapFile(folder, camera, "ao_weight"), maps.ao_weight, kOne, ExrPrecision::Float);
  writeExr(mapFile(folder, camera, "base_color_weight"), maps.base_color_weight, kOne, ExrPrecision::Float);
}

bool hasMaterialMaps(const std::filesystem::path& folder, const std::string& camera) {
  return std::filesystem::exists(mapFile(folder, camera, "ao"));
}

MaterialMaps readMaterialMaps(const std::filesystem::path& folder, const std::string& name,
                              const Camera& camera) {
  return {camera, readExr(mapFile(folder, name, "ao"), kOne),
          readExr(mapFile(folder, name, "base_color"), kThree),
          readExr(mapFile(folder, name, "ao_weight"), kOne),
          readExr(mapFile(folder, name, "base_color_weight"), kOne)};
}

}  // namespace beam
