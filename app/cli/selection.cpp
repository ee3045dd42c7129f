// SPDX-License-Identifier: Apache-2.0
#include "app/cli/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "core/base/error.h"
#include "core/pipeline/frame_list.h"
#include "core/stages/interpolated_frame.h"

namespace beam {

std::vector<ViewIndex> selectViews(const std::string& words, const CaptureSet& capture) {
  std::vector<ViewIndex> chosen;
  const auto addAll = [&](auto&& wanted) {
    for (std::size_t v = 0; v < capture.views.size(); ++v) {
      if (wanted(capture.views[v])) chosen.push_back({static_cast<std::int32_t>(v)});
    }
  };
  if (words == "all") {
    addAll([](const View&) { return true; });
  } else if (words == "test" || words == "train") {
    const Split split = words == "test" ? Split::Test : Split::Train;
    addAll([&](const View& v) { return v.split == split; });
    if (chosen.empty()) {
      throw Error(Error::Kind::Usage,
                  fmt::format("--cameras {}: the project has none; hold some out with --hold-out, or "
                              "name cameras",
                              words));
    }
  } else {
    std::istringstream in(words);
    for (std::string name; std::getline(in, name, ',');) {
      const std::size_t before = chosen.size();
      addAll([&](const View& v) { return v.name == name; });
      if (chosen.size() > before) continue;
      std::vector<std::string> names;
      for (const View& v : capture.views) names.push_back(v.name);
      throw Error(Error::Kind::Usage,
                  fmt::format("--cameras: there is no camera \"{}\"; did you mean \"{}\"?", name,
                              nearestName(name, names)));
    }
  }
  return chosen;
}

std::vector<FrameIndex> selectSolvedFrames(const std::string& list, const Project& project,
                                           bool interpolated) {
  if (list != "all") return parseFrameList(list, project.capture().frames);
  std::vector<FrameIndex> solved;
  for (std::size_t f = 0; f < project.capture().frames.size(); ++f) {
    const FrameIndex frame{static_cast<std::int32_t>(f)};
    // Later frames of a take are not fitted anew.
    const bool is_solved = project.state("surface.fit", frame) == StepState::Done ||
                           project.state("surface.refine", frame) == StepState::Done;
    if (is_solved || (interpolated && solvedAround(project, frame))) solved.push_back(frame);
  }
  if (solved.empty()) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": no frame is solved yet: beam run it first", project.folder().string()));
  }
  return solved;
}

}  // namespace beam
