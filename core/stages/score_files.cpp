// SPDX-License-Identifier: Apache-2.0
#include "core/stages/score_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/json_words.h"
#include "core/io/file.h"
#include "core/io/image_file.h"
#include "core/stages/unclear_file.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kScoresFile = "scores.json";
constexpr const char* kThumbsFile = "thumbs.png";

const char* splitOf(const ViewScore& s) { return s.left_out ? "left_out" : s.held_out ? "test" : "train"; }

void put(const PictureScore& score, Json& j) {
  j["psnr"] = score.psnr;
  if (score.ssim) j["ssim"] = *score.ssim;
  j["psnr_mask"] = score.psnr_mask;
}

Json toJson(const SplitScore& split, const std::vector<ViewScore>& scores) {
  Json j;
  put(split.mean, j);
  j["cameras"] = split.n;
  j["worst"] = scores[split.worst].camera;
  return j;
}

Json toJson(const ViewScore& s) {
  Json j = {{"camera", s.camera}, {"split", splitOf(s)}};
  put(s.score, j);
  j["photo_luma"] = s.photo_luma;
  j["render_luma"] = s.render_luma;
  j["photo_sharpness"] = s.photo_sharpness;
  j["render_sharpness"] = s.render_sharpness;
  return j;
}

void paste(const Image<std::uint8_t>& thumb, int x0, int y0, Image<std::uint8_t>& sheet) {
  for (int y = 0; y < thumb.height; ++y) {
    std::copy_n(&thumb.pixels[thumb.index(0, y)], thumb.width, &sheet.pixels[sheet.index(x0, y0 + y)]);
  }
}

Image<std::uint8_t> cut(const Image<std::uint8_t>& sheet, int x0, int y0) {
  Image<std::uint8_t> thumb(kThumbSide_px, kThumbSide_px);
  for (int y = 0; y < thumb.height; ++y) {
    std::copy_n(&sheet.pixels[sheet.index(x0, y0 + y)], thumb.width, &thumb.pixels[thumb.index(0, y)]);
  }
  return thumb;
}

ViewScore scoreOf(const Json& j) {
  ViewScore s;
  s.camera = j.at("camera").get<std::string>();
  const auto split = j.at("split").get<std::string>();
  s.held_out = split == "test";
  s.left_out = split == "left_out";
  s.score = {.psnr = j.at("psnr").get<double>(), .psnr_mask = j.at("psnr_mask").get<double>()};
  if (j.contains("ssim")) s.score.ssim = j["ssim"].get<double>();
  s.photo_luma = j.at("photo_luma").get<double>();
  s.render_luma = j.at("render_luma").get<double>();
  s.photo_sharpness = j.at("photo_sharpness").get<double>();
  s.render_sharpness = j.at("render_sharpness").get<double>();
  return s;
}

}  // namespace

void writeScores(const fs::path& folder, const std::vector<ViewScore>& scores, int downscale) {
  Json j = {{"downscale", downscale}};
  for (const bool held_out : {false, true}) {
    const SplitScore split = meanOf(scores, held_out);
    if (split.n > 0) j[held_out ? "test" : "train"] = toJson(split, scores);
  }
  j["views"] = Json::array();
  Image<std::uint8_t> sheet(2 * kThumbSide_px, kThumbSide_px * std::max(1, static_cast<int>(scores.size())));
  int y0 = 0;
  for (const ViewScore& s : scores) {
    j["views"].push_back(toJson(s));
    paste(s.photo_thumb, 0, y0, sheet);
    paste(s.render_thumb, kThumbSide_px, y0, sheet);
    y0 += kThumbSide_px;
  }
  writeFileAtomically(folder / kScoresFile, j.dump(1) + "\n");
  writePng(folder / kThumbsFile, sheet);
}

std::vector<ViewScore> readScores(const fs::path& folder) {
  const fs::path file = folder / kScoresFile;
  try {
    const Json j = Json::parse(readTextFile(file));
    std::vector<ViewScore> scores;
    for (const Json& view : j.at("views")) scores.push_back(scoreOf(view));
    const Image<std::uint8_t> sheet = readMask(folder / kThumbsFile);
    if (sheet.width != 2 * kThumbSide_px || sheet.height < kThumbSide_px * static_cast<int>(scores.size())) {
      throw unclearFile(
          folder / kThumbsFile,
          fmt::format("expected a pair of thumbnails for each of {} cameras, found {} x {} pixels",
                      scores.size(), sheet.width, sheet.height));
    }
    for (std::size_t i = 0; i < scores.size(); ++i) {
      const int y0 = static_cast<int>(i) * kThumbSide_px;
      scores[i].photo_thumb = cut(sheet, 0, y0);
      scores[i].render_thumb = cut(sheet, kThumbSide_px, y0);
    }
    return scores;
  } catch (const nlohmann::json::exception& e) {
    throw unclearFile(file, jsonComplaint(e));
  }
}

}  // namespace beam
