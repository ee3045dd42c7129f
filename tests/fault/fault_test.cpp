// SPDX-License-Identifier: Apache-2.0
// Whatever call of the system fails, and whenever: the program says what it was and ends with its code, the
// project opens, the next run finishes it, and the bytes are those of an undisturbed one.
// BEAM_FAULT_MINUTES: as long a campaign instead of the short form.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <set>
#include <sstream>

#include "tests/app/cli_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

struct FaultKind {
  const char* name;
  std::vector<int> errors;
  std::set<int> codes;  // that a command may end with
};

const std::vector<FaultKind>& kinds() {
  static const std::vector<FaultKind> all = {
      {"alloc", {ENOMEM}, {0, 71}},
      {"open", {EIO, EMFILE}, {0, 74}},
      {"create", {ENOSPC, EIO, EROFS}, {0, 74}},
      {"read", {EIO}, {0, 74}},
      {"write", {ENOSPC, EIO}, {0, 74}},
      {"sync", {EIO}, {0, 74}},
      {"rename", {EIO}, {0, 74}},
      {"lock", {ENOLCK}, {0, 74}},
      {"stat", {EIO}, {0, 74}},
      {"mkdir", {ENOSPC}, {0, 74}},
  };
  return all;
}

// What is done under a fault, in a folder with a project "p.beam" that may be there and a place for what
// comes out of it.
struct Deed {
  std::string name;
  std::string from;     // the project it begins with: "", "half", "whole" or "other"
  Words words;          // $P: the project, $O: the place
  bool repeats = true;  // the same words without a fault go on from what is there
};

std::vector<Deed> deeds() {
  const Words process = Words{"process", SampleHouse::capture().string(), "--out", "$P"} + tinyTake();
  return {
      {"process", "", process},
      {"resume", "half", process},
      {"save", "whole", {"run", "$P", "--set", "surface.later.iterations=11", "--until", "capture"}},
      {"render",
       "whole",
       {"render", "$P", "--channels", "rgb,normal,mesh", "--cameras", "test", "--frames", "all",
        "--skip-existing", "--out", "$O"}},
      {"export", "whole", {"export", "$P", "--out", "$O", "--force"}},
      {"evaluate",
       "whole",
       {"evaluate", "$P", "--ground-truth", SampleHouse::capture().string(), "--json-file",
        "$O/scores.json"}},
      {"report", "whole", {"report", "$P", "--out", "$O/report.html"}},
      {"clean", "other", {"clean", "$P"}},
  };
}

class Faults : public ::testing::Test {
 protected:
  Faults() {
    const Words process = Words{"process", SampleHouse::capture().string(), "--out"};
    calmly(process + Words{project("half").string(), "--until", "surface"} + tinyTake());
    calmly(process + Words{project("whole").string()} + tinyTake());
    fs::copy(project("whole"), project("other"), fs::copy_options::recursive);
    calmly({"run", project("other").string(), "--set", "surface.later.iterations=12"});
    calmly({"run", project("other").string(), "--set", "surface.later.iterations=10"});
    calm_ = productsIn(project("whole"));
    for (const Deed& deed : deeds()) learn(deed);
  }

  fs::path project(const std::string& name) const { return folder_.path() / (name + ".beam"); }
  void calmly(const Words& words) const {
    const Said said = Running(folder_.path(), words).wait();
    if (said.code != 0) throw std::runtime_error(fmt::format("{}: {}", fmt::join(words, " "), said.err));
  }

  // A fresh place with what the deed begins with.
  void prepare(const Deed& deed) const {
    fs::remove_all(place());
    fs::create_directories(place() / "out");
    if (!deed.from.empty()) fs::copy(project(deed.from), place() / "p.beam", fs::copy_options::recursive);
  }
  fs::path place() const { return folder_.path() / "place"; }
  Words wordsOf(const Deed& deed) const {
    Words words;
    for (std::string word : deed.words) {
      for (const auto& [mark, path] : {std::pair{"$P", place() / "p.beam"}, std::pair{"$O", place() / "out"}})
        if (const std::size_t at = word.find(mark); at != std::string::npos)
          word.replace(at, 2, path.string());
      words.push_back(word);
    }
    return words;
  }

  Said under(const Deed& deed, const std::string& fault, std::size_t least_bytes) const {
    const fs::path told = folder_.path() / "told";
    fs::remove(told);
    const Words environment = {std::string("LD_PRELOAD=") + BEAM_FAULT_INJECTOR,
                               "BEAM_FAULT=" + fault,
                               "BEAM_FAULT_BELOW=" + place().string() + ":" + SampleHouse::capture().string(),
                               fmt::format("BEAM_FAULT_BYTES={}", least_bytes),
                               "BEAM_FAULT_TOLD=" + told.string(),
                               BEAM_PROGRAM};
    return Running(folder_.path(), environment + wordsOf(deed), RLIM_INFINITY, "/usr/bin/env").wait();
  }

