// SPDX-License-Identifier: Apache-2.0
#include "ui/words.h"

#include <QRegularExpression>
#include <QStringList>

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

constexpr int kDigits = 6;
constexpr double kMostPlain = 1e15, kLeastPlain = 1e-7;  // above, a double does not hold every whole number

struct Words {
  const char *name, *words;
};
// Those that the stages keep. Energies have the names of the method; those of radiance and base colour are
// mean absolute changes of values in [0, 1].
constexpr Words kScores[] = {{"seconds", "time (s)"},
                             {"training_cameras", "training cameras"},
                             {"test_cameras", "held-out cameras"},
                             {"left_out", "cameras left out"},
                             {"joints", "number of joints"},
                             {"restart", "restart (1: the joints start anew)"},
                             {"residual", "mean difference from the photographs (0 to 1)"},
                             {"motion_p95_m", "motion, 95th percentile (m)"},
                             {"e_rigid", "E_rigid (m²)"},
                             {"e_smooth", "E_smooth (m²)"},
                             {"e_temp", "E_temp"},
                             {"points", "seed points"},
                             {"gaussians", "Gaussians"},
                             {"triangles", "triangles"},
                             {"views", "views with baked maps"},
                             {"flicker_radiance", "flicker of radiance (0 to 1)"},
                             {"flicker_base_color", "flicker of base colour (0 to 1)"},
                             {"psnr", "PSNR (dB)"},
                             {"psnr_train", "PSNR, training views (dB)"},
                             {"psnr_test", "PSNR, held-out views (dB)"},
                             {"psnr_worst_train", "PSNR, worst training view (dB)"},
                             {"psnr_worst_test", "PSNR, worst held-out view (dB)"},
                             {"ssim", "SSIM"},
                             {"ssim_train", "SSIM, training views"},
                             {"ssim_test", "SSIM, held-out views"}};

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

const StepInfo* findStep(const std::vector<StageInfo>& stages, const StepId& step, QString& stage_title) {
  for (const StageInfo& stage : stages) {
    if (stage.id != step.stage()) continue;
    stage_title = QString::fromStdString(stage.title);
    for (const StepInfo& info : stage.steps) {
      if (info.id == step.name()) return &info;
    }
  }
  return nullptr;
}

QString scoreTitle(QString score) {
  for (const Words& known : kScores) {
    if (score == known.name) return known.words;
  }
  QString unit;
  for (const Unit& known : kUnits) {
    if (!score.endsWith(known.ending)) continue;
    unit = QString(" (%1)").arg(known.words);
    score.chop(static_cast<int>(std::string_view(known.ending).size()));
    break;
  }
  return score.replace('_', ' ').replace("psnr", "PSNR").replace("ssim", "SSIM").replace("color", "colour") +
         unit;
}

// Thousands apart, before the point.
QString grouped(QString digits) {
  const int first = digits.startsWith('-') ? 1 : 0, point = digits.indexOf('.');
  for (int at = (point < 0 ? digits.size() : point) - 3; at > first; at -= 3) digits.insert(at, ',');
  return digits;
}

}  // namespace

QString numberText(std::int64_t n) { return grouped(QString::number(n)); }

QString figureText(double value) {
  const double size = std::abs(value);
  if (value == 0) return "0";
  if (!std::isfinite(value)) return QString::number(value);
  if (value == std::floor(value) && size < kMostPlain) return grouped(QString::number(value, 'f', 0));
  if (size < kLeastPlain || size >= kMostPlain) return QString::number(value, 'g', kDigits);
  const int decimals = std::max(0, kDigits - 1 - static_cast<int>(std::floor(std::log10(size))));
  QString text = QString::number(value, 'f', decimals);
  while (text.contains('.') && (text.endsWith('0') || text.endsWith('.'))) text.chop(1);
  return grouped(text);
}

QString countText(std::int64_t n, const QString& one, const QString& many) {
  return numberText(n) + " " + (n == 1 ? one : many.isEmpty() ? one + "s" : many);
}

QString stepTitle(const std::vector<StageInfo>& stages, const StepId& step) {
  QString stage;
  const StepInfo* info = findStep(stages, step, stage);
  return info ? stage + ": " + lowerFirst(QString::fromStdString(info->title))
              : QString::fromStdString(step.text());
}

QString withStepTitles(const std::vector<StageInfo>& stages, QString text) {
  if (!text.contains('.')) return text;
  for (const StageInfo& stage : stages) {
    for (const StepInfo& step : stage.steps) {
      const StepId id(stage.id, step.id);
      // Not as a part of the name of a setting or a file.
      const QRegularExpression whole(
          QString("(?<![\\w./-])%1(?![\\w/-]|\\.\\w)").arg(QRegularExpression::escape(id.text().c_str())));
      text.replace(whole, stepTitle(stages, id));
    }
  }
  return text;
}

QString curveTitle(const std::vector<StageInfo>& stages, const std::string& curve) {
  const std::size_t second = curve.find('.', curve.find('.') + 1);
  if (second == std::string::npos) return QString::fromStdString(curve);
  QString stage;
  const StepInfo* info = findStep(stages, StepId(curve.substr(0, second)), stage);
  if (!info) return QString::fromStdString(curve);
  const QString step = QString::fromStdString(info->title);
  // "Track joints" says "Track" already.
  const QString where = step.startsWith(stage) ? step : stage + ", " + lowerFirst(step);
  return where + ": " + scoreTitle(QString::fromStdString(curve.substr(second + 1)));
}

}  // namespace beam
