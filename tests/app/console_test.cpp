// SPDX-License-Identifier: Apache-2.0
// What `beam` shows on a terminal, and what becomes of words that standard output does not take.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <sstream>

#include "tests/app/cli_support.h"
#include "tests/support/screen.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

winsize sizeOf(unsigned short columns) { return {24, columns, 0, 0}; }

// The program on a terminal of its own.
class OnTerminal {
 public:
  OnTerminal(const Words& words, unsigned short columns, const char* kind = "xterm") : screen_(columns) {
    winsize size = sizeOf(columns);
    child_ = ::forkpty(&terminal_, nullptr, nullptr, &size);
    if (child_ != 0) return;
    ::setenv("TERM", kind, 1);
    std::vector<char*> arguments = {const_cast<char*>(BEAM_PROGRAM)};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(BEAM_PROGRAM, arguments.data());
    ::_exit(127);
  }
  // Reads until the program ends or nothing more is wanted.
  template <class Enough>
  void readUntil(Enough&& enough) {
    char bytes[4096];
    while (!enough()) {
      const ssize_t n = ::read(terminal_, bytes, sizeof(bytes));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return;  // EIO: the program has gone
      all_.append(bytes, static_cast<std::size_t>(n));
      screen_.take(std::string(bytes, static_cast<std::size_t>(n)));
    }
  }
  void resize(unsigned short columns) {
    // The program rests meanwhile: what it wrote before must not be taken for what comes after.
    ::kill(child_, SIGSTOP);
    ::waitpid(child_, nullptr, WUNTRACED);
    readUntil([&] {
      int waiting = 0;
      return ::ioctl(terminal_, FIONREAD, &waiting) != 0 || waiting == 0;
    });
    const winsize size = sizeOf(columns);
    ::ioctl(terminal_, TIOCSWINSZ, &size);
    screen_.resize(columns);
    ::kill(child_, SIGCONT);
  }
  int wait() {
    readUntil([] { return false; });
    int status = 0;
    ::waitpid(child_, &status, 0);
    ::close(terminal_);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  const Screen& screen() const { return screen_; }
  const std::string& all() const { return all_; }

 private:
  Screen screen_;
  std::string all_;
  int terminal_ = -1;
  pid_t child_ = -1;
};

class Terminal : public ::testing::Test {
 protected:
  Words process(const char* project) const {
    return Words{"process", SampleHouse::capture().string(), "--out", (folder_.path() / project).string()} +
           tiny();
  }
  static void expectWhole(const Screen& screen) {
    EXPECT_EQ(screen.wraps(), 0u);
    // Folded at a blank where the terminal is narrow.
    for (const char* step : {"surface.refine:", "materials.fit:", "capture.import:"})
      EXPECT_TRUE(screen.holds(step)) << step;
    EXPECT_TRUE(screen.holds("computed")) << "the last line";
  }
  TempDir folder_;
};

TEST_F(Terminal, NoLineIsLongerThanTheTerminalIsWideAndNoneIsLost) {
  for (const unsigned short columns : {40, 80, 200}) {
    OnTerminal run(process(std::to_string(columns).c_str()), columns);
    EXPECT_EQ(run.wait(), 0);
    expectWhole(run.screen());
    EXPECT_THAT(run.all(), HasSubstr(" % ")) << "a bar was drawn";
  }
}

TEST_F(Terminal, WordsOfAnAnswerAreFoldedThereAndNotInAFile) {
  OnTerminal run({"stages"}, 80);
  EXPECT_EQ(run.wait(), 0);
  EXPECT_EQ(run.screen().wraps(), 0u);
  EXPECT_TRUE(run.screen().holds("    capture.screen.enabled") ||
              run.screen().holds("  capture.screen.enabled"));
  const std::string piped = Running(folder_.path(), {"stages"}).wait().out;
  std::istringstream lines(piped);
  std::size_t longest = 0;
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  EXPECT_GT(longest, 100u) << "a line is one thing to a program that reads it";
}

TEST_F(Terminal, ItsWidthMayChangeWhileTheProgramRuns) {
  OnTerminal run(process("p.beam"), 200);
  run.readUntil([&] { return run.screen().holds("surface.seed: done"); });
  run.resize(40);
  run.readUntil([&] { return run.screen().holds("surface.mesh: done"); });
  run.resize(80);
  EXPECT_EQ(run.wait(), 0);
  expectWhole(run.screen());
}

TEST_F(Terminal, OfADumbKindGetsPlainLines) {
  OnTerminal run(process("p.beam"), 80, "dumb");
  EXPECT_EQ(run.wait(), 0);
  EXPECT_THAT(run.all(), HasSubstr("surface.mesh: done"));
  EXPECT_THAT(run.all(), Not(HasSubstr("\033")));
}

TEST_F(Terminal, WhatIsThereAlreadyIsOneLineAStage) {
  const auto linesWith = [](const Said& said, const std::string& words) {
    std::istringstream lines(said.err);
    int found = 0;
    for (std::string line; std::getline(lines, line);) found += line.find(words) != std::string::npos;
    return found;
  };
  const Said first = Running(folder_.path(), process("p.beam") + Words{"--verbose"}).wait();
  ASSERT_EQ(first.code, 0);
  EXPECT_EQ(linesWith(first, "surface.mesh, frame 000000 done in"), 1) << first.err;
  EXPECT_EQ(linesWith(first, "surface.mesh: done"), 0) << "said once";
  const Said said = Running(folder_.path(), process("p.beam")).wait();
  std::istringstream lines(said.err);
  int reused = 0;
  for (std::string line; std::getline(lines, line);) reused += line.ends_with("reused");
  EXPECT_EQ(reused, 4) << said.err;
  EXPECT_THAT(Running(folder_.path(), process("p.beam") + Words{"--verbose"}).wait().err,
              HasSubstr("surface.mesh: reused"));
}

// `command` of a shell in which $B is the program and $F a folder of its own.
Said inShell(const TempDir& folder, const std::string& command) {
  const std::string setup = std::string("B=") + BEAM_PROGRAM + "; F=" + folder.path().string() + "; ";
  return Running(folder.path(), {"-c", setup + command}, RLIM_INFINITY, "/bin/sh").wait();
}

TEST(StandardOutput, ThatIsFullEndsEveryCommandWith74) {
  const TempDir folder;
  ASSERT_EQ(Running(folder.path(),
                    Words{"process", SampleHouse::capture().string(), "--out", (folder / "p.beam").string()} +
                        tiny())
                .wait()
                .code,
            0);
  const std::string capture = SampleHouse::capture().string();
  for (const std::string& command :
       {std::string("--version"), std::string("--help"), std::string("run --help"), std::string("stages"),
        std::string("stages --json"), std::string("status $F/p.beam"), std::string("status $F/p.beam --json"),
        "check " + capture, "check " + capture + " --json",
        std::string("evaluate $F/p.beam --ground-truth ") + capture,
        std::string("report $F/p.beam --out $F/r.html"),
        std::string("render $F/p.beam --channels depth --frames 0 --out $F/r"),
        std::string("export $F/p.beam --out $F/e"), "new $F/n.beam --capture " + capture,
        std::string("sample $F/s --frames 1 --cameras 2 --size 16x16 --samples 1")}) {
    const Said said = inShell(folder, "$B " + command + " > /dev/full");
    EXPECT_EQ(said.code, 74) << command << "\n" << said.err;
    EXPECT_THAT(said.err, HasSubstr("standard output")) << command;
  }
}

TEST(StandardError, ThatIsFullEndsWith74WhereTheWorkWentWellAndSomethingWasToBeTold) {
  const TempDir folder;
  const std::string run =
      fmt::format("$B process {} --out $F/p.beam --until capture", SampleHouse::capture().string());
  EXPECT_EQ(inShell(folder, run + " 2> /dev/full").code, 74);
  EXPECT_EQ(inShell(folder, run + " --quiet 2> /dev/full").code, 0) << "nothing was to be told";
  EXPECT_EQ(inShell(folder, "$B status $F/none.beam 2> /dev/full").code, 65) << "what it came to is worse";
  EXPECT_EQ(inShell(folder, "$B run $F/p.beam --set surface.iterations=x 2> /dev/full").code, 2);
}

}  // namespace
}  // namespace beam::testing