  // How many calls of each kind an undisturbed one makes, and what comes out of it.
  void learn(const Deed& deed) {
    for (const std::size_t bytes : kLeastBytes) {
      prepare(deed);
      const Said said = under(deed, "none:0:0:0", bytes);
      if (said.code != 0) throw std::runtime_error(fmt::format("{}: {}", deed.name, said.err));
      std::istringstream told(textOf(folder_.path() / "told"));
      std::string kind;
      for (long n = 0; told >> kind >> n;) calls_[{deed.name, kind, kind == "alloc" ? bytes : 0}] = n;
    }
    outputs_[deed.name] = filesIn(place() / "out");
  }

  // What is wrong after a fault; empty: nothing.
  std::string trouble(const Deed& deed, const Said& said, const FaultKind& kind) const {
    if (!kind.codes.contains(said.code)) return fmt::format("ended with {}", said.code);
    if (said.code != 0 && said.err.find("error:") == std::string::npos) return "said nothing";
    const fs::path p = place() / "p.beam";
    const Deed process = deeds().front();
    if (fs::exists(p / "project.json") && Running(folder_.path(), {"status", p.string()}).wait().code != 0)
      return "the project does not open";
    if (const Said again = Running(folder_.path(), wordsOf(deed)).wait(); again.code != 0)
      return fmt::format("does not go on: {} {}", again.code, again.err);
    if (filesIn(place() / "out") != outputs_.at(deed.name)) return "what comes out differs";
    if (const Said back = Running(folder_.path(), wordsOf(process)).wait(); back.code != 0)
      return fmt::format("cannot be finished: {} {}", back.code, back.err);
    if (fs::exists(p / "quarantine")) return "a good result was set aside";
    Files products = productsIn(p);
    if (deed.from == "other")
      std::erase_if(products, [&](const auto& file) { return !calm_.contains(file.first); });
    return products == calm_ ? std::string() : "the results differ";
  }

  static constexpr std::size_t kLeastBytes[] = {1, 512, 65536};
  TempDir folder_;
  Files calm_;
  std::map<std::tuple<std::string, std::string, std::size_t>, long> calls_;
  std::map<std::string, Files> outputs_;
};

TEST_F(Faults, CostNothingThatWasFinishedAndAreSaid) {
  const char* minutes = std::getenv("BEAM_FAULT_MINUTES");
  const char* seed = std::getenv("BEAM_FAULT_SEED");
  const auto until = std::chrono::steady_clock::now() +
                     std::chrono::duration<double>(60 * (minutes ? std::atof(minutes) : 0.0));
  const RandomStream random(seed ? std::strtoull(seed, nullptr, 10) : 17);
  constexpr int kShort = 24;
  const std::vector<Deed> all = deeds();
  std::map<std::string, int> injected, ended;
  int trials = 0, findings = 0;
  for (; minutes ? std::chrono::steady_clock::now() < until : trials < kShort; ++trials) {
    const auto draw = [&](int what, std::uint64_t below) {
      return random.below(static_cast<std::uint64_t>(8 * trials + what), below);
    };
    const FaultKind& kind = kinds()[static_cast<std::size_t>(trials) % kinds().size()];
    const Deed& deed = all[draw(0, all.size())];
    const bool alloc = std::string(kind.name) == "alloc";
    // The short form keeps to allocations that matter, of which the program makes the same in every run.
    const std::size_t bytes = minutes ? kLeastBytes[draw(1, std::size(kLeastBytes))] : kLeastBytes[2];
    const long calls = calls_.at({deed.name, kind.name, alloc ? bytes : 0});
    if (calls == 0) continue;
    const long n = 1 + static_cast<long>(draw(2, static_cast<std::uint64_t>(calls)));
    const long count = std::array{1L, 3L, 1000000000L}[draw(3, 3)];
    const std::string fault =
        fmt::format("{}:{}:{}:{}", kind.name, n, kind.errors[draw(4, kind.errors.size())], count);
    prepare(deed);
    const Said said = under(deed, fault, bytes);
    const std::string told = textOf(folder_.path() / "told");
    injected[kind.name] += told.find("fault ") != std::string::npos;
    ++ended[fmt::format("{} {}", kind.name, said.code)];
    const std::string what = trouble(deed, said, kind);
    findings += !what.empty();
    EXPECT_EQ(what, "") << fmt::format("{} under BEAM_FAULT={} BEAM_FAULT_BYTES={}\n{}\n{}", deed.name, fault,
                                       bytes, said.err, told);
  }
  std::cout << fmt::format("{} trials, {} findings; faults that happened: {}; ends: {}\n", trials, findings,
                           injected, ended);
}

}  // namespace
}  // namespace beam::testing
