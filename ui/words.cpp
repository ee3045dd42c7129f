// SPDX-License-Identifier: Apache-2.0
#include "ui/words.h"

#include <QRegularExpression>
#include <QStringList>

#include <algorithm>
#include <cmath>

#include "core/base/count_text.h"
#include "core/work/score_words.h"

namespace beam {
namespace {

constexpr int kDigits = 6;
constexpr double kMostPlain = 1e15, kLeastPlain = 1e-7;  // above, a double does not hold every whole number

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
  return QString::fromStdString(countText(n, one.toStdString(), many.toStdString()));
}

QString stepTitle(const std::vector<StageInfo>& stages, const StepId& step) {
  return QString::fromStdString(titleOfStep(stages, step));
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
  return QString::fromStdString(titleOf(curveWords(stages, curve)));
}

}  // namespace beam
