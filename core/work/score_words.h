// SPDX-License-Identifier: Apache-2.0
// How scores are called where people read them: one table of labels and units for the window, the report and
// whoever else shows some. JSON and records keep the names.
#pragma once

#include <string>
#include <vector>

#include "core/pipeline/stage.h"
#include "core/pipeline/step_id.h"

namespace beam {

struct ScoreWords {
  std::string label;  // "PSNR, training views"
  std::string unit;   // "dB", "0 to 1"; empty: it has none
  bool operator==(const ScoreWords&) const = default;
};
std::string titleOf(const ScoreWords& words);  // "PSNR, training views (dB)"

// Of a score as steps and evaluations name it: "psnr_train", "chamfer_mm". One that the table does not know
// has its unit by the end of its name.
ScoreWords scoreWords(const std::string& score);

// "surface.fit" -> "Surface: fit appearance"; an id that no stage has stays as it is.
std::string titleOfStep(const std::vector<StageInfo>& stages, const StepId& step);

// What an evaluation compared: "base_color_scaled" -> "Base colour, scaled".
std::string mapTitle(const std::string& map);

// A score under its full name: where it comes from, and its words. "surface.fit.seconds": "Surface, fit
// appearance" and "time"; "evaluate.mesh.chamfer_mm": "Evaluation" and "Mesh: chamfer distance". Where nobody
// knows the place, `where` is empty and the label is the name.
struct CurveWords {
  std::string where;
  ScoreWords score;
};
CurveWords curveWords(const std::vector<StageInfo>& stages, const std::string& curve);
std::string titleOf(const CurveWords& words);  // "Surface, fit appearance: time (s)"

inline constexpr const char* kEvaluateCurves = "evaluate.";  // begins the names of what an evaluation found

}  // namespace beam
