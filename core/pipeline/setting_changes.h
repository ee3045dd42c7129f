// SPDX-License-Identifier: Apache-2.0
// What tells the settings in force from those that results were made with, in words for people; and the
// settings that a project had before.
#pragma once

#include <string>
#include <vector>

#include "core/pipeline/project.h"

namespace beam {

// "surface.iterations 900 → 500".
std::string changeText(std::string_view what, std::string_view before, std::string_view now);

// Of everything that changes results: settings, light, held-out cameras, up axis, unit and origin.
std::vector<std::string> settingChanges(const Project& before, const Project& now);

// The project with each of the versions in its history/ in force, the newest first, none twice and none like
// the present one; versions that cannot be read, or name settings that this program does not have, are left
// out. Those with takes of their own come a second time with these.
std::vector<Project> earlierVersions(const Project& project);

}  // namespace beam
