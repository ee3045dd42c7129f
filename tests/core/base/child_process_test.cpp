// SPDX-License-Identifier: Apache-2.0
// Another program gets all that is written to it, is read to its end, and is gone with what stands for it.
#include "core/base/child_process.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "core/base/error.h"
#include "tests/support/few_descriptors.h"
#include "tests/support/message_of.h"
#include "tests/support/search_path.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Output = ChildProcess::Output;
using std::chrono::milliseconds;

std::span<const std::byte> bytesOf(const std::string& text) { return std::as_bytes(std::span(text)); }

std::string readAll(ChildProcess& child) {
  std::string all;
  std::array<std::byte, 7001> some;
  while (const std::size_t n = child.read(some)) all.append(reinterpret_cast<const char*>(some.data()), n);
  return all;
}

std::string outputOf(const std::vector<std::string>& words) {
  ChildProcess child(words, Output::Kept);
  child.closeInput();
  std::string all = readAll(child);
  EXPECT_EQ(child.finish(), 0) << child.errorText();
  return all;
}

std::string patternOf(std::size_t bytes) {
  std::string text(bytes, ' ');
  std::uint32_t state = 1;
  for (char& c : text) c = static_cast<char>((state = state * 1664525u + 1013904223u) >> 24);
  return text;
}

