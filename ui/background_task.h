// SPDX-License-Identifier: Apache-2.0
// A Task as the window's thread sees it: a sample being made, a project being copied, scored, reported.
// Progress and cancel like those of a run.
#pragma once

#include <QObject>
#include <QTimer>

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

#include "core/base/task.h"

namespace beam {

class BackgroundTask final : public QObject {
  Q_OBJECT

 public:
  explicit BackgroundTask(QObject* parent = nullptr);
  ~BackgroundTask() override;

  // One at a time: throws Error{Bug} while one is going on. `work` (Outcome(Progress&), Outcome may be void)
  // is Task's; `then` (void(Outcome)) is called on the window's thread when the work is done whole.
  template <class Work, class Then>
  void start(Work work, Then then) {
    using Outcome = std::invoke_result_t<Work&, Progress&>;
    begin([work = std::move(work), then = std::move(then)](Progress& progress) -> Continuation {
      if constexpr (std::is_void_v<Outcome>) {
        work(progress);
        return then;
      } else {
        return [then, outcome = work(progress)] { then(outcome); };
      }
    });
  }
  void requestStop() {
    if (task_) task_->requestStop();
  }
  bool busy() const { return busy_; }

 Q_SIGNALS:
  void progressed(const beam::ProgressReport& report);
  void done();
  void failed(const QString& why);  // empty: cancelled

 private:
  using Continuation = std::function<void()>;
  void begin(Task<Continuation>::Work work);
  void finish();

  bool busy_ = false;
  QTimer timer_;
  std::optional<Task<Continuation>> task_;  // last: it stops first
};

}  // namespace beam
