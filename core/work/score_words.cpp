// SPDX-License-Identifier: Apache-2.0
#include "core/work/score_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "core/scene/channel.h"

namespace beam {
namespace {

struct Row {
  const char *name, *label, *unit;
};
// Those that the stages keep and that evaluations find. Energies have the names of the method; those of
// radiance and base colour are mean absolute changes of values in [0, 1].
constexpr Row kScores[] = {{"seconds", "time", "s"},
                           {"training_cameras", "training cameras", ""},
                           {"test_cameras", "held-out cameras", ""},
                           {"left_out", "cameras left out", ""},
                           {"joints", "number of joints", ""},
                           {"restart", "restart", "1: the joints start anew"},
                           {"residual", "mean difference from the photographs", "0 to 1"},
                           {"motion_p95_m", "motion, 95th percentile", "m"},
                           {"e_rigid", "E_rigid", "m²"},
                           {"e_smooth", "E_smooth", "m²"},
                           {"e_temp", "E_temp", ""},
                           {"points", "seed points", ""},
                           {"gaussians", "Gaussians", ""},
                           {"triangles", "triangles", ""},
                           {"views", "views with baked maps", ""},
                           {"flicker_radiance", "flicker of radiance", "0 to 1"},
                           {"flicker_base_color", "flicker of base colour", "0 to 1"},
                           {"psnr", "PSNR", "dB"},
                           {"psnr_mask", "PSNR inside the mask", "dB"},
                           {"psnr_train", "PSNR, training views", "dB"},
                           {"psnr_test", "PSNR, held-out views", "dB"},
                           {"psnr_worst_train", "PSNR, worst training view", "dB"},
                           {"psnr_worst_test", "PSNR, worst held-out view", "dB"},
                           {"ssim", "SSIM", ""},
                           {"ssim_train", "SSIM, training views", ""},
                           {"ssim_test", "SSIM, held-out views", ""},
                           {"pictures", "pictures", ""},
                           {"angle_deg", "mean angle to the truth", "degrees"},
                           {"mae_mm", "mean distance from the truth", "mm"},
                           {"chamfer_mm", "chamfer distance", "mm"},
                           {"pred_to_gt_mm", "distance to the truth", "mm"},
                           {"gt_to_pred_mm", "distance from the truth", "mm"},
                           {"median_mm", "median", "mm"},
                           {"p95_mm", "95th percentile", "mm"},
                           {"radiance", "radiance at true points", "0 to 1"},
                           {"base_color", "base colour at true points", "0 to 1"},
                           {"gaussian_radiance", "radiance along Gaussians", "0 to 1"},
                           {"gaussian_base_color", "base colour along Gaussians", "0 to 1"}};

struct Unit {
  const char *ending, *words;
};
// Names of scores end in their units, as every name of the house does.
constexpr Unit kUnits[] = {{"_deg", "degrees"}, {"_mm", "mm"}, {"_m", "m"}, {"_m2", "m²"},
                           {"_px", "pixels"},   {"_db", "dB"}, {"_s", "s"}, {"_mb", "MB"}};

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string withSpaces(std::string name) { return replaced(std::move(name), "_", " "); }

std::string lowerFirst(std::string words) {
  const auto capital = [&](std::size_t i) { return std::isupper(static_cast<unsigned char>(words[i])) != 0; };
  // An abbreviation keeps its capitals.
  if (!words.empty() && !(words.size() > 1 && capital(1)))
    words[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(words[0])));
  return words;
}

std::string upperFirst(std::string words) {
  if (!words.empty()) words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
}

// Titles of a stage and of its step; empty: there are none.
std::pair<std::string, std::string> titlesOf(const std::vector<StageInfo>& stages, const StepId& step) {
  for (const StageInfo& stage : stages) {
    for (const StepInfo& info : stage.steps) {
      if (stage.id == step.stage() && info.id == step.name()) return {stage.title, info.title};
    }
  }
  return {};
}

}  // namespace

std::string titleOf(const ScoreWords& words) {
  return words.unit.empty() ? words.label : fmt::format("{} ({})", words.label, words.unit);
}

ScoreWords scoreWords(const std::string& score) {
  for (const Row& known : kScores) {
    if (score == known.name) return {known.label, known.unit};
  }
  ScoreWords words{score, {}};
  for (const Unit& known : kUnits) {
    if (!score.ends_with(known.ending)) continue;
    words.unit = known.words;
    words.label.resize(score.size() - std::string_view(known.ending).size());
    break;
  }
  words.label = replaced(withSpaces(words.label), "psnr", "PSNR");
  words.label = replaced(replaced(words.label, "ssim", "SSIM"), "color", "colour");
  return words;
}

std::string titleOfStep(const std::vector<StageInfo>& stages, const StepId& step) {
  const auto [stage, title] = titlesOf(stages, step);
  return stage.empty() ? step.text() : fmt::format("{}: {}", stage, lowerFirst(title));
}

std::string mapTitle(const std::string& map) {
  constexpr std::string_view kScaled = "_scaled";
  if (map.ends_with(kScaled))
    return fmt::format("{}, scaled", mapTitle(map.substr(0, map.size() - kScaled.size())));
  if (map == "rgb_held_out") return "Held-out photographs";
  if (const ChannelInfo* channel = findChannel(map)) return channel->title;
  const std::string relit = fmt::format("{}_", kRelightChannel);
  if (map.starts_with(relit))
    return fmt::format("{}, {}", channelOf(kRelightChannel).title, withSpaces(map.substr(relit.size())));
  return upperFirst(withSpaces(map));
}

CurveWords curveWords(const std::vector<StageInfo>& stages, const std::string& curve) {
  const std::size_t first = curve.find('.'), last = curve.rfind('.');
  if (first == std::string::npos || first == last) return {{}, {curve, {}}};
  if (curve.starts_with(kEvaluateCurves)) {
    ScoreWords words = scoreWords(curve.substr(last + 1));
    words.label = fmt::format("{}: {}", mapTitle(curve.substr(first + 1, last - first - 1)), words.label);
    return {"Evaluation", std::move(words)};
  }
  const std::size_t second = curve.find('.', first + 1);
  const auto [stage, step] = titlesOf(stages, StepId(curve.substr(0, second)));
  if (stage.empty()) return {{}, {curve, {}}};
  // "Track joints" says "Track" already.
  return {step.starts_with(stage) ? step : fmt::format("{}, {}", stage, lowerFirst(step)),
          scoreWords(curve.substr(second + 1))};
}

std::string titleOf(const CurveWords& words) {
  return words.where.empty() ? titleOf(words.score)
                             : fmt::format("{}: {}", words.where, titleOf(words.score));
}

}  // namespace beam
