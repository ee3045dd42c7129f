// SPDX-License-Identifier: Apache-2.0
#include "core/stages/screening_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json_words.h"
#include "core/io/file.h"
#include "core/stages/unclear_file.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kScreeningFile = "screening.json";
constexpr ScreenKind kKinds[] = {ScreenKind::Black, ScreenKind::Blurred, ScreenKind::Outline};

Json toJson(const std::vector<ScreenedView>& views) {
  Json list = Json::array();
  for (const ScreenedView& v : views) {
    list.push_back({{"camera", v.camera}, {"kind", toText(v.kind)}, {"figure", v.figure}, {"text", v.text}});
  }
  return list;
}

std::vector<ScreenedView> viewsOf(const Json& list) {
  std::vector<ScreenedView> views;
  for (const Json& j : list) {
    const auto kind = j.at("kind").get<std::string>();
    const auto* found =
        std::find_if(std::begin(kKinds), std::end(kKinds), [&](ScreenKind k) { return kind == toText(k); });
    if (found == std::end(kKinds))
      throw Error(Error::Kind::Data, fmt::format("there is no finding \"{}\"", kind));
    views.push_back({j.at("camera").get<std::string>(), *found, j.at("figure").get<double>(),
                     j.at("text").get<std::string>()});
  }
  return views;
}

}  // namespace

bool FrameScreening::leavesOut(const std::string& camera) const {
  return std::any_of(left_out.begin(), left_out.end(),
                     [&](const ScreenedView& v) { return v.camera == camera; });
}

void writeScreening(const fs::path& folder, const FrameScreening& screening,
                    const std::vector<ScreenFigures>& figures) {
  Json j = {{"enabled", screening.enabled},
            {"cameras", screening.cameras},
            {"left_out", toJson(screening.left_out)},
            {"suspects", toJson(screening.suspects)},
            {"figures", Json::array()}};
  for (const ScreenFigures& f : figures) {
    j["figures"].push_back(
        {{"camera", f.camera}, {"bright", f.bright}, {"detail", f.detail}, {"outline", f.outline}});
  }
  writeFileAtomically(folder / kScreeningFile, j.dump(1) + "\n");
}

FrameScreening readScreening(const fs::path& folder) {
  const fs::path file = folder / kScreeningFile;
  const std::string text = readTextFile(file);
  try {
    const Json j = Json::parse(text);
    return {j.at("enabled").get<bool>(), j.at("cameras").get<std::size_t>(), viewsOf(j.at("left_out")),
            viewsOf(j.at("suspects"))};
  } catch (const nlohmann::json::exception& e) {
    throw unclearFile(file, jsonComplaint(e));
  } catch (const Error& e) {
    throw unclearFile(file, e.what());
  }
}

}  // namespace beam
