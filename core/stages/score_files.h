// SPDX-License-Identifier: Apache-2.0
// The files of surface.score: scores.json and thumbs.png (one row a camera: photograph, render).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/method/score_views.h"

namespace beam {

// `downscale` says at which resolution was scored.
void writeScores(const std::filesystem::path& folder, const std::vector<ViewScore>& scores, int downscale);
// Throws Error{Data} naming the file that cannot be understood, and what to do.
std::vector<ViewScore> readScores(const std::filesystem::path& folder);

}  // namespace beam
