// SPDX-License-Identifier: Apache-2.0
// A movie has the colours, the number and the rate of its pictures, is whole or not there, and says whose it
// is.
#include "core/io/movie_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stop_token>

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/io/file.h"
#include "tests/support/message_of.h"
#include "tests/support/search_path.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Picture = Image<u8vec3>;

const FileNotes kNotes = {{"Software", "BEAM Studio, beam render"}, {"source", "0123 = 'a' \"b\" \\ %d"}};

constexpr std::array<u8vec3, 8> kColors = {u8vec3(255, 0, 0),   u8vec3(0, 255, 0),   u8vec3(0, 0, 255),
                                           u8vec3(255),         u8vec3(0),           u8vec3(128),
                                           u8vec3(200, 60, 30), u8vec3(20, 180, 220)};

// Four columns and two rows of colours.
Picture patches(int width, int height) {
  Picture p(width, height, {}, Encoding::Srgb);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) p(x, y) = kColors[4 * x / width + 4 * (2 * y / height)];
  return p;
}

Picture ramp(int width, int height, int shift = 0) {
  Picture p(width, height, {}, Encoding::Srgb);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) p(x, y) = u8vec3(std::min(255, x + shift));
  return p;
}

Picture noise(int width, int height, std::uint32_t seed) {
  Picture p(width, height, {}, Encoding::Srgb);
  for (u8vec3& c : p.pixels) c = u8vec3((seed = seed * 1664525u + 1013904223u) >> 24);
  return p;
}

void writeMovie(const fs::path& file, const std::vector<Picture>& pictures, double rate = 30) {
  MovieWriter movie(file, ivec2(pictures[0].width, pictures[0].height), rate, kNotes);
  for (const Picture& p : pictures) movie.add(p);
  movie.finish();
}

std::string outputOf(const std::vector<std::string>& words) {
  ChildProcess child(words, ChildProcess::Output::Kept);
  child.closeInput();
  std::string all;
  std::array<std::byte, 65536> some;
  while (const std::size_t n = child.read(some)) all.append(reinterpret_cast<const char*>(some.data()), n);
  EXPECT_EQ(child.finish(), 0) << child.errorText();
  EXPECT_EQ(child.errorText(), "");
  return all;
}

// All pictures as ffmpeg shows them; `matrix`: as if the file said so, "auto": as it says.
std::vector<Picture> decoded(const fs::path& file, ivec2 size, const std::string& matrix = "auto") {
  const std::string bytes =
      outputOf({"ffmpeg", "-nostdin", "-v", "error", "-i", "file:" + file.string(), "-vf",
                "scale=in_color_matrix=" + matrix + ":flags=bicubic+accurate_rnd+full_chroma_int", "-pix_fmt",
                "rgb24", "-f", "rawvideo", "pipe:1"});
  const std::size_t one = std::size_t{3} * size.x * size.y;
  EXPECT_EQ(bytes.size() % one, 0u);
  std::vector<Picture> pictures(bytes.size() / one, Picture(size.x, size.y));
  for (std::size_t i = 0; i < pictures.size(); ++i)
    std::memcpy(static_cast<void*>(pictures[i].pixels.data()), bytes.data() + i * one, one);
  return pictures;
}

int difference(u8vec3 a, u8vec3 b) {
  const ivec3 d = glm::abs(ivec3(a) - ivec3(b));
  return std::max({d.x, d.y, d.z});
}

// At the middles of the patches.
int patchDifference(const Picture& a, const Picture& b) {
  int most = 0;
  for (int k = 0; k < 8; ++k) {
    const int x = (2 * (k % 4) + 1) * a.width / 8, y = (2 * (k / 4) + 1) * a.height / 4;
    most = std::max(most, difference(a(x, y), b(x, y)));
  }
  return most;
}

// A line "key=value" for each thing that there is to say of it.
std::string probed(const fs::path& file) {
  return outputOf({"ffprobe", "-v", "error", "-count_frames", "-select_streams", "v:0", "-show_streams",
                   "file:" + file.string()});
}

