// SPDX-License-Identifier: Apache-2.0
// H.264 movies (.mp4) by the installed program ffmpeg, which is started and never linked: GPL parts such as
// libx264 stay in a process of their own.
#pragma once

#include <filesystem>
#include <memory>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/io/written_by.h"

namespace beam {

// Whether ffmpeg is installed; what it can encode shows when it does.
bool canWriteMovies();

// Pictures to a movie, as they come: BT.709 primaries, transfer, matrix and limited range, said so in the
// file, YCbCr 4:2:0, quality 16 (x264's CRF). An odd width or height is one more, by a repeated last column
// or row. The same pictures give the same bytes with one and the same ffmpeg, on any number of cores.
//
// What waits for ffmpeg looks at `progress` every 50 ms: Cancelled. Throws Error{Storage} with ffmpeg's own
// words where it cannot write (disk full) or cannot encode (no libx264), in whichever call notices.
class MovieWriter {
 public:
  // `size` in pixels, at most 16384 a side; `rate` in pictures a second, in [0.01, 1000]; 23.976, 29.97 and
  // their like mean 24000/1001, 30000/1001. Throws Error{Usage} for others and where ffmpeg is not installed,
  // Error{Storage} where nothing can be written beside `file`.
  MovieWriter(const std::filesystem::path& file, ivec2 size, double rate, const FileNotes& notes = {});
  // Without finish() nothing is left.
  ~MovieWriter();
  MovieWriter(const MovieWriter&) = delete;
  MovieWriter& operator=(const MovieWriter&) = delete;

  // The next picture, sRGB, of that size.
  void add(const Image<u8vec3>& picture, const Progress* progress = nullptr);
  // Once, after at least one picture: creates or replaces `file`, as writeFileAtomically does.
  void finish(const Progress* progress = nullptr);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The notes of a movie that MovieWriter wrote: a line each of its comment. Empty for anything else.
FileNotes notesOfMovie(const std::filesystem::path& file);

}  // namespace beam
