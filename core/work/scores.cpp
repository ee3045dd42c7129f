// SPDX-License-Identifier: Apache-2.0
#include "core/work/scores.h"

#include <nlohmann/json.hpp>

namespace beam {
namespace {

using Json = nlohmann::ordered_json;

Json tableJson(const ScoreTable& table, const ScoreOrigin& origin) {
  Json j = Json::object();
  if (!origin.setting_changes.empty()) j["setting_changes"] = origin.setting_changes;
  if (!origin.results.empty()) j[kResultsKey] = origin.results;
  for (const auto& [name, scores] : table) {
    for (const auto& [key, value] : scores) j[name][key] = value;
  }
  return j;
}

Json worstOf(const PictureScores& each) {
  struct Worst {
    double value = 0;
    std::string frame, camera;
  };
  std::map<std::string, Worst> worst;
  for (const auto& [frame, cameras] : each) {
    for (const auto& [camera, scores] : cameras) {
      for (const auto& [name, value] : scores) {
        const auto found = worst.find(name);
        const bool more = betterOf(name) == Better::More;
        if (found == worst.end() || (more ? value < found->second.value : value > found->second.value))
          worst[name] = {value, frame, camera};
      }
    }
  }
  Json j = Json::object();
  for (const auto& [name, w] : worst) {
    j[name] = {{"value", w.value}, {"frame", w.frame}};
    if (!w.camera.empty()) j[name]["camera"] = w.camera;
  }
  return j;
}

}  // namespace

void put(const PictureScore& score, const std::string& prefix, Scores& scores) {
  scores[prefix + "psnr"] = score.psnr;
  if (score.ssim) scores[prefix + "ssim"] = *score.ssim;
  scores[prefix + "psnr_mask"] = score.psnr_mask;
}

Better betterOf(const std::string& score) {
  const auto holds = [&](const char* word) { return score.find(word) != std::string::npos; };
  if (holds("psnr") || holds("ssim")) return Better::More;
  for (const char* word : {"loss", "residual", "e_", "error", "chamfer", "angle", "_mm", "flicker"}) {
    if (holds(word)) return Better::Less;
  }
  return Better::Neither;
}

Scores meanOfCameras(const std::map<std::string, Scores>& cameras) {
  std::map<std::string, std::pair<double, double>> sums;
  for (const auto& [camera, scores] : cameras) {
    for (const auto& [name, value] : scores) sums[name].first += value, ++sums[name].second;
  }
  Scores mean;
  for (const auto& [name, sum] : sums) mean[name] = sum.first / sum.second;
  return mean;
}

std::string scoreJson(const ScoreTable& table, const ScoreOrigin& origin) {
  return tableJson(table, origin).dump(1, ' ', false, Json::error_handler_t::replace);
}

std::string scoreJson(const ScoreTable& table, const PictureScores& each, const ScoreOrigin& origin) {
  Json j = tableJson(table, origin);
  Json frames = Json::object();
  for (const auto& [frame, cameras] : each) {
    frames[frame]["scores"] = meanOfCameras(cameras);
    for (const auto& [camera, scores] : cameras) {
      if (!camera.empty()) frames[frame]["cameras"][camera] = scores;
    }
  }
  j["over_time"] = {{"frames", std::move(frames)}, {"worst", worstOf(each)}};
  return j.dump(1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace beam
