// SPDX-License-Identifier: Apache-2.0
// Digests of what the user's files say, for keys: by content, never by path or time. Files are hashed once
// and again only when size, time or inode changed.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/scene/capture.h"

namespace beam {

// Cameras, split and seed points as text: one line a view, numbers in shortest round-trip form. A lens is
// told only where there is one.
std::string calibrationText(const CaptureSet& capture);
inline constexpr const char* kCamerasFile = "cameras.txt";  // of the capture's import: that text
// Its cameras back. Throws Error{Data} for a line that it does not understand.
std::vector<View> viewsOfCalibration(const std::string& text);
std::size_t seedPointsOfCalibration(const std::string& text);  // how many; 0 also where it does not say

// What a picture of a frame and its mask say.
struct PictureDigest {
  std::string view;                // its camera
  std::vector<std::string> files;  // paths; none: of a source without files
  std::vector<std::string> words;  // digests, one a file, or "unreadable"; one of a source without files
};

// Safe to use from several threads.
class InputDigests {
 public:
  Digest calibration(const CaptureSet& capture) const;
  // Those of the frame's views of `split` that are there, in the order of the views; what `pictures` is of.
  std::vector<PictureDigest> eachPicture(const CaptureSet& capture, FrameIndex frame, Split split) const;
  // Pictures and masks of the frame's views of `split`. Does not throw for one that is gone or that nobody
  // may read: a run leaves it out, and the state of a project must not hang on it. Error{Storage} where the
  // disk fails.
  Digest pictures(const CaptureSet& capture, FrameIndex frame, Split split) const;
  Digest file(const std::filesystem::path& path) const;

 private:
  mutable std::mutex mutex_;
  struct Known {
    std::string stamp;  // size, time, inode
    Digest digest;
  };
  mutable std::map<std::string, Known> files_;
};

}  // namespace beam
