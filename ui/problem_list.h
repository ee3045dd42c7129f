// SPDX-License-Identifier: Apache-2.0
// What went wrong or may be wrong since a project was opened: each problem once, with how often and when it
// was last told; newest first.
#pragma once

#include <QDateTime>
#include <QListWidget>
#include <QObject>
#include <QStringList>

#include <map>
#include <string>
#include <vector>

class QLabel;
class QToolButton;

namespace beam {

struct Problem {
  enum class Kind { Warning, Error };
  Kind kind = Kind::Warning;
  QString text;
  std::string camera = {}, stage = {};  // names; empty: of no camera, of no stage
  QString frame = {};                   // name; empty: of no frame
  int count = 1;
  QDateTime last = {};
};

class ProblemList final : public QObject {
  Q_OBJECT

 public:
  explicit ProblemList(QObject* parent = nullptr);

  // One that is there already counts up and becomes the newest. `problem.count` and `last` are ours.
  void add(Problem problem);
  void clear();

  const std::vector<Problem>& all() const { return problems_; }
  int count() const { return static_cast<int>(problems_.size()); }
  int count(Problem::Kind kind) const;
  std::map<std::string, int> countsByStage() const;
  std::map<std::string, int> countsByCamera() const;
  std::map<std::string, QStringList> textsByCamera() const;

 Q_SIGNALS:
  void changed();

 private:
  std::vector<Problem> problems_;
};

// "camera C03, frame 000004"; empty: of the whole project.
QString placeOf(const Problem& problem);

// The list as rows: newest on top, selectable, copied with Ctrl+C.
class ProblemsPanel final : public QWidget {
  Q_OBJECT

 public:
  explicit ProblemsPanel(ProblemList& problems, QWidget* parent = nullptr);
  // For the tab: "Problems (3)".
  QString title() const;

 Q_SIGNALS:
  void titleChanged(const QString& title);
  void told(const QString& words);  // the row that was pressed, whole; that something was copied

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void refresh();
  void copy(bool all);

  ProblemList& problems_;
  QListWidget* rows_;
  QLabel* empty_;
  QToolButton *copy_all_, *clear_;
  QString told_;
};

}  // namespace beam
