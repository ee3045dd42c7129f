// SPDX-License-Identifier: Apache-2.0
// What is made of solved frames while nothing runs: their scores, the report.
#include <QDockWidget>

#include "core/work/evaluate.h"
#include "core/work/report.h"
#include "ui/file_dialogs.h"
#include "ui/main_window.h"
#include "ui/message_panel.h"
#include "ui/project_panel.h"
#include "ui/words.h"

namespace beam {
namespace fs = std::filesystem;

void MainWindow::evaluateHeldOut() {
  if (!takeOverSettings("Nothing was scored")) return;
  startTask(
      "The evaluation",
      [project = model_.project(), device = services_.job_device](Progress& progress) {
        keepEvaluation(project, evaluate({project, "all", {}, {}}, *device, progress));
      },
      [this] {
        project_panel_->refreshScores();
        findChild<QDockWidget*>("project")->show();
      });
}

void MainWindow::writeReport() {
  if (!takeOverSettings("The report was not written")) return;
  const Project& project = model_.project();
  const fs::path proposed = project.folder().parent_path() / (project.name() + "-report.html");
  const QString file = askReportFile(this, QString::fromStdString(proposed.string()));
  if (file.isEmpty()) return;
  startTask(
      "The report",
      [request = ReportRequest{project, file.toStdString(), true},  // the dialog has asked
       device = services_.job_device](Progress& progress) { return report(request, *device, progress); },
      [this, file](const ReportOutcome& outcome) {
        QStringList lines{
            QString("%1, of %2").arg(file, countText(static_cast<std::int64_t>(outcome.frames), "frame"))};
        for (const std::string& finding : outcome.findings) lines << QString::fromStdString(finding);
        message_->show(MessagePanel::Kind::Notice, "The report is written", lines.join("\n"));
      });
}

}  // namespace beam
