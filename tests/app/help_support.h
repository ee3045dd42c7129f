// SPDX-License-Identifier: Apache-2.0
// A folder as somebody has it who tries the examples of the help: the capture CAPTURE of four frames, the
// panorama studio.exr, the look key.json and the solved project Take.beam, with cameras held out.
#pragma once

#include <nlohmann/json.hpp>

#include "tests/app/cli_support.h"

namespace beam::testing {

// A line as typed into a shell, in `folder`; `bin` has a program `beam` of its own.
inline Said typed(const std::filesystem::path& folder, const std::string& line,
                  const std::filesystem::path& bin = {}) {
  const TempDir scratch;
  const std::string path = bin.empty() ? std::filesystem::path(BEAM_PROGRAM).parent_path() : bin;
  const std::string script =
      "cd '" + folder.string() + "' && export HOME=\"$PWD\" PATH='" + path + "':\"$PATH\" && " + line;
  return Running(scratch.path(), {"-c", script}, RLIM_INFINITY, "/bin/bash").wait();
}

// What the program says of itself.
inline const nlohmann::json& helpOfProgram() {
  static const nlohmann::json help = [] {
    const TempDir scratch;
    return nlohmann::json::parse(Running(scratch.path(), {"help", "--json"}).wait().out);
  }();
  return help;
}

class ExampleHouse {
 public:
  static const ExampleHouse& get() {
    static const ExampleHouse house;
    return house;
  }
  // With a program `beam` that makes less of everything that is not said.
  std::filesystem::path bin() const { return folder_.path() / "bin"; }

  // The same in another folder. The capture is only read.
  void copyInto(const std::filesystem::path& folder) const {
    namespace fs = std::filesystem;
    fs::create_directory_symlink(folder_.path() / "CAPTURE", folder / "CAPTURE");
    fs::copy(folder_.path() / "studio.exr", folder / "studio.exr");
    std::ofstream(folder / "key.json") << smallLook();
    fs::copy(folder_.path() / "Take.beam", folder / "Take.beam", fs::copy_options::recursive);
  }

 private:
  // As beam help looks shows it.
  std::string smallLook() const {
    const std::string text = typed(folder_.path(), "beam help looks", bin()).out;
    const std::size_t begin = text.find('{'), end = text.find("\n\n", begin);
    return text.substr(begin, end - begin);
  }
  // Without the true mesh: to find the distance to the little that so few steps make takes minutes.
  ExampleHouse() {
    namespace fs = std::filesystem;
    fs::create_directory(bin());
    std::ofstream(bin() / "beam") << program();
    fs::permissions(bin() / "beam", fs::perms(0755));
    for (const char* line : {"beam sample CAPTURE --frames 4", "cp CAPTURE/gt/environments/studio.exr .",
                             "rm -r CAPTURE/gt/mesh", "beam process CAPTURE --out Take.beam --hold-out 4"}) {
      const Said said = typed(folder_.path(), line, bin());
      if (said.code != 0) throw std::runtime_error(std::string(line) + ": " + said.err);
    }
  }
  static std::string program() {
    std::string script =
        "#!/bin/bash\nless=()\nsay() { [[ \" ${all[*]} \" == *\" $1 \"* ]] || less+=(\"$@\"); }\n";
    script +=
        "all=(\"$@\")\ncase \"$1\" in\n  sample)\n    say --size 48x64; say --cameras 5; say --samples 4 "
        ";;\n";
    script += "  process | run)\n    less=(";
    for (const std::string& word : tinyTake()) script += word + " ";
    return script + ") ;;\nesac\nexec '" BEAM_PROGRAM "' \"$@\" \"${less[@]}\"\n";
  }
  TempDir folder_;
};

}  // namespace beam::testing