std::size_t openDescriptors() {
  const fs::directory_iterator all("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(fs::begin(all), fs::end(all)));
}

bool hasChildren() { return ::waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD; }

// Whether a process of that number is there and not merely waited for.
bool isRunning(const std::string& pid) {
  std::ifstream in("/proc/" + pid + "/stat");
  std::string line;
  if (!std::getline(in, line)) return false;
  const std::size_t name_end = line.rfind(')');
  return line.at(name_end + 2) != 'Z';
}

TEST(ChildProcess, BothStreamsCarryAllBytesAtOnce) {
  const std::string sent = patternOf(10'000'000);
  ChildProcess cat({"cat"}, Output::Kept);
  std::string came;
  std::jthread reader([&] { came = readAll(cat); });
  EXPECT_TRUE(cat.write(bytesOf(sent)));
  EXPECT_EQ(cat.finish(), 0);
  reader.join();
  EXPECT_TRUE(came == sent);
}

TEST(ChildProcess, OneThreadWritesClosesAndReads) {
  ChildProcess sort({"sort"}, Output::Kept);
  EXPECT_TRUE(sort.write(bytesOf("b\na\n")));
  sort.closeInput();
  EXPECT_FALSE(sort.write(bytesOf("c\n")));
  EXPECT_EQ(readAll(sort), "a\nb\n");
  EXPECT_EQ(sort.finish(), 0);
  EXPECT_EQ(sort.finish(), 0) << "asked again";
}

TEST(ChildProcess, WordsArriveAsTheyAreWithoutAShell) {
  EXPECT_EQ(outputOf({"printf", "%s|", "a b", "", "$HOME", "*", "'\"\\"}), "a b||$HOME|*|'\"\\|");
}

TEST(ChildProcess, OutputIsReadAfterItsEnd) {
  ChildProcess child({"sh", "-c", "echo early"}, Output::Kept);
  EXPECT_EQ(child.finish(), 0);
  EXPECT_EQ(readAll(child), "early\n");
}

TEST(ChildProcess, OutputThatIsDiscardedHoldsNothingUp) {
  ChildProcess child({"sh", "-c", "head -c 3000000 /dev/zero; exit 4"});
  EXPECT_EQ(child.finish(), 4);
}

TEST(ChildProcess, MuchOnStandardErrorHoldsNothingUpAndItsLastIsKept) {
  ChildProcess child(
      {"sh", "-c", "head -c 3000000 /dev/zero | tr '\\0' x >&2; cat >&2; printf end >&2; exit 3"});
  EXPECT_TRUE(child.write(bytesOf(std::string(500'000, 'y'))));
  EXPECT_EQ(child.finish(), 3);
  const std::string said = child.errorText();
  EXPECT_EQ(said.size(), 64u * 1024);
  EXPECT_TRUE(said.ends_with("yyend"));
  EXPECT_EQ(said.find('x'), std::string::npos);
}

TEST(ChildProcess, LittleOnStandardErrorIsKeptInWhole) {
  ChildProcess child({"sh", "-c", "echo one >&2; echo two >&2"});
  child.finish();
  EXPECT_EQ(child.errorText(), "one\ntwo\n");
}

TEST(ChildProcess, TellsExitCodesAndSignals) {
  EXPECT_EQ(ChildProcess({"true"}).finish(), 0);
  EXPECT_EQ(ChildProcess({"false"}).finish(), 1);
  EXPECT_EQ(ChildProcess({"sh", "-c", "exit 77"}).finish(), 77);
  EXPECT_EQ(ChildProcess({"sh", "-c", "kill -9 $$"}).finish(), 128 + SIGKILL);
  EXPECT_EQ(ChildProcess({"sh", "-c", "kill -SEGV $$"}).finish(), 128 + SIGSEGV);
}

TEST(ChildProcess, ThatIsNotThereIsNamed) {
  EXPECT_THAT(messageOf(Error::Kind::Usage, [] { ChildProcess({"no-such-program"}); }),
              HasSubstr("no-such-program"));
  EXPECT_THAT(messageOf(Error::Kind::Usage, [] { ChildProcess({"/nowhere/cat"}); }),
              HasSubstr("/nowhere/cat"));
  EXPECT_THROW(ChildProcess({"/tmp"}), Error) << "a folder";
  EXPECT_THROW(ChildProcess({}), Error);
}

TEST(ChildProcess, ThatTheSystemCannotStartIsAFaultOfTheSystem) {
  const TempDir dir;
  std::ofstream(dir / "odd") << "#!/nowhere/interpreter\n";
  fs::permissions(dir / "odd", fs::perms::owner_all);
  EXPECT_THAT(messageOf(Error::Kind::Storage, [&] { ChildProcess({(dir / "odd").string()}); }),
              HasSubstr("odd"));
  const FewDescriptors none_left;
  messageOf(Error::Kind::Storage, [] { ChildProcess({"true"}); });
}

TEST(ChildProcess, ThatClosesItsInputEarlyEndsTheWritingAndNotUs) {
  const std::string much = patternOf(4'000'000);
  ChildProcess closes({"sh", "-c", "exec <&-; sleep 0.05; exit 5"});
  EXPECT_FALSE(closes.write(bytesOf(much)));
  EXPECT_EQ(closes.finish(), 5);
  ChildProcess ends({"true"});
  EXPECT_FALSE(ends.write(bytesOf(much)));
  EXPECT_EQ(ends.finish(), 0);
  sigset_t pending;
  ::sigpending(&pending);
  EXPECT_FALSE(::sigismember(&pending, SIGPIPE));
}

TEST(ChildProcess, ThatWritesForEverIsStopped) {
  ChildProcess yes({"yes"}, Output::Kept);
  std::array<std::byte, 4> some;
  EXPECT_EQ(yes.read(some), 4u);
  yes.stop();
  EXPECT_EQ(yes.finish(), 128 + SIGTERM);
}

TEST(ChildProcess, ThatIgnoresTheRequestIsKilled) {
  ChildProcess child({"sh", "-c", "trap '' TERM; echo ready; while :; do sleep 0.02; done"}, Output::Kept);
  std::array<std::byte, 6> some;
  child.read(some);
  child.stop(milliseconds(100));
  EXPECT_EQ(child.finish(), 128 + SIGKILL);
}

TEST(ChildProcess, ThatEndsInOrderWhenAskedIsNotKilled) {
  ChildProcess child({"sh", "-c", "trap 'exit 9' TERM; echo ready; while :; do sleep 0.02; done"},
                     Output::Kept);
  std::array<std::byte, 6> some;
  child.read(some);
  child.stop(std::chrono::minutes(5));
  EXPECT_EQ(child.finish(), 9);
  child.stop();
}

TEST(ChildProcess, WhatItStartedGoesWithIt) {
  std::string pid;
  {
    ChildProcess child({"sh", "-c", "(trap '' TERM; exec sleep 1000) & echo $!; wait"}, Output::Kept);
    std::array<std::byte, 1> c;
    while (child.read(c) && c[0] != std::byte{'\n'}) pid += static_cast<char>(c[0]);
    EXPECT_TRUE(isRunning(pid));
    child.stop(milliseconds(50));
    EXPECT_EQ(child.read(c), 0u);
  }
  // It dies of the signal at its own time.
  while (isRunning(pid)) std::this_thread::sleep_for(milliseconds(1));
}

TEST(ChildProcess, WhatItLeavesBehindHoldsNothingUp) {
  ChildProcess child({"sh", "-c", "sleep 1000 & echo $!"}, Output::Kept);
  const std::string pid = readAll(child);
  EXPECT_EQ(child.finish(), 0);
  EXPECT_TRUE(isRunning(pid.substr(0, pid.size() - 1)));
  ::kill(std::stoi(pid), SIGKILL);
}

TEST(ChildProcess, StopEndsTheWaitingOfOtherThreads) {
  ChildProcess reads({"sleep", "1000"}, Output::Kept);
  std::jthread reader([&] { EXPECT_EQ(readAll(reads), ""); });
  ChildProcess writes({"sleep", "1000"});
  std::jthread writer([&] {
    EXPECT_FALSE(writes.write(bytesOf(std::string(5'000'000, 'x'))));
    EXPECT_EQ(writes.finish(), 128 + SIGTERM);
  });
  reads.stop();
  writes.stop();
}

TEST(ChildProcess, IsLeftWaitingWhenTheWorkIsCancelled) {
  std::stop_source stop;
  const Progress progress(stop.get_token());
  ChildProcess child({"sleep", "1000"}, Output::Kept);
  std::jthread later([&] {
    std::this_thread::sleep_for(milliseconds(20));
    stop.request_stop();
  });
  std::array<std::byte, 4> some;
  EXPECT_THROW(child.read(some, &progress), Cancelled);
  EXPECT_THROW(child.write(bytesOf(std::string(5'000'000, 'x')), &progress), Cancelled);
  EXPECT_THROW(child.finish(&progress), Cancelled);
  child.stop(milliseconds(0));
  EXPECT_EQ(child.finish(), 128 + SIGKILL);
}

TEST(ChildProcess, LeavesNoDescriptorNoZombieAndNoThread) {
  const auto threads = [] { return std::distance(fs::directory_iterator("/proc/self/task"), {}); };
  const std::size_t before = openDescriptors();
  const auto threads_before = threads();
  {
    ChildProcess cat({"cat"}, Output::Kept), yes({"yes"}, Output::Kept), done({"false"});
    done.finish();
    EXPECT_THROW(ChildProcess({"/dev/null"}), Error);
  }
  EXPECT_EQ(openDescriptors(), before);
  EXPECT_EQ(threads(), threads_before);
  EXPECT_FALSE(hasChildren());
}

TEST(ChildProcess, HasItsThreeDescriptorsAndNoOther) {
  // 3 is the folder that ls reads.
  const int inherited = ::fcntl(1, F_DUPFD, 50);  // as a careless library has it
  ChildProcess other({"cat"}, Output::Kept);
  EXPECT_EQ(outputOf({"ls", "/proc/self/fd"}), "0\n1\n2\n3\n");
  ::close(inherited);
}

TEST(ChildProcess, StartsWithDefaultSignalsWhateverIsBlockedHere) {
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const auto pipe_before = std::signal(SIGPIPE, SIG_IGN);
  const std::string status = outputOf({"grep", "-E", "^Sig(Blk|Ign|Cgt)", "/proc/self/status"});
  std::signal(SIGPIPE, pipe_before);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  EXPECT_THAT(status, HasSubstr("SigBlk:\t0000000000000000\nSigIgn:\t"));
  // 32 and 33 belong to the C library, which has them ignored.
  const std::string ignored = status.substr(status.find("SigIgn:") + 7);
  EXPECT_EQ(std::strtoull(ignored.c_str(), nullptr, 16) & 0x7fffffff, 0u);
}

TEST(ChildProcess, StartedByManyThreadsAtOnceEachEndsWithItsOwnInput) {
  // An end that leaked into another child would keep a `cat` from seeing that its input ended.
  std::atomic<int> right{0};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t) {
      threads.emplace_back([t, &right] {
        for (int i = 0; i < 10; ++i) {
          ChildProcess cat({"cat"}, Output::Kept);
          const std::string sent = std::to_string(100 * t + i);
          cat.write(bytesOf(sent));
          cat.closeInput();
          right += readAll(cat) == sent && cat.finish() == 0;
        }
      });
    }
  }
  EXPECT_EQ(right, 80);
  EXPECT_FALSE(hasChildren());
}

bool worksInAndOut() {
  ChildProcess cat({"sh", "-c", "cat; echo said >&2"}, Output::Kept);
  if (!cat.write(bytesOf("through"))) return false;
  cat.closeInput();
  return readAll(cat) == "through" && cat.finish() == 0 && cat.errorText() == "said\n";
}

TEST(ChildProcess, IsStartedWhereOurStandardStreamsAreClosed) {
  const pid_t child = ::fork();
  if (child == 0) {
    for (const int fd : {0, 1, 2}) ::close(fd);
    ::_exit(worksInAndOut() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(InstalledProgram, IsFoundByTheFoldersOfPathAlone) {
  const TempDir dir;
  std::ofstream(dir / "tool") << "#!/bin/sh\n";
  std::ofstream(dir / "text") << "no program\n";
  fs::create_directory(dir / "folder");
  fs::permissions(dir / "tool", fs::perms::owner_all);
  const SearchPath path("/nowhere::relative:" + dir.path().string());
  EXPECT_EQ(installedProgram("tool"), (dir / "tool").string());
  EXPECT_EQ(installedProgram("text"), std::nullopt);
  EXPECT_EQ(installedProgram("folder"), std::nullopt);
  EXPECT_EQ(installedProgram("cat"), std::nullopt);
  EXPECT_EQ(installedProgram(""), std::nullopt);
  EXPECT_EQ(installedProgram((dir / "tool").string()), std::nullopt) << "a path is no name";
}

TEST(InstalledProgram, IsNoneWherePathIsEmpty) {
  const SearchPath path("");
  EXPECT_EQ(installedProgram("sh"), std::nullopt);
}

}  // namespace
}  // namespace beam::testing
