// SPDX-License-Identifier: Apache-2.0
// The last scores that `beam evaluate` wrote into the project, as rows of words.
#pragma once

#include <QDateTime>
#include <QString>

#include <filesystem>
#include <vector>

namespace beam {

struct ScoreRow {
  QString what;   // "Base colour"
  QString first;  // "29.62 dB", "8.70°", "2.36 mm"
  QString ssim;   // "0.9571"; empty where the evaluator gives none
};

struct Evaluation {
  std::vector<ScoreRow> rows;  // empty: never evaluated, or not readable
  QDateTime when;
};

// Never throws: a score that cannot be read is none.
Evaluation readEvaluation(const std::filesystem::path& project);

}  // namespace beam