std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& e : entriesOf(folder)) names.push_back(e.path().filename().string());
  return names;
}

// An ffmpeg that does what the script says.
void writeFfmpeg(const TempDir& dir, const std::string& script) {
  std::ofstream(dir / "ffmpeg") << "#!/bin/sh\n" << script << "\n";
  fs::permissions(dir / "ffmpeg", fs::perms::owner_all);
}

class Movie : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!canWriteMovies())
      GTEST_SKIP() << "NOT TESTED: movies need the program ffmpeg; install the package ffmpeg to run this";
  }
  TempDir dir;
};

class ProbedMovie : public Movie {
 protected:
  void SetUp() override {
    Movie::SetUp();
    if (!installedProgram("ffprobe"))
      GTEST_SKIP() << "NOT TESTED: the program ffprobe (package ffmpeg) is missing";
  }
};

TEST_F(Movie, HasTheColoursOfItsPicturesByTheMatrixThatItNames) {
  const Picture p = patches(96, 64);
  writeMovie(dir / "m.mp4", {p, p, p});
  for (const char* matrix : {"auto", "bt709"}) {
    const std::vector<Picture> shown = decoded(dir / "m.mp4", ivec2(96, 64), matrix);
    ASSERT_EQ(shown.size(), 3u);
    for (const Picture& s : shown) EXPECT_LE(patchDifference(p, s), 3) << matrix;
  }
  // That this tells the matrices apart.
  EXPECT_GT(patchDifference(p, decoded(dir / "m.mp4", ivec2(96, 64), "bt601")[0]), 10);
}

TEST_F(Movie, KeepsARampFromBlackToWhite) {
  const Picture p = ramp(256, 32);
  writeMovie(dir / "m.mp4", {p});
  const std::vector<Picture> shown = decoded(dir / "m.mp4", ivec2(256, 32));
  ASSERT_EQ(shown.size(), 1u);
  for (int x = 0; x < 256; ++x) EXPECT_LE(difference(shown[0](x, 16), p(x, 16)), 4) << x;
}

TEST_F(Movie, HasItsPicturesInOrder) {
  std::vector<Picture> pictures;
  for (int i = 0; i < 60; ++i) pictures.emplace_back(64, 48, u8vec3(4 * i), Encoding::Srgb);
  writeMovie(dir / "m.mp4", pictures);
  const std::vector<Picture> shown = decoded(dir / "m.mp4", ivec2(64, 48));
  ASSERT_EQ(shown.size(), pictures.size());
  for (std::size_t i = 0; i < shown.size(); ++i)
    EXPECT_LE(difference(shown[i](30, 20), u8vec3(4 * i)), 3) << i;
}

TEST_F(Movie, OfAnOddSizeRepeatsItsLastColumnAndRow) {
  for (const ivec2& size : {ivec2(95, 63), ivec2(96, 63), ivec2(95, 64), ivec2(1, 1), ivec2(3, 2)}) {
    const Picture p = patches(size.x, size.y);
    writeMovie(dir / "m.mp4", {p, p});
    const ivec2 even = size + size % 2;
    const std::vector<Picture> shown = decoded(dir / "m.mp4", even);
    ASSERT_EQ(shown.size(), 2u) << size.x << " x " << size.y;
    if (size.x < 8) continue;
    EXPECT_LE(patchDifference(p, shown[0]), 3);
    EXPECT_LE(difference(shown[0](even.x - 1, even.y - 1), p(size.x - 1, size.y - 1)), 6);
    EXPECT_LE(difference(shown[0](even.x - 1, 4), p(size.x - 1, 4)), 6);
  }
}

