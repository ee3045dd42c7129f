// SPDX-License-Identifier: Apache-2.0
#include "core/io/movie_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/io/file.h"

namespace beam {
namespace {

constexpr int kMaxSide = 16384;  // H.264 and libx264
constexpr double kLeastRate = 0.01, kMostRate = 1000;
static_assert(sizeof(u8vec3) == 3);

// Rates of 1000/1001 are told by two or three decimals, which would be other rates.
std::string rateText(double rate) {
  for (const int whole : {24, 30, 48, 60, 120})
    if (std::abs(rate - whole / 1.001) < 0.005) return fmt::format("{}/1001", whole * 1000);
  return fmt::format("{}", rate);
}

// A line each, as PLY comments have them; what ends a line or an argument cannot be in one.
std::string commentOf(const FileNotes& notes) {
  std::string comment;
  for (const auto& [name, text] : notes) {
    if (!comment.empty()) comment += '\n';
    for (const char c : name + ' ' + text) comment += c == '\n' || c == '\0' ? ' ' : c;
  }
  return comment;
}

std::string installedFfmpeg() {
  if (const std::optional<std::string> program = installedProgram("ffmpeg")) return *program;
  throw Error(
      Error::Kind::Usage,
      "a movie is written by the program ffmpeg, which is not in the folders of PATH; install the package "
      "ffmpeg, or leave the movie out");
}

std::vector<std::string> ffmpegWords(const std::filesystem::path& file, ivec2 size, double rate,
                                     const FileNotes& notes) {
  std::vector<std::string> words = {installedFfmpeg(), "-nostdin", "-hide_banner", "-loglevel",
                                    "repeat+error"};
  const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
  add({"-xerror"});  // what goes wrong is its end, and its exit code
  add({"-protocol_whitelist", "file,pipe", "-f", "rawvideo", "-pixel_format", "rgb24"});
  add({"-video_size", fmt::format("{}x{}", size.x, size.y), "-framerate", rateText(rate), "-i", "pipe:0"});
  // Without being told, `scale` takes the matrix of BT.601, and chroma between two columns where H.264 has it
  // at the left one. The transfer is said to be BT.709 and not sRGB: players show both alike, and many know
  // but one.
  add({"-vf",
       "scale=out_color_matrix=bt709:out_range=tv:out_h_chr_pos=0:out_v_chr_pos=128"
       ":flags=bicubic+accurate_rnd+full_chroma_inp+full_chroma_int+bitexact,format=yuv420p"
       ",setparams=range=tv:color_primaries=bt709:color_trc=bt709:colorspace=bt709"});
  add({"-pix_fmt", "yuv420p", "-color_range", "tv", "-color_primaries", "bt709"});
  add({"-color_trc", "bt709", "-colorspace", "bt709"});
  // What x264 decides depends on its number of threads, so that is none of the machine's.
  add({"-c:v", "libx264", "-preset", "medium", "-crf", "16", "-threads", "8"});
  add({"-fflags", "+bitexact", "-flags", "+bitexact", "-movflags", "+faststart"});
  if (!notes.empty()) add({"-metadata", "comment=" + commentOf(notes)});
  add({"-f", "mp4", "-y", "file:" + file.string()});  // file: no name is an option, a protocol or a pattern
  return words;
}

void requireMovie(const std::filesystem::path& file, ivec2 size, double rate) {
  if (size.x < 1 || size.y < 1 || size.x > kMaxSide || size.y > kMaxSide) {
    throw Error(Error::Kind::Usage, fmt::format("movie \"{}\": expected 1 to {} pixels a side, found {} x {}",
                                                file.string(), kMaxSide, size.x, size.y));
  }
  if (!(rate >= kLeastRate && rate <= kMostRate)) {
    throw Error(Error::Kind::Usage, fmt::format("movie \"{}\": expected {} to {} pictures a second, found {}",
                                                file.string(), kLeastRate, kMostRate, rate));
  }
}

// The last two lines: what went wrong, and where that led.
std::string lastWords(std::string text) {
  const auto trim = [&] { text.erase(text.find_last_not_of(" \r\n") + 1); };
  trim();
  const std::size_t last = text.rfind('\n');
  if (last == std::string::npos) return text;
  const std::size_t before = last == 0 ? std::string::npos : text.rfind('\n', last - 1);
  if (before != std::string::npos) text.erase(0, before + 1);
  return text.replace(text.find('\n'), 1, "; ");
}

ivec2 evenSize(ivec2 size) { return size + size % 2; }

void padToEven(const Image<u8vec3>& picture, std::vector<u8vec3>& padded) {
  padded.clear();
  const int odd_column = picture.width % 2, odd_row = picture.height % 2;
  for (int y = 0; y < picture.height + odd_row; ++y) {
    const u8vec3* row = &picture.pixels[picture.index(0, std::min(y, picture.height - 1))];
    padded.insert(padded.end(), row, row + picture.width);
    if (odd_column) padded.push_back(row[picture.width - 1]);
  }
}

}  // namespace

bool canWriteMovies() { return installedProgram("ffmpeg").has_value(); }

struct MovieWriter::State {
  State(const std::filesystem::path& path, ivec2 pixels, double rate, const FileNotes& said)
      : file(path),
        size(pixels),
        notes(said),
        output(path),
        ffmpeg(ffmpegWords(output.name(), evenSize(size), rate, said)) {}

