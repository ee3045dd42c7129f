// SPDX-License-Identifier: Apache-2.0
#include "core/work/selection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/base/fields.h"
#include "core/base/word_list.h"
#include "core/scene/frame_list.h"
#include "core/scene/name_pattern.h"

namespace beam {

namespace {

bool isChosen(const View& view, const std::string& word) {
  const std::string kind = lowerCase(word);
  if (kind == "all") return true;
  if (kind == "test" || kind == "train") return view.split == (kind == "test" ? Split::Test : Split::Train);
  return matchesName(word, view.name);
}

[[noreturn]] void choosesNothing(const std::string& word, const CaptureSet& capture) {
  const std::string kind = lowerCase(word);
  if (kind == "test" || kind == "train") {
    throw Error(Error::Kind::Usage,
                fmt::format("--cameras {}: the project has none; hold some out with --hold-out, or "
                            "name cameras",
                            word));
  }
  std::vector<std::string> names;
  for (const View& v : capture.views) names.push_back(v.name);
  if (isPattern(word)) {
    throw Error(Error::Kind::Usage, fmt::format("--cameras: no camera is like \"{}\"; {}", word,
                                                knownNames("cameras", word, names)));
  }
  const std::string known = knownNames("cameras", word, names);
  throw Error(Error::Kind::Usage, fmt::format("--cameras: {}", noSuchName("camera", word, names, known)));
}

}  // namespace

std::string usualCameras(const CaptureSet& capture) {
  const bool some = std::any_of(capture.views.begin(), capture.views.end(),
                                [](const View& view) { return view.split == Split::Test; });
  return some ? "test" : "all";
}

std::vector<View> selectViews(const std::string& words, const CaptureSet& capture,
                              std::optional<ivec2> size) {
  std::vector<View> chosen;
  std::set<std::string> names;
  for (const std::string& word : splitAtCommas(words)) {
    bool some = false;
    for (const View& view : capture.views) {
      if (!isChosen(view, word)) continue;
      some = true;
      if (names.insert(view.name).second) chosen.push_back(view);
    }
    if (!some) choosesNothing(word, capture);
  }
  if (chosen.empty()) {
    throw Error(Error::Kind::Usage,
                "--cameras is empty; expected test, train, all, or names and patterns with commas");
  }
  for (View& view : chosen)
    if (size) view.camera = fittedTo(view.camera, size->x, size->y);
  return chosen;
}

std::vector<FrameIndex> selectSolvedFrames(const std::string& list, const GaussianSequence& sequence,
                                           const Progress& progress) {
  if (!isAllFrames(list)) return parseFrameList(list, namesOf(sequence));
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