TEST_F(Movie, TheSamePicturesGiveTheSameBytes) {
  std::vector<Picture> pictures;
  for (std::uint32_t i = 0; i < 30; ++i)
    pictures.push_back(i % 7 == 0 ? noise(160, 96, i) : ramp(160, 96, 3 * i));
  writeMovie(dir / "a.mp4", pictures);
  writeMovie(dir / "b.mp4", pictures);
  EXPECT_EQ(readTextFile(dir / "a.mp4"), readTextFile(dir / "b.mp4"));
}

TEST_F(ProbedMovie, SaysWhatItIs) {
  writeMovie(dir / "m.mp4", {patches(95, 64), patches(95, 64)});
  const std::string said = probed(dir / "m.mp4");
  for (const char* line :
       {"codec_name=h264", "width=96", "height=64", "pix_fmt=yuv420p", "color_range=tv", "color_space=bt709",
        "color_transfer=bt709", "color_primaries=bt709", "chroma_location=left", "nb_read_frames=2"})
    EXPECT_THAT(said, HasSubstr(line + std::string("\n")));
}

TEST_F(ProbedMovie, HasExactlyItsRate) {
  const std::vector<std::pair<double, std::string>> rates = {
      {30, "30/1"}, {23.976, "24000/1001"}, {30000 / 1001.0, "30000/1001"}, {12.5, "25/2"}};
  for (const auto& [rate, text] : rates) {
    writeMovie(dir / "m.mp4", std::vector<Picture>(5, ramp(32, 32)), rate);
    EXPECT_THAT(probed(dir / "m.mp4"),
                AllOf(HasSubstr("r_frame_rate=" + text + "\navg_frame_rate=" + text + "\n"),
                      HasSubstr("nb_read_frames=5\n")))
        << rate;
  }
}

TEST_F(Movie, BeginsWithWhatAPlayerNeedsFirst) {
  writeMovie(dir / "m.mp4", {noise(64, 64, 1)});
  const std::string bytes = readTextFile(dir / "m.mp4");
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

TEST_F(Movie, SaysWhoseItIs) {
  writeMovie(dir / "m.mp4", std::vector<Picture>(3, ramp(32, 32)));
  EXPECT_EQ(notesOfMovie(dir / "m.mp4"), kNotes);
  EXPECT_TRUE(isWrittenBy(dir / "m.mp4", "render"));
  EXPECT_FALSE(isWrittenBy(dir / "m.mp4", "export"));
  MovieWriter plain(dir / "plain.mp4", ivec2(32, 32), 30);
  plain.add(ramp(32, 32));
  plain.finish();
  EXPECT_THAT(notesOfMovie(dir / "plain.mp4"), IsEmpty());
  EXPECT_FALSE(isWrittenBy(dir / "plain.mp4", "render"));
}

TEST_F(Movie, ThatIsDamagedSaysNothingAndHarmsNobody) {
  writeMovie(dir / "m.mp4", {ramp(32, 32)});
  const std::string whole = readTextFile(dir / "m.mp4");
  const std::size_t comment = whole.find("Software");
  for (std::size_t kept = 0; kept < comment; kept += 7) {
    std::ofstream(dir / "cut.mp4", std::ios::binary) << whole.substr(0, kept);
    ASSERT_THAT(notesOfMovie(dir / "cut.mp4"), IsEmpty()) << kept;
  }
  for (std::size_t i = 0; i < comment; i += 3) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ 0xff);
    std::ofstream(dir / "cut.mp4", std::ios::binary) << bytes;
    EXPECT_LE(notesOfMovie(dir / "cut.mp4").size(), 64u) << i;
  }
  EXPECT_THAT(notesOfMovie(dir / "none.mp4"), IsEmpty());
  EXPECT_THAT(notesOfMovie(dir.path()), IsEmpty());
}

