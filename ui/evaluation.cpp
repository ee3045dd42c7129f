// SPDX-License-Identifier: Apache-2.0
#include "ui/evaluation.h"

#include <QFileInfo>
#include <QStringList>

#include <nlohmann/json.hpp>

#include "core/base/log.h"
#include "core/io/file.h"

namespace beam {
namespace {

constexpr std::uint64_t kMost = 1 << 20;

// In the order in which they are read; figures that are not named here are left out.
struct Figure {
  const char *key, *words;
  int digits;
};
constexpr Figure kFigures[] = {
    {"psnr", "%1 dB", 2},        {"psnr_scaled", "%1 dB scaled", 2}, {"ssim", "SSIM %1", 4},
    {"angle_deg", "%1°", 2},     {"mae_mm", "%1 mm mean error", 2},  {"chamfer_mm", "Chamfer %1 mm", 2},
    {"mae", "mean error %1", 4},
};

QString figuresOf(const nlohmann::ordered_json& scores) {
  QStringList parts;
  for (const Figure& f : kFigures) {
    const auto found = scores.find(f.key);
    if (found != scores.end() && found->is_number())
      parts << QString(f.words).arg(found->get<double>(), 0, 'f', f.digits);
  }
  return parts.join(" · ");
}

QString title(const std::string& channel) {
  QString words = QString::fromStdString(channel).replace('_', ' ');
  if (words == "rgb") return "RGB";
  if (words == "ao") return "Ambient occlusion";
  if (!words.isEmpty()) words[0] = words[0].toUpper();
  return words.replace("Base color", "Base colour").replace("Rgb held out", "RGB, held out");
}

}  // namespace

Evaluation readEvaluation(const std::filesystem::path& project) {
  Evaluation evaluation;
  const std::filesystem::path file = project / "evaluation.json";
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) return evaluation;
  try {
    const auto json = nlohmann::ordered_json::parse(readTextFile(file, kMost));
    for (const auto& [channel, scores] : json.items()) {
      const QString figures = scores.is_object() ? figuresOf(scores) : QString();
      if (!figures.isEmpty()) evaluation.rows.push_back({title(channel), figures});
    }
    evaluation.when = QFileInfo(QString::fromStdString(file.string())).lastModified();
  } catch (const std::exception& e) {
    logWarning("the scores in \"{}\" cannot be read ({}); evaluate again", file.string(), e.what());
  }
  return evaluation;
}

}  // namespace beam