  // Waits for ffmpeg's end.
  [[noreturn]] void refuse(const Progress* progress) {
    const int code = ffmpeg.finish(progress);
    std::string said = lastWords(ffmpeg.errorText());
    std::replace(said.begin(), said.end(), '\0', '?');
    if (said.empty()) said = code > 128 ? ::strsignal(code - 128) : "without a movie, and without a word";
    throw Error(
        Error::Kind::Storage,
        fmt::format("cannot write the movie \"{}\": ffmpeg ended with {}: {}; expected an ffmpeg that "
                    "encodes with libx264, and room on the disk",
                    file.string(), code, said));
  }

  std::filesystem::path file;
  ivec2 size;
  FileNotes notes;
  UnpublishedFile output;
  ChildProcess ffmpeg;
  std::vector<u8vec3> padded;
  bool has_picture = false;
};

MovieWriter::MovieWriter(const std::filesystem::path& file, ivec2 size, double rate, const FileNotes& notes) {
  requireMovie(file, size, rate);
  installedFfmpeg();  // before anything is made
  state_ = std::make_unique<State>(file, size, rate, notes);
}

MovieWriter::~MovieWriter() {
  // Asked to end it would still encode what it has, for longer than a stop may take.
  if (state_) state_->ffmpeg.stop(std::chrono::milliseconds(0));
}

void MovieWriter::add(const Image<u8vec3>& picture, const Progress* progress) {
  if (!state_) throw Error(Error::Kind::Bug, "a finished movie takes no more pictures");
  State& s = *state_;
  if (picture.width != s.size.x || picture.height != s.size.y) {
    throw Error(Error::Kind::Bug,
                fmt::format("movie \"{}\": expected pictures of {} x {}, found {} x {}", s.file.string(),
                            s.size.x, s.size.y, picture.width, picture.height));
  }
  std::span<const u8vec3> pixels = picture.pixels;
  if (evenSize(s.size) != s.size) {
    padToEven(picture, s.padded);
    pixels = s.padded;
  }
  if (!s.ffmpeg.write(std::as_bytes(pixels), progress)) s.refuse(progress);
  s.has_picture = true;
}

void MovieWriter::finish(const Progress* progress) {
  if (!state_ || !state_->has_picture)
    throw Error(Error::Kind::Bug, "a movie is finished once, with a picture");
  State& s = *state_;
  if (s.ffmpeg.finish(progress) != 0) s.refuse(progress);
  // A program of that name may be something else.
  if (std::filesystem::file_size(s.output.name()) == 0 || notesOfMovie(s.output.name()) != s.notes)
    s.refuse(progress);
  s.output.publish();
  state_.reset();
}

}  // namespace beam
