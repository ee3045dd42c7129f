// SPDX-License-Identifier: Apache-2.0
// The look of the program: Qt's Fusion style under resources/theme/studio.qss, in colours and text sizes of
// one place. Call applyTheme before any window; again when the person chooses otherwise.
#pragma once

#include <QColor>
#include <QString>

class QApplication;
class QFont;

namespace beam {

enum class Theme { System, Dark, Light };

// Of everything that is drawn by hand, and of the sheet.
struct Colors {
  QColor window, chrome, edge, field, inside, card, control, control_edge, hover, hover_edge, chosen;
  QColor text, strong, muted, quiet, disabled;
  QColor accent, primary, primary_text, selection, progress;  // `progress`: under `strong`
  QColor done, failed, warning, stale, running, on_mark;      // `on_mark`: signs on a filled disc or bar
  QColor lane_empty, lane_done, lane_queued, lane_blocked, lane_interpolated;
  QColor error_back, error_edge, error_text, notice_back, notice_edge, notice_text;
};

const Colors& colors();

// `text_scale`: of all text, 1 to 2. System: light where the desktop's windows are.
void applyTheme(QApplication& application, Theme theme = Theme::Dark, double text_scale = 1);

// While it lives widgets are built without the program's sheet; its end dresses them all at once. Under a
// sheet Qt polishes a whole subtree anew at every move into a parent, which is half the time a window takes.
class WithoutSheet {
 public:
  WithoutSheet();
  ~WithoutSheet();
  WithoutSheet(const WithoutSheet&) = delete;
  WithoutSheet& operator=(const WithoutSheet&) = delete;

 private:
  QString sheet_;
};

// The text of notes beside drawings: a little smaller than the widget's.
QFont smallFont(const QFont& font);

}  // namespace beam
