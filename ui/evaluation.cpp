// SPDX-License-Identifier: Apache-2.0
#include "ui/evaluation.h"

#include <QFileInfo>

#include <nlohmann/json.hpp>

#include "core/base/log.h"
#include "core/io/file.h"
#include "core/work/scores.h"

namespace beam {
namespace {

constexpr std::uint64_t kMost = 1 << 20;

// The figure a channel is judged by; the first that is there counts.
struct Figure {
  const char *key, *words;
};
constexpr Figure kFigures[] = {
    {"psnr", "%1 dB"}, {"angle_deg", "%1°"}, {"mae_mm", "%1 mm"}, {"chamfer_mm", "%1 mm"}};

QString number(const nlohmann::ordered_json& scores, const char* key, const char* words, int digits) {
  const auto found = scores.find(key);
  if (found == scores.end() || !found->is_number()) return {};
  return QString(words).arg(found->get<double>(), 0, 'f', digits);
}

ScoreRow rowOf(const QString& what, const nlohmann::ordered_json& scores) {
  ScoreRow row{what, {}, number(scores, "ssim", "%1", 4)};
  for (const Figure& f : kFigures) {
    if (row.first.isEmpty()) row.first = number(scores, f.key, f.words, 2);
  }
  return row;
}

QString title(const std::string& channel) {
  QString words = QString::fromStdString(channel).replace('_', ' ');
  if (words == "rgb") return "RGB";
  if (words == "ao") return "Ambient occlusion";
  if (words == "mesh") return "Mesh (Chamfer)";
  if (!words.isEmpty()) words[0] = words[0].toUpper();
  return words.replace("Base color", "Base colour").replace("Rgb held out", "RGB, held out");
}

}  // namespace

Evaluation readEvaluation(const std::filesystem::path& project) {
  Evaluation evaluation;
  const std::filesystem::path file = project / kEvaluationFile;
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) return evaluation;
  try {
    const auto json = nlohmann::ordered_json::parse(readTextFile(file, kMost));
    for (const auto& [channel, scores] : json.items()) {
      // The scaled scores, which forgive a wrong gain, stay in the file.
      if (!scores.is_object() || channel.ends_with("_scaled")) continue;
      const ScoreRow row = rowOf(title(channel), scores);
      if (!row.first.isEmpty()) evaluation.rows.push_back(row);
    }
    evaluation.when = QFileInfo(QString::fromStdString(file.string())).lastModified();
  } catch (const std::exception& e) {
    logWarning("the scores in \"{}\" cannot be read ({}); evaluate again", file.string(), e.what());
  }
  return evaluation;
}

}  // namespace beam
