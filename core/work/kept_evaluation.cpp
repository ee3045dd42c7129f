// SPDX-License-Identifier: Apache-2.0
#include "core/work/kept_evaluation.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/base/count_text.h"
#include "core/base/json_words.h"
#include "core/base/log.h"
#include "core/base/word_list.h"
#include "core/io/file.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Scores numbersIn(const Json& object) {
  Scores numbers;
  for (const auto& [name, value] : object.items())
    if (value.is_number()) numbers[name] = value.template get<double>();
  return numbers;
}

ScoreTable tableIn(const Json& json) {
  ScoreTable table;
  for (const auto& [map, scores] : json.items()) {
    if (!scores.is_object()) continue;
    if (Scores row = numbersIn(scores); !row.empty()) table.emplace_back(map, std::move(row));
  }
  return table;
}

}  // namespace

ScoredResults resultsOf(const GaussianSequence& sequence, const std::vector<FrameIndex>& frames,
                        const Lighting& lighting) {
  const bool usual = lighting.environment.shadows != kOcclusionAlone;
  const std::string lit = usual ? std::string() : fmt::format(" {}", kOcclusionAlone);
  ScoredResults results;
  for (const FrameIndex frame : frames) {
    const Digest stamp = sequence.stamp(frame).value_or(Digest{});
    if (stamp != Digest{}) results[nameOf(sequence, frame)] = stamp.hex() + lit;
  }
  return results;
}

// One file has all of it: two could be of two evaluations.
KeptEvaluation keptEvaluation(const Project& project) {
  const fs::path file = project.folder() / kEvaluationFramesFile;
  if (!fs::exists(file)) return {};
  try {
    const Json json = Json::parse(readTextFile(file));
    KeptEvaluation kept{tableIn(json), {}, {}};
    for (const auto& [frame, entry] : json.at("over_time").at("frames").items())
      kept.frames[frame] = numbersIn(entry.at("scores"));
    if (json.contains(kResultsKey)) kept.results = json.at(kResultsKey).get<ScoredResults>();
    return kept;
  } catch (const nlohmann::json::exception& e) {
    logWarning("\"{}\" cannot be understood and is left out of the report: {}", file.string(),
               jsonComplaint(e));
  }
  return {};
}

bool isOf(const KeptEvaluation& evaluation, const ScoredResults& shown, const std::string& frame) {
  const auto scored = evaluation.results.find(frame), now = shown.find(frame);
  return scored != evaluation.results.end() && now != shown.end() && scored->second == now->second;
}

std::string otherResultsText(const KeptEvaluation& evaluation, const ScoredResults& shown) {
  if (evaluation.table.empty()) return {};
  if (evaluation.results.empty())
    return "the last evaluation does not say which results it is of: beam evaluate scores those of now";
  std::vector<std::string> others;
  for (const auto& [frame, result] : evaluation.results)
    if (!isOf(evaluation, shown, frame)) others.push_back(frame);
  if (others.empty()) return {};
  return fmt::format(
      "the last evaluation is of other results than are shown: {} {} {} solved anew or further since, or "
      "with "
      "other settings; beam evaluate scores those of now",
      nounText(others.size(), "frame"), shortList(others), nounText(others.size(), "was", "were"));
}

}  // namespace beam
