// SPDX-License-Identifier: Apache-2.0
#include "ui/words.h"

#include <QStringList>

#include <cmath>

namespace beam {
namespace {

struct Unit {
  const char *ending, *words;
};
// Names of scores end in their units, as every name of the house does.
constexpr Unit kUnits[] = {{"_deg", "°"},     {"_mm", "mm"}, {"_m", "m"}, {"_m2", "m²"},
                           {"_px", "pixels"}, {"_db", "dB"}, {"_s", "s"}, {"_mb", "MB"}};

QString lowerFirst(QString words) {
  // An abbreviation keeps its capitals.
  const bool capitals = words.size() > 1 && words[1].isUpper();
  if (!words.isEmpty() && !capitals) words[0] = words[0].toLower();
  return words;
}

const StepInfo* findStep(const std::vector<StageInfo>& stages, const std::string& step,
                         QString& stage_title) {
  for (const StageInfo& stage : stages) {
    if (stage.id != stageOf(step)) continue;
    stage_title = QString::fromStdString(stage.title);
    for (const StepInfo& info : stage.steps) {
      if (info.id == stepOf(step)) return &info;
    }
  }
  return nullptr;
}

QString scoreTitle(QString score) {
  if (score == "seconds") return "time (s)";
  if (score == "psnr") return "PSNR (dB)";
  if (score == "ssim") return "SSIM";
  QString unit;
  for (const Unit& known : kUnits) {
    if (!score.endsWith(known.ending)) continue;
    unit = QString(" (%1)").arg(known.words);
    score.chop(static_cast<int>(std::string_view(known.ending).size()));
    break;
  }
  return score.replace('_', ' ').replace("psnr", "PSNR").replace("ssim", "SSIM") + unit;
}

}  // namespace

QString numberText(std::int64_t n) {
  QString digits = QString::number(n);
  const int first = n < 0 ? 1 : 0;
  for (int at = digits.size() - 3; at > first; at -= 3) digits.insert(at, ',');
  return digits;
}

QString countText(std::int64_t n, const QString& one, const QString& many) {
  return numberText(n) + " " + (n == 1 ? one : many.isEmpty() ? one + "s" : many);
}

QString durationText(double seconds) {
  const auto s = static_cast<long long>(std::llround(seconds));
  if (s < 60) return QString("%1 s").arg(s);
  if (s < 3600) return QString("%1 min %2 s").arg(s / 60).arg(s % 60, 2, 10, QChar('0'));
  return QString("%1 h %2 min").arg(s / 3600).arg(s % 3600 / 60, 2, 10, QChar('0'));
}

QString stepTitle(const std::vector<StageInfo>& stages, const std::string& step) {
  QString stage;
  const StepInfo* info = findStep(stages, step, stage);
  return info ? stage + ": " + lowerFirst(QString::fromStdString(info->title)) : QString::fromStdString(step);
}

QString curveTitle(const std::vector<StageInfo>& stages, const std::string& curve) {
  const std::size_t second = curve.find('.', curve.find('.') + 1);
  if (second == std::string::npos) return QString::fromStdString(curve);
  QString stage;
  const StepInfo* info = findStep(stages, curve.substr(0, second), stage);
  if (!info) return QString::fromStdString(curve);
  return QString("%1, %2: %3")
      .arg(stage, lowerFirst(QString::fromStdString(info->title)),
           scoreTitle(QString::fromStdString(curve.substr(second + 1))));
}

}  // namespace beam
