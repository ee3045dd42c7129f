// SPDX-License-Identifier: Apache-2.0
#include "ui/file_dialogs.h"

#include <QDir>
#include <QFileDialog>
#include <QFileIconProvider>
#include <QFileInfo>
#include <QPainter>

#include "ui/session_memory.h"
#include "ui/theme.h"

namespace beam {
namespace {

// A folder's picture with a dot in its corner: a project, a capture.
class MarkingIcons final : public QFileIconProvider {
 public:
  QIcon icon(const QFileInfo& info) const override {
    const QIcon plain = QFileIconProvider::icon(info);
    if (!info.isDir()) return plain;
    const FolderKind kind = folderKind(info.filePath());
    return kind == FolderKind::Plain ? plain : marked(plain, kind);
  }
  QString type(const QFileInfo& info) const override {
    switch (info.isDir() ? folderKind(info.filePath()) : FolderKind::Plain) {
      case FolderKind::Project:
        return "BEAM project";
      case FolderKind::Capture:
        return "Capture";
      case FolderKind::Plain:
        break;
    }
    return QFileIconProvider::type(info);
  }

 private:
  static QIcon marked(const QIcon& plain, FolderKind kind) {
    constexpr int kSize = 32;
    QPixmap picture = plain.pixmap(kSize, kSize);
    if (picture.isNull()) {
      picture = QPixmap(kSize, kSize);
      picture.fill(Qt::transparent);
    }
    QPainter p(&picture);
    p.setRenderHint(QPainter::Antialiasing);
    p.setPen(Qt::NoPen);
    p.setBrush(kind == FolderKind::Project ? QColor("#5b9bf0") : QColor("#6fbf73"));
    const double w = picture.width(), h = picture.height();
    p.drawEllipse(QRectF(0.45 * w, 0.45 * h, 0.5 * w, 0.5 * h));
    p.setPen(Qt::white);
    QFont font = p.font();
    font.setBold(true);
    font.setPixelSize(static_cast<int>(0.38 * h));
    p.setFont(font);
    p.drawText(QRectF(0.45 * w, 0.45 * h, 0.5 * w, 0.5 * h), Qt::AlignCenter,
               kind == FolderKind::Project ? "P" : "C");
    return QIcon(picture);
  }
};

// The system's own dialog cannot mark folders.
QString askFolder(QWidget* parent, SessionMemory& memory, const QString& memory_kind, const QString& title) {
  MarkingIcons icons;
  QFileDialog dialog(parent, title, memory.folderFor(memory_kind));
  dialog.setFileMode(QFileDialog::Directory);
  dialog.setOption(QFileDialog::ShowDirsOnly);
  dialog.setOption(QFileDialog::DontUseNativeDialog);
  dialog.setIconProvider(&icons);
  dialog.setLabelText(QFileDialog::FileType, "P: a project. C: a capture");
  if (dialog.exec() != QDialog::Accepted || dialog.selectedFiles().isEmpty()) return {};
  const QString folder = dialog.selectedFiles().front();
  memory.keepFolder(memory_kind, QFileInfo(folder).absolutePath());
  return folder;
}

QString withSuffix(const QString& file, const QString& suffix) {
  return file.isEmpty() || file.endsWith(suffix, Qt::CaseInsensitive) ? file : file + suffix;
}

QString askFileToWrite(QWidget* parent, const QString& title, const QString& start, const QString& kind,
                       const QString& suffix) {
  QFileDialog dialog(parent, title, QFileInfo(start).absolutePath(), QString("%1 (*.%2)").arg(kind, suffix));
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(suffix);
  dialog.selectFile(QFileInfo(start).fileName());
  if (dialog.exec() != QDialog::Accepted || dialog.selectedFiles().isEmpty()) return {};
  return withSuffix(dialog.selectedFiles().front(), "." + suffix);
}

}  // namespace

FolderKind folderKind(const QString& folder) {
  const QDir dir(folder);
  if (dir.exists("project.json")) return FolderKind::Project;
  if (folder.endsWith(".beam") && (dir.exists("results") || dir.exists("history")))
    return FolderKind::Project;
  for (const char* description : {"dataset.json", "transforms.json", "sparse"}) {
    if (dir.exists(description)) return FolderKind::Capture;
  }
  return FolderKind::Plain;
}

QString askCaptureFolder(QWidget* parent, SessionMemory& memory, const QString& title) {
  return askFolder(parent, memory, "capture", title);
}

QString askProjectFolder(QWidget* parent, SessionMemory& memory) {
  return askFolder(parent, memory, "project", "Open a project, a folder that ends in .beam");
}

QString askNewProject(QWidget* parent, SessionMemory& memory, const QString& title, const QString& proposed) {
  const QString start = QDir(memory.folderFor("project")).filePath(proposed);
  QFileDialog dialog(parent, title, QFileInfo(start).absolutePath(), "Projects (*.beam)");
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setOption(QFileDialog::DontUseNativeDialog);
  dialog.setOption(
      QFileDialog::DontConfirmOverwrite);  // a folder is never written over: that is refused later
  dialog.selectFile(QFileInfo(start).fileName());
  if (dialog.exec() != QDialog::Accepted || dialog.selectedFiles().isEmpty()) return {};
  const QString folder = withSuffix(dialog.selectedFiles().front(), ".beam");
  memory.keepFolder("project", QFileInfo(folder).absolutePath());
  return folder;
}

QString askPanorama(QWidget* parent, SessionMemory& memory, const QString& title) {
  const QString file =
      QFileDialog::getOpenFileName(parent, title, memory.folderFor("light"), "Panoramas (*.exr *.hdr)");
  if (!file.isEmpty()) memory.keepFolder("light", QFileInfo(file).absolutePath());
  return file;
}

QString askPictureFile(QWidget* parent, SessionMemory& memory, const QString& proposed) {
  const QString start = QDir(memory.folderFor("picture")).filePath(proposed);
  const QString file = askFileToWrite(parent, "Save the view as a picture", start, "PNG", "png");
  if (!file.isEmpty()) memory.keepFolder("picture", QFileInfo(file).absolutePath());
  return file;
}

QString askReportFile(QWidget* parent, const QString& proposed) {
  return askFileToWrite(parent, "Where the report is to be written", proposed, "Pages", "html");
}

}  // namespace beam