TEST_F(Movie, IsNotThereBeforeItIsWholeAndLeavesNothingElse) {
  std::ofstream(dir / "m.mp4") << "old";
  {
    MovieWriter movie(dir / "m.mp4", ivec2(64, 64), 30);
    for (std::uint32_t i = 0; i < 100; ++i) movie.add(noise(64, 64, i));
    EXPECT_EQ(readTextFile(dir / "m.mp4"), "old");
    EXPECT_EQ(namesIn(dir.path()).size(), 2u);
  }
  EXPECT_THAT(namesIn(dir.path()), ElementsAre("m.mp4"));
  EXPECT_EQ(readTextFile(dir / "m.mp4"), "old");
  writeMovie(dir / "m.mp4", {noise(64, 64, 1)});
  EXPECT_THAT(namesIn(dir.path()), ElementsAre("m.mp4"));
  EXPECT_EQ(decoded(dir / "m.mp4", ivec2(64, 64)).size(), 1u);
}

TEST_F(Movie, TakesAnyName) {
  const fs::path before = fs::current_path();
  fs::current_path(dir.path());
  for (const char* name : {"-y.mp4", "%03d.mp4", "http:x [a];b=1,c", "a 'b' \"c\" \\.mp4"}) {
    writeMovie(name, {ramp(32, 32)});
    EXPECT_THAT(namesIn("."), ElementsAre(name));
    EXPECT_EQ(decoded(name, ivec2(32, 32)).size(), 1u) << name;
    fs::remove(name);
  }
  fs::current_path(before);
}

TEST_F(Movie, StopsWhileItIsWrittenAndLeavesNothing) {
  std::stop_source stop;
  const Progress progress(stop.get_token());
  {
    MovieWriter movie(dir / "m.mp4", ivec2(640, 480), 30);
    for (std::uint32_t i = 0; i < 20; ++i) movie.add(noise(640, 480, i), &progress);
    stop.request_stop();
    EXPECT_THROW(movie.add(noise(640, 480, 1), &progress), Cancelled);
    EXPECT_THROW(movie.finish(&progress), Cancelled);
  }
  EXPECT_THAT(namesIn(dir.path()), IsEmpty());
}

TEST_F(Movie, OnADiskThatTakesNoMoreIsAStorageErrorAndLeavesNothing) {
  struct rlimit before {};
  ::getrlimit(RLIMIT_FSIZE, &before);
  struct rlimit little = before;
  little.rlim_cur = 300'000;
  ::setrlimit(RLIMIT_FSIZE, &little);
  const std::string said = messageOf(Error::Kind::Storage, [&] {
    MovieWriter movie(dir / "m.mp4", ivec2(256, 256), 30);
    for (std::uint32_t i = 0; i < 60; ++i) movie.add(noise(256, 256, i));
    movie.finish();
  });
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_THAT(said, AllOf(HasSubstr("m.mp4"), HasSubstr("File size limit")));
  EXPECT_THAT(namesIn(dir.path()), IsEmpty());
}

TEST_F(Movie, WhereNothingCanBeWrittenIsAStorageError) {
  const auto open = [](const fs::path& file) { MovieWriter(file, ivec2(32, 32), 30); };
  EXPECT_THAT(messageOf(Error::Kind::Storage, [&] { open(dir / "none/m.mp4"); }), HasSubstr("none/m.mp4"));
  std::ofstream(dir / "file") << "x";
  messageOf(Error::Kind::Storage, [&] { open(dir / "file/m.mp4"); });
  fs::create_directory(dir / "folder");
  {
    MovieWriter movie(dir / "folder", ivec2(32, 32), 30);
    movie.add(ramp(32, 32));
    messageOf(Error::Kind::Storage, [&] { movie.finish(); });
  }
  EXPECT_THAT(namesIn(dir.path()), ElementsAre("file", "folder"));
}

TEST_F(Movie, InAFolderThatIsReadOnlyIsAStorageError) {
  if (::geteuid() == 0) GTEST_SKIP() << "NOT TESTED: nothing is read-only for root";
  fs::permissions(dir.path(), fs::perms::owner_read | fs::perms::owner_exec);
  messageOf(Error::Kind::Storage, [&] { MovieWriter(dir / "m.mp4", ivec2(32, 32), 30); });
  fs::permissions(dir.path(), fs::perms::owner_all);
}

