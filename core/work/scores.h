// SPDX-License-Identifier: Apache-2.0
// Scores of a project, by name: what an evaluation finds, keeps in the project and a report draws.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/method/evaluate.h"

namespace beam {

using Scores = std::map<std::string, double>;  // "psnr", "ssim", "psnr_mask", "angle_deg", "mae_mm", ...
using ScoreTable = std::vector<std::pair<std::string, Scores>>;  // by map, in the evaluator's order
// By frame, then camera ("" for scores of the whole frame), then name: "rgb.psnr", "mesh.chamfer_mm".
using PictureScores = std::map<std::string, std::map<std::string, Scores>>;

// By frame, which of its results was scored.
using ScoredResults = std::map<std::string, std::string>;
inline constexpr const char* kResultsKey = "results";

// Under their names after `prefix`: "", "rgb.". A score that there is none of is left out.
void put(const PictureScore& score, const std::string& prefix, Scores& scores);

// In the project's folder: what its last evaluation found, as means and frame by frame.
inline constexpr const char* kEvaluationFile = "evaluation.json";
inline constexpr const char* kEvaluationFramesFile = "evaluation_frames.json";

// Whether more is better (psnr, ssim); nothing is said of counts.
enum class Better { More, Less, Neither };
Better betterOf(const std::string& score);

// Means over the cameras; scores of the whole frame as they are.
Scores meanOfCameras(const std::map<std::string, Scores>& cameras);

// What the scores are of.
struct ScoreOrigin {
  ScoredResults results = {};  // empty: of pictures that were not drawn from the project
  // From the settings that the frames were solved with to those in force; empty: they are the same.
  std::vector<std::string> setting_changes = {};
};

// The table, with what `origin` knows as members of these names.
std::string scoreJson(const ScoreTable& table, const ScoreOrigin& origin);
// The same, and "over_time": by frame its scores (means over its cameras) and its cameras' own; "worst" by
// score.
std::string scoreJson(const ScoreTable& table, const PictureScores& each, const ScoreOrigin& origin);

}  // namespace beam
