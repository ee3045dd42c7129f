// SPDX-License-Identifier: Apache-2.0
#include "core/work/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "core/base/error.h"
#include "core/base/fields.h"
#include "core/scene/frame_list.h"

namespace beam {

std::vector<View> selectViews(const std::string& words, const CaptureSet& capture) {
  std::vector<View> chosen;
  const auto addAll = [&](auto&& wanted) {
    std::copy_if(capture.views.begin(), capture.views.end(), std::back_inserter(chosen), wanted);
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

std::vector<FrameIndex> selectSolvedFrames(const std::string& list, const GaussianSequence& sequence,
                                           const Progress& progress) {
  if (list != "all") return parseFrameList(list, namesOf(sequence));
  std::vector<FrameIndex> solved;
  for (std::size_t f = 0; f < sequence.frames().size(); ++f) {
    progress.check();
    const FrameIndex frame{static_cast<std::int32_t>(f)};
    if (sequence.content(frame).gaussians) solved.push_back(frame);
  }
  if (solved.empty()) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": no frame is solved yet: beam run it first", sequence.id()));
  }
  return solved;
}

std::vector<std::string> interpolatedOf(const GaussianSequence& sequence,
                                        const std::vector<FrameIndex>& frames) {
  std::vector<std::string> names;
  for (const FrameIndex f : frames) {
    if (sequence.content(f).interpolated) names.push_back(nameOf(sequence, f));
  }
  return names;
}

}  // namespace beam
