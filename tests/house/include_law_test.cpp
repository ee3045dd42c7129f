// SPDX-License-Identifier: Apache-2.0
// The law of the house: who may include whom, which foreign words live where, and how long a file may be.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/house/sources.h"

namespace beam::testing {
namespace {

using Rooms = std::set<std::string>;

// A room may include itself and these.
const std::map<std::string, Rooms>& allowed() {
  static const Rooms kScene = {"core/base", "core/math", "core/image", "core/scene"};
  const auto plus = [](Rooms rooms, const Rooms& more) {
    rooms.insert(more.begin(), more.end());
    return rooms;
  };
  static const std::map<std::string, Rooms> kLaw = {
      {"core/base", {}},
      {"core/math", {"core/base"}},
      {"core/image", {"core/base", "core/math"}},
      {"core/scene", {"core/base", "core/math", "core/image"}},
      {"core/io", kScene},
      {"core/render", kScene},
      {"core/optim", plus(kScene, {"core/render"})},
      {"core/pipeline", plus(kScene, {"core/io", "core/render"})},
      {"core/method", plus(kScene, {"core/render", "core/optim"})},
      {"core/sample", plus(kScene, {"core/io", "core/render"})},
      {"core/stages", plus(kScene, {"core/io", "core/render", "core/method", "core/pipeline"})},
      {"core/work", plus(kScene, {"core/io", "core/render", "core/optim", "core/pipeline", "core/method",
                                  "core/sample", "core/stages"})},
      {"viewers", plus(kScene, {"core/render"})},
      {"ui",
       plus(kScene, {"core/io", "core/pipeline", "core/render", "core/stages", "core/work", "viewers"})},
  };
  return kLaw;
}

std::string roomOf(const std::string& path) {
  const std::vector<std::string> top = {"viewers", "ui", "app", "plugins", "tests"};
  for (const std::string& t : top) {
    if (path.rfind(t + "/", 0) == 0) return t;
  }
  const std::size_t first = path.find('/'), second = path.find('/', first + 1);
  return second == std::string::npos ? path : path.substr(0, second);
}

std::vector<Source> sources() { return sourcesIn({"core", "viewers", "ui", "app", "plugins"}); }

std::vector<std::string> includesOf(const Source& source) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<std::string> includes;
  for (const std::string& line : source.lines) {
    std::smatch m;
    if (std::regex_search(line, m, kInclude)) includes.push_back(m[1]);
  }
  return includes;
}

bool startsWith(const std::string& s, const std::vector<std::string>& stems) {
  for (const std::string& p : stems) {
    if (s.rfind(p, 0) == 0) return true;
  }
  return false;
}

TEST(IncludeLaw, ARoomIncludesOnlyWhatStandsBelowIt) {
  for (const Source& s : sources()) {
    const std::string room = roomOf(s.path);
    const auto law = allowed().find(room);
    if (law == allowed().end()) continue;  // app may include everything
    for (const std::string& i : includesOf(s)) {
      if (!startsWith(i, {"core/", "viewers/", "ui/", "app/", "plugins/", "tests/"})) continue;
      const std::string other = roomOf(i);
      EXPECT_TRUE(other == room || law->second.contains(other)) << s.path << " includes " << i;
    }
  }
}

TEST(IncludeLaw, ForeignWordsStayInTheirRooms) {
  struct Word {
    std::vector<std::string> stems;
    std::vector<std::string> places;
  };
  const std::vector<Word> words = {
      {{"Q"}, {"viewers/", "ui/", "app/gui/"}},
      {{"vtk", "QVTK"}, {"viewers/scene/", "app/gui/"}},
      {{"GL/"}, {"viewers/"}},
      {{"nlohmann/"},
       {"core/base/fields_json", "core/io/", "core/pipeline/", "core/sample/", "core/stages/score_files",
        "core/stages/screening_file", "core/stages/track_files", "core/work/ground_truth",
        "core/work/kept_evaluation", "core/work/scores", "app/", "ui/"}},
      {{"opencv2/"}, {"core/io/", "core/image/"}},
      {{"Imf", "OpenEXR/", "Imath"}, {"core/io/"}},
      {{"embree"}, {"core/render/cpu/embree_tracer.cpp", "core/render/triangle_tracer.cpp"}},
      {{"ceres/"}, {"core/method/"}},
      {{"tbb/"}, {"core/base/parallel.cpp"}},
      {{"hwy/"}, {"core/render/"}},
      {{"CLI/"}, {"app/"}},
  };
  for (const Source& s : sources()) {
    for (const std::string& i : includesOf(s)) {
      for (const Word& w : words) {
        if (!startsWith(i, w.stems)) continue;
        EXPECT_TRUE(startsWith(s.path, w.places)) << s.path << " includes " << i;
      }
      EXPECT_FALSE(s.path.ends_with(".h") && startsWith(i, {"opencv2/", "Imf", "ceres/", "Eigen/"}))
          << s.path << " includes " << i;
    }
  }
}

TEST(IncludeLaw, KernelsDoNotKnowGlm) {
  for (const Source& s : sources()) {
    if (s.path.rfind("core/render/kernels/", 0) != 0) continue;
    for (const std::string& i : includesOf(s))
      EXPECT_FALSE(startsWith(i, {"glm/", "core/math/types.h"})) << s.path;
  }
}

TEST(House, NoFileIsAHall) {
  for (const Source& s : sources()) EXPECT_LE(s.lines.size(), 600u) << s.path;
}

TEST(House, EveryFileNamesItsLicence) {
  for (const Source& s : sources()) {
    ASSERT_FALSE(s.lines.empty()) << s.path;
    EXPECT_EQ(s.lines[0], "// SPDX-License-Identifier: Apache-2.0") << s.path;
  }
}

}  // namespace
}  // namespace beam::testing
