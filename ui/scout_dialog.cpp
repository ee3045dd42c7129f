// SPDX-License-Identifier: Apache-2.0
#include "ui/scout_dialog.h"

#include <QInputDialog>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/duration_text.h"
#include "ui/words.h"

namespace beam {

double secondsAFrame(const TakeSurvey& survey) {
  double sum = 0;
  std::set<std::size_t> frames;
  for (const SurveyCurve& curve : survey.curves) {
    if (!QString::fromStdString(curve.name).endsWith(".seconds")) continue;
    for (std::size_t f = 0; f < curve.values.size(); ++f) {
      if (!std::isfinite(curve.values[f])) continue;
      sum += curve.values[f];
      frames.insert(f);
    }
  }
  return frames.empty() ? 0 : sum / static_cast<double>(frames.size());
}

QString scoutText(const ScoutPlan& plan, int every) {
  const int solved = (plan.frames - 1) / every + 1;
  const int between = (solved - 1) * (every - 1), after = plan.frames - solved - between;
  QString words =
      "A scout run solves a few frames of the in–out range, evenly spread,\nfor a first look at all of "
      "it.\n\n";
  words +=
      QString("%1 of %2 %3 solved with the preset %4")
          .arg(numberText(solved), countText(plan.frames, "frame"), solved == 1 ? "is" : "are", plan.preset);
  words += plan.seconds_a_frame > 0
               ? QString(":\nabout %1, as frames took so far.")
                     .arg(QString::fromStdString(durationText(solved * plan.seconds_a_frame)))
               : QString(";\nhow long one takes is known after the first.");
  if (between > 0) {
    words += "\n" + countText(between, "between is interpolated", "between are interpolated") +
             ": to look at, without scores.";
  }
  if (after > 0) {
    words += "\n" + countText(after, "after the last shows", "after the last show") + " that one.";
  }
  return words + "\n\nDistance from one solved frame to the next, in frames:";
}

std::optional<int> askScout(QWidget* parent, const ScoutPlan& plan, int every) {
  const int most = std::max(2, plan.frames - 1);
  QInputDialog dialog(parent);
  dialog.setWindowTitle("Scout the in–out range");
  dialog.setInputMode(QInputDialog::IntInput);
  dialog.setIntRange(2, most);
  dialog.setIntValue(std::clamp(every, 2, most));
  dialog.setOkButtonText("Scout");
  const auto tell = [&](int value) { dialog.setLabelText(scoutText(plan, value)); };
  QObject::connect(&dialog, &QInputDialog::intValueChanged, &dialog, tell);
  tell(dialog.intValue());
  if (dialog.exec() != QDialog::Accepted) return std::nullopt;
  return dialog.intValue();
}

}  // namespace beam
