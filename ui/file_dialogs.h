// SPDX-License-Identifier: Apache-2.0
// The window's questions for a place on disk. Each starts where the last of its kind ended, unless it says
// otherwise; folders that are a project or a capture carry a mark.
#pragma once

#include <QString>

class QWidget;

namespace beam {

class SessionMemory;

enum class FolderKind { Plain, Project, Capture };
// By what lies in it: project.json; a description of cameras. Reads no file.
FolderKind folderKind(const QString& folder);

// Empty: the person thought better of it.
QString askCaptureFolder(QWidget* parent, SessionMemory& memory, const QString& title);
QString askProjectFolder(QWidget* parent, SessionMemory& memory);
QString askNewProject(QWidget* parent, SessionMemory& memory, const QString& title, const QString& proposed);
QString askPanorama(QWidget* parent, SessionMemory& memory, const QString& title);
// Ends in ".html"; starts at `proposed`, a whole path.
QString askReportFile(QWidget* parent, const QString& proposed);
// Ends in ".png".
QString askPictureFile(QWidget* parent, SessionMemory& memory, const QString& proposed);

}  // namespace beam
