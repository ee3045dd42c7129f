// SPDX-License-Identifier: Apache-2.0
// "Save as": a project once more in another folder, under an id of its own.
#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/pipeline/project.h"

namespace beam {

// Settings as they are in memory; every whole result, too, when `with_results` says so: as hard links where
// the file system has them between the two places, because results never change, else as copies. `to` is a
// project once everything is there, and nothing before. Throws Error{Usage} when `to` is no empty folder or
// lies in `from` or around it, Error{Storage}, Cancelled.
void copyProject(const Project& from, const std::filesystem::path& to, bool with_results, Progress& progress);

}  // namespace beam
