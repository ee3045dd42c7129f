// SPDX-License-Identifier: Apache-2.0
// Files: what is written is read back; what is damaged is refused by name, before memory is taken.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <new>

#include "core/base/error.h"
#include "core/base/rng.h"
#include "core/io/file.h"
#include "core/io/image_file.h"
#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "tests/support/few_descriptors.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::dataErrorOf;
using ::testing::HasSubstr;
using testing::TempDir;

void put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}
std::string bytesOf(const std::filesystem::path& path) { return readTextFile(path); }

Image<u8vec3> picture(int w, int h) {
  Image<u8vec3> p(w, h);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) p(x, y) = u8vec3(x * 7, y * 5, x + y);
  }
  return p;
}

TEST(PngFile, ComesBackAsItWasWritten) {
  const TempDir dir;
  writePng(dir / "a.png", picture(17, 9));
  EXPECT_EQ(readPhoto(dir / "a.png").pixels, picture(17, 9).pixels);
  EXPECT_EQ(readImageSize(dir / "a.png").width, 17);
  Image<std::uint8_t> mask(5, 4, 200);
  writePng(dir / "m.png", mask);
  EXPECT_EQ(readMask(dir / "m.png").pixels, mask.pixels);
}

TEST(PngFile, ATruncatedOneIsAnErrorAndNotHalfAPicture) {
  const TempDir dir;
  writePng(dir / "a.png", picture(60, 60));
  const std::string whole = bytesOf(dir / "a.png");
  put(dir / "cut.png", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(dataErrorOf([&] { readPhoto(dir / "cut.png"); }), HasSubstr("truncated"));
}

TEST(PngFile, AHeaderOfAMillionPixelsASideIsRefused) {
  const TempDir dir;
  writePng(dir / "a.png", picture(6, 6));
  std::string bytes = bytesOf(dir / "a.png");
  for (const int at : {16, 20}) bytes.replace(at, 4, std::string("\x00\x0f\x42\x40", 4));
  put(dir / "huge.png", bytes);
  EXPECT_THAT(dataErrorOf([&] { readPhoto(dir / "huge.png"); }), HasSubstr("1000000"));
}

TEST(PngFile, SomethingElseIsNamed) {
  const TempDir dir;
  put(dir / "a.png", "hello, this is no picture at all, just text");
  EXPECT_THAT(dataErrorOf([&] { readPhoto(dir / "a.png"); }), HasSubstr("a.png"));
}

TEST(ExrFile, FloatsComeBackExactlyAndHalvesNearly) {
  const TempDir dir;
  Planes p(7, 5, 3);
  for (std::size_t i = 0; i < p.values.size(); ++i) p.values[i] = 0.013f * static_cast<float>(i);
  writeExr(dir / "f.exr", p, {"R", "G", "B"}, ExrPrecision::Float);
  EXPECT_EQ(readExr(dir / "f.exr", {"R", "G", "B"}).values, p.values);
  writeExr(dir / "h.exr", p, {"R", "G", "B"}, ExrPrecision::Half);
  const Planes h = readExr(dir / "h.exr", {"R", "G", "B"});
  for (std::size_t i = 0; i < p.values.size(); ++i) EXPECT_NEAR(h.values[i], p.values[i], 1e-3f);
  EXPECT_THAT(dataErrorOf([&] { readExr(dir / "f.exr", {"Y"}); }), HasSubstr("Y"));
}

TEST(ExrFile, AnEmptyOrDamagedOneIsRefused) {
  const TempDir dir;
  put(dir / "e.exr", "");
  EXPECT_THAT(dataErrorOf([&] { readRadiance(dir / "e.exr"); }), HasSubstr("empty"));
  Planes p(64, 64, 1, 0.5f);
  writeExr(dir / "y.exr", p, {"Y"}, ExrPrecision::Float);
  put(dir / "cut.exr", bytesOf(dir / "y.exr").substr(0, 300));
  dataErrorOf([&] { readExr(dir / "cut.exr", {"Y"}); });
}

TEST(HdrFile, FlatAndOldRunLengthScanlinesAreRead) {
  const TempDir dir;
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 1 +X 3\n";
  // One pixel (128, 64, 0) * 2^(129 - 136) and a run of two more.
  put(dir / "a.hdr", header + std::string("\x80\x40\x00\x81\x01\x01\x01\x02", 8));
  const Image<vec3> im = readRadiance(dir / "a.hdr");
  ASSERT_EQ(im.width, 3);
  for (int x = 0; x < 3; ++x) {
    EXPECT_NEAR(im(x, 0).x, 0.5, 1e-6);
    EXPECT_NEAR(im(x, 0).y, 0.25, 1e-6);
  }
}

TEST(HdrFile, NewRunsAreReadAndATruncatedFileIsRefused) {
  const TempDir dir;
  std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
  bytes += std::string("\x02\x02\x00\x08", 4);
  for (int c = 0; c < 4; ++c) bytes += std::string("\x88", 1) + static_cast<char>(c == 3 ? 128 : 64);
  put(dir / "a.hdr", bytes);
  EXPECT_NEAR(readRadiance(dir / "a.hdr")(7, 0).z, 64.0 / 256, 1e-6);
  put(dir / "b.hdr", bytes.substr(0, bytes.size() - 3));
  EXPECT_THAT(dataErrorOf([&] { readRadiance(dir / "b.hdr"); }), HasSubstr("truncated"));
}

TEST(MeshPly, MeshesAndPointsComeBack) {
  const TempDir dir;
  Mesh m;
  m.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  m.triangles = {{0, 1, 2}};
  writeMeshPly(dir / "m.ply", m);
  EXPECT_EQ(readMeshPly(dir / "m.ply").triangles, m.triangles);
  EXPECT_EQ(readMeshPly(dir / "m.ply").vertices, m.vertices);
  PointCloud p{{{1, 2, 3}}, {u8vec3(9, 8, 7)}};
  writePointsPly(dir / "p.ply", p);
  EXPECT_EQ(readPointsPly(dir / "p.ply").color, p.color);
}

TEST(MeshPly, NormalsAndTexturePositionsComeBackWhereThereAreSome) {
  const TempDir dir;
  Mesh m;
  m.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  m.triangles = {{0, 1, 2}};
  writeMeshPly(dir / "bare.ply", m);
  EXPECT_EQ(bytesOf(dir / "bare.ply").find("nx"), std::string::npos);
  EXPECT_TRUE(readMeshPly(dir / "bare.ply").normals.empty());
  m.normals.assign(3, vec3(0, 0, 1));
  m.uv = {{0, 0}, {1, 0.25f}, {0.5f, 1}};
  writeMeshPly(dir / "full.ply", m);
  const Mesh back = readMeshPly(dir / "full.ply");
  EXPECT_EQ(back.vertices, m.vertices);
  EXPECT_EQ(back.normals, m.normals);
  EXPECT_EQ(back.uv, m.uv);
}

TEST(MeshPly, AsciiPolygonsAreFannedAndAbsurdCountsRefused) {
  const TempDir dir;
  put(dir / "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  EXPECT_EQ(readMeshPly(dir / "a.ply").triangles.size(), 2u);
  put(dir / "b.ply",
      "ply\nformat binary_little_endian 1.0\nelement vertex 60000000\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n");
  EXPECT_THAT(dataErrorOf([&] { readMeshPly(dir / "b.ply"); }), HasSubstr("60000000"));
}

Mesh meshOfRows(std::uint32_t rows) {
  Mesh m;
  for (std::uint32_t i = 0; i < rows; ++i) {
    m.vertices.push_back({static_cast<float>(i), 1, 2});
    m.triangles.push_back({i, (i + 1) % rows, (i + 2) % rows});
  }
  return m;
}

TEST(MeshPly, ComesBackInWholeFromManyPieces) {
  const TempDir dir;
  const Mesh m = meshOfRows(1000003);
  writeMeshPly(dir / "m.ply", m);
  const Mesh back = readMeshPly(dir / "m.ply");
  EXPECT_TRUE(back.vertices == m.vertices);
  EXPECT_TRUE(back.triangles == m.triangles);
}

TEST(MeshPly, IsWrittenAndReadUpToTheSameLimitWhichIsCalledALimit) {
  const TempDir dir;
  const Mesh m = meshOfRows(5);
  const auto called = [](const std::string& element) {
    return AllOf(HasSubstr("limit of 4 "), HasSubstr("5 rows of \"" + element + "\""));
  };
  writeMeshPly(dir / "m.ply", m, {.most_rows = 5});
  EXPECT_EQ(readMeshPly(dir / "m.ply", 5).triangles, m.triangles);
  EXPECT_THAT(dataErrorOf([&] { readMeshPly(dir / "m.ply", 4); }), called("vertex"));
  EXPECT_THAT(dataErrorOf([&] { writeMeshPly(dir / "n.ply", m, {.most_rows = 4}); }), called("vertex"));
  EXPECT_FALSE(std::filesystem::exists(dir / "n.ply"));
  Mesh more_faces = meshOfRows(4);
  more_faces.triangles.push_back({0, 1, 2});
  writeMeshPly(dir / "f.ply", more_faces);
  EXPECT_THAT(dataErrorOf([&] { readMeshPly(dir / "f.ply", 4); }), called("face"));
  EXPECT_THAT(dataErrorOf([&] { writeMeshPly(dir / "n.ply", more_faces, {.most_rows = 4}); }),
              called("face"));
}

TEST(MeshPly, StopsWhileItIsWrittenAndLeavesNothing) {
  const TempDir dir;
  std::stop_source stop;
  stop.request_stop();
  const Progress progress(stop.get_token());
  EXPECT_THROW(writeMeshPly(dir / "m.ply", meshOfRows(5), {.progress = &progress}), Cancelled);
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
}

struct Splats {
  GaussianCloud cloud;
  Materials materials;
};
Splats someSplats(std::size_t n) {
  Splats s;
  s.cloud.color = ShBlock(n, 3);
  s.materials.base_color = ShBlock(n, 3);
  s.materials.ambient_occlusion = ShBlock(n, 1);
  for (std::size_t i = 0; i < n; ++i) {
    const RandomStream r(4, i);
    s.cloud.position_m.emplace_back(r.normal(0), r.normal(1), r.normal(2));
    s.cloud.rotation.push_back(glm::normalize(quat(r.normal(3), r.normal(4), r.normal(5), r.normal(6))));
    s.cloud.scale_m.emplace_back(0.01f + r.uniform(7), 0.01f + r.uniform(8), 0.01f + r.uniform(9));
    s.cloud.opacity.push_back(0.05f + 0.9f * r.uniform(10));
    s.materials.roughness.push_back(0.1f + 0.8f * r.uniform(11));
    for (int k = 0; k < 48; ++k)
      s.cloud.color.of(i)[k] = r.normal(20 + k), s.materials.base_color.of(i)[k] = r.normal(80 + k);
    for (int k = 0; k < 16; ++k) s.materials.ambient_occlusion.of(i)[k] = r.normal(140 + k);
  }
  return s;
}

TEST(SplatPly, ComesBackAndASecondWriteGivesTheSameBytes) {
  const TempDir dir;
  const Splats s = someSplats(20);
  writeSplatPly(dir / "a.ply", s.cloud, &s.materials);
  const SplatFile f = readSplatPly(dir / "a.ply");
  ASSERT_TRUE(f.materials);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(f.cloud.position_m[i], s.cloud.position_m[i]);
    EXPECT_NEAR(f.cloud.opacity[i], s.cloud.opacity[i], 1e-6f);
    EXPECT_NEAR(f.cloud.scale_m[i].y / s.cloud.scale_m[i].y, 1, 1e-5f);
  }
  EXPECT_EQ(f.cloud.color.coefficients, s.cloud.color.coefficients);
  EXPECT_EQ(f.materials->ambient_occlusion.coefficients, s.materials.ambient_occlusion.coefficients);
  writeSplatPly(dir / "b.ply", s.cloud, &s.materials);
  EXPECT_EQ(bytesOf(dir / "a.ply"), bytesOf(dir / "b.ply"));
}

TEST(SplatPly, HoldsTheStandardColumnsFirstInTheirOrder) {
  const TempDir dir;
  writeSplatPly(dir / "a.ply", someSplats(1).cloud, nullptr);
  const std::string text = bytesOf(dir / "a.ply");
  std::size_t last = 0, count = 0;
  for (std::size_t at = text.find("property float"); at != std::string::npos;
       at = text.find("property float", at + 1))
    ++count;
  EXPECT_EQ(count, 62u);
  for (const char* name : {" x\n", " nx\n", " f_dc_0\n", " f_rest_0\n", " f_rest_44\n", " opacity\n",
                           " scale_0\n", " rot_3\n"}) {
    const std::size_t at = text.find(name);
    EXPECT_NE(at, std::string::npos) << name;
    EXPECT_GT(at, last) << name;
    last = at;
  }
}

TEST(Files, AnAtomicWriteReplacesAndLeavesNothingElse) {
  const TempDir dir;
  writeFileAtomically(dir / "a", std::string_view("one"));
  writeFileAtomically(dir / "a", std::string_view("two"));
  EXPECT_EQ(bytesOf(dir / "a"), "two");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
  EXPECT_THROW(writeFileAtomically(dir / "none/a", std::string_view("x")), Error);
}

TEST(Files, PiecesAreOneFileOrNone) {
  const TempDir dir;
  int asked = 0;
  writeFileAtomically(dir / "a", [&]() -> std::string_view { return ++asked > 3 ? "" : "ab"; });
  EXPECT_EQ(bytesOf(dir / "a"), "ababab");
  const auto fails = [&]() -> std::string_view {
    if (++asked > 5) throw Cancelled();
    return "cd";
  };
  EXPECT_THROW(writeFileAtomically(dir / "a", fails), Cancelled);
  EXPECT_EQ(bytesOf(dir / "a"), "ababab");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
}

TEST(Files, ThatCannotBeOpenedForAMomentAreAFaultOfTheDiskAndNotOfTheFile) {
  const TempDir dir;
  writeFileAtomically(dir / "a.txt", "here");
  {
    const testing::FewDescriptors few;
    testing::messageOf(Error::Kind::Storage, [&] { readTextFile(dir / "a.txt"); });
  }
  EXPECT_EQ(readTextFile(dir / "a.txt"), "here");
  dataErrorOf([&] { readTextFile(dir / "b.txt"); });
  dataErrorOf([&] { readTextFile(dir / "a.txt" / "b.txt"); });
}

TEST(Files, AreWrittenWhereAKilledProcessOfTheSameNumberLeftItsTemporaryOnes) {
  const TempDir dir;
  for (int i = 0; i < 3000; ++i)
    std::ofstream(dir / fmt::format(".a.txt.{}.{}.tmp", ::getpid(), i)) << "left";
  writeFileAtomically(dir / "a.txt", "new");
  EXPECT_EQ(readTextFile(dir / "a.txt"), "new");
}

enum class End { Done, NoMemory, Refused };

// In a process of its own that can take `room` bytes more.
template <class Work>
End inLittle(rlim_t room, Work&& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::ifstream statm("/proc/self/statm");
    rlim_t pages = 0;
    statm >> pages;
    const rlim_t now = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
    struct rlimit little {
      now, RLIM_INFINITY
    };
    ::setrlimit(RLIMIT_AS, &little);
    // What earlier tests gave back is not to be had.
    for (const std::size_t bytes : {std::size_t{1} << 16, std::size_t{1} << 12}) {
      void* volatile taken = nullptr;  // the compiler would take an unused one out
      do taken = std::malloc(bytes);
      while (taken);
    }
    little.rlim_cur = now + room;
    ::setrlimit(RLIMIT_AS, &little);
    try {
      work();
    } catch (const std::bad_alloc&) {
      ::_exit(static_cast<int>(End::NoMemory));
    } catch (const Error&) {
      ::_exit(static_cast<int>(End::Refused));
    }
    ::_exit(static_cast<int>(End::Done));
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  return static_cast<End>(WEXITSTATUS(status));
}

constexpr rlim_t kMega = 1u << 20;

TEST(PngFile, ThatThereIsNoMemoryForIsNotCalledDamaged) {
  const TempDir dir;
  writePng(dir / "large.png", Image<u8vec3>(6000, 6000, u8vec3(7), Encoding::Srgb));
  EXPECT_EQ(inLittle(20 * kMega, [&] { readPhoto(dir / "large.png"); }), End::NoMemory);
}

// The library swallows what fails in its destructors, and words the rest in its own ways.
TEST(ExrFile, IsWholeOrNotThereWhereMemoryIsShort) {
  const TempDir dir;
  Planes noise(300, 300, 3);
  for (std::size_t i = 0; i < noise.values.size(); ++i)
    noise.values[i] = static_cast<float>((i * 2654435761u) % 1000003u) * 1e-3f;
  writeExr(dir / "whole.exr", noise, {"R", "G", "B"}, ExrPrecision::Float);
  const std::vector<std::byte> whole = readFile(dir / "whole.exr", 1u << 30);
  std::map<End, int> ends;
  for (rlim_t room = 0; room < 16 * kMega; room += kMega / 2) {
    const fs::path file = dir / "written.exr";
    const End written = inLittle(room, [&] { writeExr(file, noise, {"R", "G", "B"}, ExrPrecision::Float); });
    const End read = inLittle(room, [&] { readExr(dir / "whole.exr", {"R", "G", "B"}); });
    ++ends[written];
    EXPECT_NE(written, End::Refused) << room;
    EXPECT_NE(read, End::Refused) << room;
    ASSERT_EQ(fs::exists(file), written == End::Done) << room;
    if (written == End::Done) {
      EXPECT_TRUE(readFile(file, 1u << 30) == whole) << room;
    }
    fs::remove(file);
  }
  EXPECT_GT(ends[End::Done], 0);
  EXPECT_GT(ends[End::NoMemory], 0);
}

TEST(Folders, AreListedInOrderOrNotAtAll) {
  const TempDir dir;
  EXPECT_TRUE(entriesOf(dir / "none").empty());
  for (const char* file : {"b/d/e", "b/c", "a"}) {
    fs::create_directories((dir / file).parent_path());
    std::ofstream(dir / file) << "x";
  }
  fs::create_directory_symlink(dir / "b", dir / "link");
  const auto names = [&](const std::vector<fs::directory_entry>& entries) {
    std::vector<std::string> found;
    for (const auto& e : entries) found.push_back(e.path().lexically_relative(dir.path()).generic_string());
    return found;
  };
  EXPECT_EQ(names(entriesOf(dir.path())), (std::vector<std::string>{"a", "b", "link"}));
  EXPECT_EQ(names(entriesBelow(dir.path())),
            (std::vector<std::string>{"a", "b", "b/c", "b/d", "b/d/e", "link"}));
  const testing::FewDescriptors none;
  EXPECT_THAT(testing::messageOf(Error::Kind::Storage, [&] { entriesOf(dir.path()); }),
              HasSubstr("cannot list"));
}

}  // namespace
}  // namespace beam
