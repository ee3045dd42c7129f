// SPDX-License-Identifier: Apache-2.0
// Presets: JSON files of differences from the defaults, {"surface.iterations": 3000, ...}, one file a preset.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/fields.h"

namespace beam {

// Throws Error{Usage} when there is none of that name (it names the nearest) and Error{Data} when the file
// cannot be understood.
std::map<std::string, FieldValue> loadPreset(const std::filesystem::path& folder, const std::string& name);
// In the order draft, standard, paper, then the rest by name.
std::vector<std::string> presetNamesIn(const std::filesystem::path& folder);

}  // namespace beam
