// SPDX-License-Identifier: Apache-2.0
// The pictures that a look is drawn into: of the capture's cameras, or of one that moves.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/camera_track.h"
#include "core/scene/capture.h"
#include "core/scene/gaussian_sequence.h"
#include "core/scene/look.h"

namespace beam {

struct LookShot {
  Camera camera;
  std::string camera_name;
  FrameIndex frame;
  double time_s = 0;           // of the look
  std::filesystem::path file;  // below the folder of the pictures
};

// How the camera moves, as it was chosen.
struct ChosenPath {
  std::string name;                  // of its pictures' folder: "turntable", or that of its file
  std::optional<CameraTrack> track;  // none: it goes around the subject once
};
// `words`: empty for the look's own, "none", "turntable" or a file; relative references of the look are to
// `folder`. Empty: the cameras stand. Throws Error{Usage} for a file that is not there, Error{Data} for one
// that is none and where the look's own is gone.
std::optional<ChosenPath> chosenPath(const std::string& words, const Look& look,
                                     const std::filesystem::path& folder);

inline constexpr int kMostFilmPictures = 100'000;

struct FilmTiming {
  std::optional<double> duration_s = {};  // none: that of the keys; of a turntable and a lone key 10 s
  std::optional<double> rate = {};        // pictures a second; none: that of the take, of a lone frame 30
};

// Every frame by every view; the time of a frame is its place in the capture over the rate.
std::vector<LookShot> standingShots(const std::vector<View>& views, const std::vector<FrameIndex>& frames,
                                    const GaussianSequence& sequence, const std::string& folder,
                                    std::string_view extension);

struct Film {
  double rate = 30;
  std::vector<LookShot> shots = {};
};
// The take plays at its own rate, to and fro until the time is over; a lone frame stands. `first`: of a
// turntable, which begins there, and of whose size all pictures are. `middle`: asked for a place on the axis
// of a turntable. Throws Error{Usage} for a film without end or without a picture.
Film filmShots(const ChosenPath& path, const FilmTiming& timing, const View& first,
               const std::vector<FrameIndex>& frames, const GaussianSequence& sequence,
               const std::function<dvec3()>& middle, const std::string& folder, std::string_view extension);

// Which of `frames`, ascending, is seen at a time: the last at or before it, to and fro.
FrameIndex frameToAndFro(const std::vector<FrameIndex>& frames, double rate, double time_s);

}  // namespace beam
