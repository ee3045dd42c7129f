// SPDX-License-Identifier: Apache-2.0
// Two processes at one take of four frames, killed at random, its settings changed in between: the bytes are
// those of runs that nothing disturbed. BEAM_KILLS: how many kills instead of the short form's.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;

class KilledTake : public ::testing::Test {
 protected:
  KilledTake() {
    calmly({"sample", capture(), "--frames", "4", "--cameras", "5", "--size", "48x64", "--samples", "4"});
  }
  std::string capture() const { return (folder_.path() / "sample").string(); }
  std::string project(const char* name) const { return (folder_.path() / name).string(); }
  void calmly(const Words& words) const {
    const Said said = Running(folder_.path(), words).wait();
    if (said.code != 0) throw std::runtime_error(said.err);
  }
  void make(const std::string& project) const {
    calmly(Words{"process", capture(), "--out", project, "--until", "capture"} + tinyTake());
  }
  static Words run(const std::string& project, int iterations) {
    return {"run", project, "--set", fmt::format("surface.later.iterations={}", iterations)};
  }

  TempDir folder_;
};

TEST_F(KilledTake, OfTwoProcessesAndChangingSettingsHasTheBytesOfCalmRuns) {
  constexpr int kIterations[] = {10, 12};
  make(project("calm.beam"));
  const auto began = std::chrono::steady_clock::now();
  for (const int iterations : kIterations) calmly(run(project("calm.beam"), iterations));
  const std::chrono::duration<double> calm = (std::chrono::steady_clock::now() - began) / 2;

  const char* wanted = std::getenv("BEAM_KILLS");
  const int most = wanted ? std::atoi(wanted) : 12;
  const RandomStream random(23);
  const std::string p = project("p.beam");
  make(p);
  int kills = 0, done = 0;
  for (std::uint64_t attempt = 0; kills < most; ++attempt) {
    ASSERT_LT(attempt, 20u * static_cast<unsigned>(most)) << "the program ends before it is killed";
    const auto draw = [&](std::uint64_t what) { return random.uniform(4 * attempt + what); };
    const fs::path other = folder_.path() / "other";
    fs::create_directories(other);
    const Running first(folder_.path(), run(p, kIterations[draw(0) < 0.5]));
    const Running second(other, {"run", p});
    std::this_thread::sleep_for(draw(1) * 0.7 * calm);
    for (const Running* process : {&first, &second}) {
      if (process == &second && draw(2) < 0.3) continue;  // it goes on alone
      process->signal(SIGKILL);
    }
    for (const Running* process : {&first, &second}) {
      const Said said = process->wait();
      ASSERT_TRUE(said.code == 0 || said.code == -SIGKILL) << said.code << " " << said.err;
      (said.code == 0 ? done : kills)++;
    }
    if (publishedIn(p) >= publishedIn(project("calm.beam"))) {  // all is there: anew
      ASSERT_TRUE(productsIn(p) == productsIn(project("calm.beam")));
      fs::remove_all(p);
      make(p);
    }
  }
  for (const int iterations : kIterations) calmly(run(p, iterations));
  EXPECT_TRUE(productsIn(p) == productsIn(project("calm.beam")));
  EXPECT_FALSE(fs::exists(fs::path(p) / "quarantine"));
  for (const auto& entry : fs::directory_iterator(fs::path(p) / "results"))
    EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
  std::cout << fmt::format("{} kills, {} processes that were done first\n", kills, done);
}

}  // namespace
}  // namespace beam::testing
