// SPDX-License-Identifier: Apache-2.0
// Material maps as EXR files of a result: maps/<camera>.<map>.exr, one set a training view.
#pragma once

#include <filesystem>
#include <string>

#include "core/method/bake_materials.h"

namespace beam {

// Those that are there: an empty map writes no file.
void writeMaterialMaps(const std::filesystem::path& folder, const std::string& camera,
                       const MaterialMaps& maps);
bool hasMaterialMaps(const std::filesystem::path& folder, const std::string& camera);
MaterialMaps readMaterialMaps(const std::filesystem::path& folder, const std::string& name,
                              const Camera& camera);
// The others are empty.
MaterialMaps readMaterialWeights(const std::filesystem::path& folder, const std::string& name,
                                 const Camera& camera);

}  // namespace beam
