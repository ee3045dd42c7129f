// SPDX-License-Identifier: Apache-2.0
// What the studio keeps of a person between two starts: window, recent projects, folders last used, the frame
// last seen of a project. Nothing of it is in a project. A memory that is not to last (screenshots, tests)
// forgets all.
#pragma once

#include <QByteArray>
#include <QString>
#include <QStringList>

#include <map>

namespace beam {

class SessionMemory {
 public:
  explicit SessionMemory(bool lasts) : lasts_(lasts) {}
  bool lasts() const { return lasts_; }

  QByteArray bytes(const QString& key) const;
  void keepBytes(const QString& key, const QByteArray& value);
  QString text(const QString& key) const;
  void keepText(const QString& key, const QString& value);
  int number(const QString& key, int otherwise) const;
  void keepNumber(const QString& key, int value);

  // Projects, newest first.
  QStringList recent() const;
  void keepRecent(const QString& folder);
  void forgetRecent();

  // Where a dialog of this kind ("capture", "project", "light", "picture") ended last; else the documents.
  QString folderFor(const QString& kind) const;
  void keepFolder(const QString& kind, const QString& folder);

  // By the project's own id. Empty: never seen.
  QString frameOf(const QString& project) const;
  void keepFrame(const QString& project, const QString& frame);

 private:
  bool lasts_;
  std::map<QString, QString> texts_;  // of a memory that does not last
  QStringList recent_;
};

// Why a recent project cannot be opened: it is gone, or `refusal` to open any; empty: it can.
QString refusalToReopen(const QString& folder, const QString& refusal);

}  // namespace beam
