// SPDX-License-Identifier: Apache-2.0
// Runs the program `beam` as a user would, and looks at what it said and wrote.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/base/rng.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {

using Words = std::vector<std::string>;

inline std::string textOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Every file below a folder by its path in it.
inline std::map<std::string, std::string> filesIn(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder).string()] = textOf(entry.path());
  }
  return files;
}

// Every file of the finished results that is a product, by its path in results/. Records hold times.
inline std::map<std::string, std::string> productsIn(const std::filesystem::path& project) {
  std::map<std::string, std::string> products = filesIn(project / "results");
  std::erase_if(products, [](const auto& file) {
    return file.first.ends_with("result.json") || file.first.front() == '.';  // half built
  });
  return products;
}

struct Said {
  int code = -1;  // exit code; minus the signal that ended it
  std::string out, err;
};

// A started program.
class Running {
 public:
  // `max_file_bytes`: what a full disk looks like, from that size of a file on.
  Running(const std::filesystem::path& scratch, const Words& words, rlim_t max_file_bytes = RLIM_INFINITY,
          const char* program = BEAM_PROGRAM)
      : out_(scratch / "stdout"), err_(scratch / "stderr") {
    child_ = ::fork();
    if (child_ != 0) return;
    redirect(out_, STDOUT_FILENO);
    redirect(err_, STDERR_FILENO);
    std::vector<char*> arguments = {const_cast<char*>(program)};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::setenv("XDG_STATE_HOME", (scratch / "state").c_str(), 1);  // what it remembers of this machine
    const rlimit limit{max_file_bytes, RLIM_INFINITY};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::execv(program, arguments.data());
    ::_exit(127);
  }
  void signal(int number) const { ::kill(child_, number); }
  // Returns when the program has a handler for the signal, or has ended.
  void awaitHandlerOf(int number) const {
    const std::string file = "/proc/" + std::to_string(child_) + "/status";
    for (bool caught = false; !caught && !ended();
         std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
      const std::string status = textOf(file);
      const std::size_t at = status.find("SigCgt:");
      if (at == std::string::npos) continue;
      caught = (std::stoull(status.substr(at + 7), nullptr, 16) >> (number - 1)) & 1;
    }
  }
  bool ended() const {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
           info.si_pid != 0;
  }
  Said wait() const {
    int status = 0;
    ::waitpid(child_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), textOf(out_), textOf(err_)};
  }

 private:
  static void redirect(const std::filesystem::path& file, int descriptor) {
    const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (opened < 0 || ::dup2(opened, descriptor) < 0) ::_exit(126);
  }
  std::filesystem::path out_, err_;
  pid_t child_ = -1;
};

// Results that a project holds for good.
inline int publishedIn(const std::filesystem::path& project) {
  std::error_code none;
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(project / "results", none))
    count += std::filesystem::exists(entry.path() / "result.json", none);
  return count;
}

// What a command does when nothing disturbs it.
struct CalmRun {
  std::chrono::duration<double> took{};
  int results = 0;
};
inline CalmRun runCalmly(const std::filesystem::path& scratch, const Words& words,
                         const std::filesystem::path& project) {
  const auto began = std::chrono::steady_clock::now();
  const Said said = Running(scratch, words).wait();
  if (said.code != 0) throw std::runtime_error("beam: " + said.err);
  return {std::chrono::steady_clock::now() - began, publishedIn(project)};
}

// Kills runs of a command until `times` of them left work undone; returns how many did. Every other one, from
// the first on, dies as soon as it published a result, the rest after a random part of the calm run's time.
// One that was done first is none: the project begins anew, with shorter parts.
inline int cutShort(const std::filesystem::path& scratch, const Words& words,
                    const std::filesystem::path& project, CalmRun calm, int times) {
  const RandomStream random(5);
  int cut = 0;
  for (int attempt = 0; cut < times && attempt < 20 * times; ++attempt) {
    const int before = publishedIn(project);
    const Running run(scratch, words);
    if (cut % 2 == 0) {
      while (!run.ended() && publishedIn(project) == before)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } else {
      std::this_thread::sleep_for(0.5 * random.uniform(static_cast<std::uint64_t>(attempt)) * calm.took);
    }
    run.signal(SIGKILL);
    const Said said = run.wait();
    if (said.code != 0 && said.code != -SIGKILL)
      throw std::runtime_error("beam ended before it was killed: " + said.err);
    if (said.code == -SIGKILL && publishedIn(project) < calm.results) {
      ++cut;
      continue;
    }
    std::filesystem::remove_all(project);
    calm.took /= 2;
  }
  return cut;
}

// A folder with the sample capture in it: 5 cameras of 48 x 64 pixels, two frames, made once for all tests.
class SampleHouse {
 public:
  static const std::filesystem::path& capture() {
    static const SampleHouse house;
    return house.capture_;
  }

 private:
  SampleHouse() : capture_(folder_.path() / "sample") {
    const Said said = Running(folder_.path(), {"sample", capture_.string(), "--frames", "2", "--cameras", "5",
                                               "--size", "48x64", "--samples", "4"})
                          .wait();
    if (said.code != 0) throw std::runtime_error("beam sample: " + said.err);
  }
  TempDir folder_;
  std::filesystem::path capture_;
};

inline Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Settings that make a frame take a moment; the numbers are not meant to be good.
inline Words tinyTake() {
  Words words;
  for (const char* setting :
       {"track.joints=100", "track.first_iterations=10", "track.iterations=8", "surface.iterations=20",
        "surface.cap=400", "surface.later.iterations=10", "surface.mesh.voxel_m=0.03",
        "materials.ao_samples=4", "materials.base_color_samples=5"}) {
    words = words + Words{"--set", setting};
  }
  return words;
}

// Likewise, and one frame alone.
inline Words tiny() { return tinyTake() + Words{"--frames", "0"}; }

// A project of the sample with its first frame solved, made once for all tests, which change no result of it.
class SolvedHouse {
 public:
  static const std::filesystem::path& project() {
    static const SolvedHouse house;
    return house.project_;
  }

 private:
  SolvedHouse() : project_(folder_.path() / "p.beam") {
    const Words words{"process", SampleHouse::capture().string(), "--out", project_.string()};
    const Said said = Running(folder_.path(), words + tiny()).wait();
    if (said.code != 0) throw std::runtime_error("beam process: " + said.err);
  }
  TempDir folder_;
  std::filesystem::path project_;
};

}  // namespace beam::testing