TEST_F(Movie, OfASizeOrRateThatThereIsNotIsRefused) {
  const auto open = [&](ivec2 size, double rate) { MovieWriter(dir / "m.mp4", size, rate); };
  for (const ivec2& size : {ivec2(0, 8), ivec2(8, -1), ivec2(16385, 8)})
    messageOf(Error::Kind::Usage, [&] { open(size, 30); });
  for (const double rate : {0.0, -1.0, 1001.0, std::nan("")})
    messageOf(Error::Kind::Usage, [&] { open(ivec2(8), rate); });
  MovieWriter movie(dir / "m.mp4", ivec2(8), 30);
  messageOf(Error::Kind::Bug, [&] { movie.add(ramp(8, 9)); });
  messageOf(Error::Kind::Bug, [&] { movie.finish(); });
  movie.add(ramp(8, 8));
  movie.finish();
  messageOf(Error::Kind::Bug, [&] { movie.add(ramp(8, 8)); });
  messageOf(Error::Kind::Bug, [&] { movie.finish(); });
}

TEST(MovieWithoutFfmpeg, NamesWhatIsMissingAndWhatToDo) {
  const TempDir dir;
  const SearchPath nowhere("");
  EXPECT_FALSE(canWriteMovies());
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { MovieWriter(dir / "m.mp4", ivec2(32, 32), 30); }),
              AllOf(HasSubstr("ffmpeg"), HasSubstr("install the package"), HasSubstr("leave the movie out")));
  EXPECT_THAT(namesIn(dir.path()), IsEmpty());
}

TEST(MovieWithoutFfmpeg, AnFfmpegThatCannotHasTheLastWord) {
  const TempDir dir, programs;
  writeFfmpeg(programs, "echo first >&2; echo \"Unknown encoder 'libx264'\" >&2; echo told >&2; exit 8");
  const SearchPath path(programs.path().string());
  EXPECT_THAT(messageOf(Error::Kind::Storage,
                        [&] {
                          MovieWriter movie(dir / "m.mp4", ivec2(640, 480), 30);
                          for (int i = 0; i < 5; ++i) movie.add(ramp(640, 480));
                          movie.finish();
                        }),
              AllOf(HasSubstr("m.mp4"), HasSubstr("8: Unknown encoder 'libx264'; told;")));
  EXPECT_THAT(namesIn(dir.path()), IsEmpty());
}

TEST(MovieWithoutFfmpeg, OneThatFailsAtTheEndPublishesNothing) {
  const TempDir dir, programs;
  writeFfmpeg(programs, "/bin/cat >/dev/null; echo 'No space left on device' >&2; exit 1");
  const SearchPath path(programs.path().string());
  MovieWriter movie(dir / "m.mp4", ivec2(64, 48), 30);
  movie.add(ramp(64, 48));
  EXPECT_THAT(messageOf(Error::Kind::Storage, [&] { movie.finish(); }),
              HasSubstr("1: No space left on device;"));
  EXPECT_FALSE(fs::exists(dir / "m.mp4"));
}

// It takes all pictures and ends well, and what it leaves is no movie.
TEST(MovieWithoutFfmpeg, OneThatIsSomethingElseIsFoundOut) {
  for (const char* does : {"/bin/cat >/dev/null", "for last; do :; done; /bin/cat > \"${last#file:}\""}) {
    const TempDir dir, programs;
    writeFfmpeg(programs, does);
    const SearchPath path(programs.path().string());
    MovieWriter movie(dir / "m.mp4", ivec2(64, 48), 30, {{"Software", "BEAM Studio, beam render"}});
    movie.add(ramp(64, 48));
    EXPECT_THAT(messageOf(Error::Kind::Storage, [&] { movie.finish(); }), HasSubstr("without a movie"));
    EXPECT_FALSE(fs::exists(dir / "m.mp4"));
  }
}

}  // namespace
}  // namespace beam::testing
