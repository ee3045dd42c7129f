// SPDX-License-Identifier: Apache-2.0
// A task gives what its work gives: an outcome by value, what was thrown, its progress, and an end when told.
#include "core/base/task.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>

#include "core/base/error.h"

namespace beam {
namespace {

// Steps until it is stopped.
int endless(Progress& progress) {
  progress.expect(1000);
  for (;;) {
    progress.step(0);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

template <class Outcome>
void waitForReport(const Task<Outcome>& task) {
  while (!task.progress()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(Task, GivesItsOutcomeByValue) {
  Task<std::string> task([](Progress&) { return std::string("seven"); });
  EXPECT_EQ(task.take(), "seven");
  EXPECT_TRUE(task.ended());
}

TEST(Task, OfWorkWithoutAnOutcomeEnds) {
  std::atomic<bool> worked{false};
  Task<void> task([&](Progress&) { worked = true; });
  task.take();
  EXPECT_TRUE(worked);
}

TEST(Task, HandsOnWhatItsWorkThrew) {
  Task<int> task([](Progress&) -> int { throw Error(Error::Kind::Data, "no frame"); });
  try {
    task.take();
    FAIL() << "nothing was thrown";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Data);
    EXPECT_STREQ(e.what(), "no frame");
  }
}

TEST(Task, ThatIsStoppedThrowsCancelled) {
  Task<int> task(endless);
  EXPECT_FALSE(task.ended());
  task.requestStop();
  EXPECT_THROW(task.take(), Cancelled);
}

TEST(Task, TellsItsNewestProgress) {
  Task<int> task([](Progress& progress) {
    Progress part = progress.part(0.5, "first half");
    return endless(part);
  });
  waitForReport(task);
  EXPECT_EQ(task.progress()->label, "first half");
  EXPECT_EQ(task.progress()->fraction, 0);
}

TEST(Task, StopsWhenItGoesAway) {
  std::atomic<bool> stopped{false};
  {
    const Task<int> task([&](Progress& progress) {
      try {
        return endless(progress);
      } catch (const Cancelled&) {
        stopped = true;
        throw;
      }
    });
    waitForReport(task);
  }
  EXPECT_TRUE(stopped);
}

TEST(Task, TellsOfItsEndWhenTheOutcomeIsThere) {
  std::atomic<bool> told{false}, was_there{false};
  std::atomic<Task<int>*> self{nullptr};
  {
    Task<int> task([](Progress&) { return 7; },
                   [&] {
                     while (!self) std::this_thread::yield();
                     was_there = self.load()->ended();
                     told = true;
                   });
    self = &task;
  }
  EXPECT_TRUE(told);
  EXPECT_TRUE(was_there);
}

}  // namespace
}  // namespace beam
