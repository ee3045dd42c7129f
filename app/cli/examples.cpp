// SPDX-License-Identifier: Apache-2.0
#include "app/cli/examples.h"

#include <map>

namespace beam {
namespace {

using Examples = std::map<std::string, std::vector<Example>>;

// A line that is typed as it stands: no angle brackets, no "...".
const Examples& table() {
  static const Examples all = {
      {"beam",
       {{"beam sample CAPTURE", "make a small synthetic capture to try everything on"},
        {"beam process CAPTURE --out Take.beam --preset draft", "photographs to relightable Gaussians"},
        {"beam render Take.beam --channels rgb,normal --out pictures",
         "pictures of every solved frame in the test cameras"}}},
      {"beam process",
       {{"beam process CAPTURE --out Take.beam",
         "make the project and run what is missing; typed again, it goes on where it stopped"},
        {"beam process CAPTURE --out Take.beam --preset draft --frames 0", "a first look at one frame"},
        {"beam process CAPTURE --out Take.beam --environment studio.exr --hold-out 4",
         "another light than the capture's own; every 4th camera is kept for testing"}}},
      {"beam new",
       {{"beam new Take.beam --capture CAPTURE", "make the project; beam run computes later"},
        {"beam new Take.beam --capture CAPTURE --preset draft --set surface.iterations=2000",
         "with a preset and a setting of its own, which the project remembers"}}},
      {"beam run",
       {{"beam run Take.beam", "run what is missing"},
        {"beam run Take.beam --frames 0-3 --until surface", "four frames as a take, without materials"},
        {"beam run Take.beam --frames 0 --set surface.iterations=2000",
         "one frame alone, with another setting"},
        {"beam run Take.beam --dry-run", "what would be computed, and about how long it takes"},
        {"beam run Take.beam --preset draft --reset --json", "with the preset alone, told as JSON events"}}},
      {"beam status",
       {{"beam status Take.beam", "what is done, what is missing, what failed and why"},
        {"beam status Take.beam --json", "the same for a script"}}},
      {"beam stages",
       {{"beam stages", "every stage, step and setting with its default, range and meaning"},
        {"beam stages Take.beam", "of a project, with the values in force and where each comes from"},
        {"beam stages --json-file stages.json", "the same also as JSON in a file"}}},
      {"beam check",
       {{"beam check CAPTURE", "cameras, frames, masks, unit, light, and what is wrong"},
        {"beam check CAPTURE --strict --json", "for a script: ends with 65 where there is a warning"},
        {"beam check studio.exr", "size, mean radiance and brightest direction of a panorama"}}},
      {"beam sample",
       {{"beam sample CAPTURE", "one frame, 12 cameras of 240x320 pixels"},
        {"beam sample CAPTURE --frames 4 --cameras 8 --size 120x160", "a moving figure, smaller pictures"}}},
      {"beam render",
       {{"beam render Take.beam --out pictures", "colour of every solved frame in the test cameras"},
        {"beam render Take.beam --channels relight --environment studio.exr --out pictures",
         "under another light, into pictures/relight_studio"},
        {"beam render Take.beam --channels relight,direct,indirect --renderer reference --spp 16 "
         "--environment studio.exr --out reference",
         "the same light followed path by path, and what of it came straight or by another surface"},
        {"beam render Take.beam --channels rgb,base_color,normal,depth --layers --out layers",
         "all of it as layers of one EXR a camera and frame"},
        {"beam render Take.beam --cameras 'test,cam0*' --out pictures --skip-existing",
         "more cameras; what is there already is left as it is"},
        {"beam render Take.beam --channels depth,normal,mesh --frames 0-3 --frame-of world --out maps",
         "geometry in world axes and metres"}}},
      {"beam evaluate",
       {{"beam evaluate Take.beam", "scores of the photographs that --hold-out kept"},
        {"beam evaluate Take.beam --ground-truth CAPTURE --json-file scores.json",
         "against a sample's ground truth, also as JSON in a file"}}},
      {"beam report",
       {{"beam report Take.beam --out quality.html", "one page: quality over time, cameras, pictures"},
        {"beam report Take.beam --out quality.html --force", "over a file that another program wrote"}}},
      {"beam export",
       {{"beam export Take.beam --out splats", "one PLY a frame, for every splat viewer"},
        {"beam export Take.beam --frames 0,2 --frame-of world --out splats",
         "two frames, in world axes and metres"}}},
      {"beam clean",
       {{"beam clean Take.beam --dry-run", "what would be removed and how much that is"},
        {"beam clean Take.beam", "remove results that no setting in force needs"}}},
      {"beam help",
       {{"beam help run", "the help of a command, as beam run --help"},
        {"beam help captures", "a topic: what the folder of a capture looks like"},
        {"beam help files", "a topic: what render and export write, and what a project holds"},
        {"beam help --json", "every command and flag for a program"}}},
      {"beam version",
       {{"beam version", "the version"},
        {"beam version --verbose", "also compiler, device, threads and where the resources are"}}},
      {"beam completion",
       {{"beam completion bash > beam.bash", "then, in bash: source beam.bash"},
        {"beam completion zsh > _beam", "then put _beam into a folder of zsh's fpath"}}},
  };
  return all;
}

}  // namespace

const std::vector<Example>& examplesOf(const std::string& command) {
  static const std::vector<Example> kNone;
  const auto found = table().find(command);
  return found == table().end() ? kNone : found->second;
}

}  // namespace beam
