// SPDX-License-Identifier: Apache-2.0
#include "core/work/look_shots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/base/error.h"
#include "core/base/file_reference.h"
#include "core/base/log.h"
#include "core/io/camera_track_json.h"
#include "core/io/file.h"
#include "core/work/referred_file.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTurntable = "turntable";
constexpr double kTurn_s = 10, kLoneRate = 30;
constexpr double kFrameTolerance = 1e-6;  // of a frame: times are often n / rate, which rounds either way

ChosenPath pathIn(const fs::path& file) {
  ChosenPath path{file.stem().string(), parseCameraTrack(readTextFile(file), file.string())};
  for (const std::string& remark : remarks(*path.track)) logWarning("\"{}\": {}", file.string(), remark);
  for (const std::string& unknown : unknownMembers(*path.track))
    logWarning("\"{}\": \"{}\" is nothing that this program knows: it has no effect", file.string(), unknown);
  if (!isLookName(path.name))
    throw Error(Error::Kind::Data, fmt::format("\"{}\": \"{}\" is no name of a folder; rename the file",
                                               file.string(), path.name));
  return path;
}

std::optional<ChosenPath> ownPath(const CameraPath& path, const fs::path& folder) {
  if (path.kind == kTurntable) return ChosenPath{kTurntable, {}};
  if (path.kind != "file") return {};
  return pathIn(
      referredFile(path.file, folder, "the look's camera path", "leave it out with --camera-path none"));
}

double requirePositive(double value, const char* what) {
  if (std::isfinite(value) && value > 0) return value;
  throw Error(Error::Kind::Usage, fmt::format("{} expects a number over 0, found {}", what, value));
}

}  // namespace

std::optional<ChosenPath> chosenPath(const std::string& words, const Look& look, const fs::path& folder) {
  if (words.empty()) return ownPath(look.camera_path, folder);
  if (words == "none") return {};
  if (words == kTurntable) return ChosenPath{kTurntable, {}};
  if (!isThere(words)) {
    throw Error(Error::Kind::Usage,
                fmt::format("--camera-path expects turntable, none or a file, found \"{}\"", words));
  }
  return pathIn(words);
}

std::vector<LookShot> standingShots(const std::vector<View>& views, const std::vector<FrameIndex>& frames,
                                    const GaussianSequence& sequence, const std::string& folder,
                                    std::string_view extension) {
  std::vector<LookShot> shots;
  for (const FrameIndex frame : frames) {
    for (const View& view : views) {
      shots.push_back(
          {view.camera, view.name, frame, frame.value / sequence.rate(),
           fs::path(folder) / view.name / fmt::format("{}.{}", nameOf(sequence, frame), extension)});
    }
  }
  return shots;
}

FrameIndex frameToAndFro(const std::vector<FrameIndex>& frames, double rate, double time_s) {
  const int span = frames.back().value - frames.front().value;
  if (span == 0) return frames.front();
  const double passed = std::fmod(std::floor(time_s * rate + kFrameTolerance), 2.0 * span);
  const int due = frames.front().value + static_cast<int>(passed > span ? 2 * span - passed : passed);
  const auto after = std::upper_bound(frames.begin(), frames.end(), FrameIndex{due});
  return *(after - 1);
}

Film filmShots(const ChosenPath& path, const FilmTiming& timing, const View& first,
               const std::vector<FrameIndex>& frames, const GaussianSequence& sequence,
               const std::function<dvec3()>& middle, const std::string& folder, std::string_view extension) {
  Film film{.rate = requirePositive(timing.rate.value_or(frames.size() > 1 ? sequence.rate() : kLoneRate),
                                    "--rate")};
  const double last_s = path.track ? path.track->keys.back().time_s : 0;
  const double keyed_s = last_s > 0 ? last_s : kTurn_s;
  const double duration_s = requirePositive(timing.duration_s.value_or(keyed_s), "--duration");
  const double count = std::max(1.0, std::round(duration_s * film.rate));
  if (count > kMostFilmPictures) {
    throw Error(Error::Kind::Usage,
                fmt::format("a film of {} s at {} pictures a second has {:.0f} of them, expected "
                            "at most {}: shorten --duration or lower --rate",
                            duration_s, film.rate, count, kMostFilmPictures));
  }
  const dvec3 axis = path.track ? dvec3(0) : middle();
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const double time_s = i / film.rate;
    const Camera camera = path.track
                              ? cameraAt(*path.track, time_s, {first.camera.width, first.camera.height})
                              : turnedAround(first.camera, axis, glm::two_pi<double>() * i / count);
    film.shots.push_back({camera, path.name, frameToAndFro(frames, sequence.rate(), time_s), time_s,
                          fs::path(folder) / path.name / fmt::format("{:06}.{}", i, extension)});
  }
  return film;
}

}  // namespace beam
