// SPDX-License-Identifier: Apache-2.0
// The last scores that `beam evaluate` wrote into the project, as rows of words.
#pragma once

#include <QDateTime>
#include <QString>

#include <filesystem>
#include <vector>

namespace beam {

struct ScoreRow {
  QString what;     // "rgb"
  QString figures;  // "33.46 dB · SSIM 0.976"
};

struct Evaluation {
  std::vector<ScoreRow> rows;  // empty: never evaluated, or not readable
  QDateTime when;
};

// Never throws: a score that cannot be read is none.
Evaluation readEvaluation(const std::filesystem::path& project);

}  // namespace beam
