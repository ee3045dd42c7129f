// SPDX-License-Identifier: Apache-2.0
// Runs the program `beam` as a user would, and looks at what it said and wrote.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

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

struct Said {
  int code = -1;  // exit code; minus the signal that ended it
  std::string out, err;
};

// A started program.
class Running {
 public:
  // `max_file_bytes`: what a full disk looks like, from that size of a file on.
  Running(const std::filesystem::path& scratch, const Words& words, rlim_t max_file_bytes = RLIM_INFINITY)
      : out_(scratch / "stdout"), err_(scratch / "stderr") {
    child_ = ::fork();
    if (child_ != 0) return;
    redirect(out_, STDOUT_FILENO);
    redirect(err_, STDERR_FILENO);
    std::vector<char*> arguments = {const_cast<char*>(BEAM_PROGRAM)};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const rlimit limit{max_file_bytes, RLIM_INFINITY};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::execv(BEAM_PROGRAM, arguments.data());
    ::_exit(127);
  }
  void signal(int number) const { ::kill(child_, number); }
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

}  // namespace beam::testing
