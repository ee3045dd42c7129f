// SPDX-License-Identifier: Apache-2.0
#include "ui/session_memory.h"

#include <QFileInfo>
#include <QSettings>
#include <QStandardPaths>

namespace beam {
namespace {

constexpr int kMostRecent = 8;

}  // namespace

QByteArray SessionMemory::bytes(const QString& key) const {
  return lasts_ ? QSettings().value(key).toByteArray() : QByteArray();
}

void SessionMemory::keepBytes(const QString& key, const QByteArray& value) {
  if (lasts_) QSettings().setValue(key, value);
}

int SessionMemory::number(const QString& key, int otherwise) const {
  const QString kept = text(key);
  return kept.isEmpty() ? otherwise : kept.toInt();
}

void SessionMemory::keepNumber(const QString& key, int value) { keepText(key, QString::number(value)); }

QString SessionMemory::text(const QString& key) const {
  if (lasts_) return QSettings().value(key).toString();
  const auto found = texts_.find(key);
  return found == texts_.end() ? QString() : found->second;
}

void SessionMemory::keepText(const QString& key, const QString& value) {
  if (lasts_) {
    QSettings().setValue(key, value);
  } else {
    texts_[key] = value;
  }
}

QStringList SessionMemory::recent() const {
  return lasts_ ? QSettings().value("recent").toStringList() : recent_;
}

void SessionMemory::keepRecent(const QString& folder) {
  recent_ = recent();
  recent_.removeAll(folder);
  recent_.prepend(folder);
  while (recent_.size() > kMostRecent) recent_.removeLast();
  if (lasts_) QSettings().setValue("recent", recent_);
}

void SessionMemory::forgetRecent() {
  recent_.clear();
  if (lasts_) QSettings().remove("recent");
}

QString SessionMemory::folderFor(const QString& kind) const {
  const QString kept = text("folder/" + kind);
  if (!kept.isEmpty() && QFileInfo(kept).isDir()) return kept;
  return QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation);
}

void SessionMemory::keepFolder(const QString& kind, const QString& folder) {
  keepText("folder/" + kind, folder);
}

QString SessionMemory::frameOf(const QString& project) const { return text("frame/" + project); }

void SessionMemory::keepFrame(const QString& project, const QString& frame) {
  if (!project.isEmpty()) keepText("frame/" + project, frame);
}

QString refusalToReopen(const QString& folder, const QString& refusal) {
  return QFileInfo::exists(folder) ? refusal : folder + " is not there any more.";
}

}  // namespace beam
