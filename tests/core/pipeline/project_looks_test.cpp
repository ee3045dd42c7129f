// SPDX-License-Identifier: Apache-2.0
// Looks in project.json: they are a person's like the settings, and nothing that is solved hangs on them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/pipeline/copy_project.h"
#include "core/pipeline/project_history.h"
#include "core/pipeline/take_survey.h"
#include "tests/core/pipeline/fake_pipeline.h"
#include "tests/support/message_of.h"
#include "tests/support/random_look.h"

namespace beam::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

Look namedLook(const std::string& name) {
  Look look;
  look.name = name;
  return look;
}

class ProjectLooks : public ::testing::Test {
 protected:
  ProjectLooks() : project(house.newProject()) {}
  fs::path file() const { return house.root() / "p.beam" / "project.json"; }
  std::string text() const { return readTextFile(file()); }
  std::size_t copies() const { return everythingIn(house.root() / "p.beam" / "history").size(); }

  FakeHouse house;
  Project project;
};

TEST_F(ProjectLooks, WithTwoLightsKeysAndMembersOfALaterVersionGoThroughProjectJson) {
  const char* look = R"({
    "name": "evening", "exposure_stops": 0.5, "grain": {"size": 2},
    "environment": {"enabled": true, "gain": 0.25, "rotation_deg": 30.0, "blur": 0.1},
    "lights": [
      {"id": "key", "kind": "spot", "position_m": {"x": 1.5, "y": 2.0, "z": 0.5}, "gobo": "leaves.png"},
      {"id": "rim", "kind": "rectangle", "color": {"r": 1.0, "g": 0.5, "b": 0.25, "profile": "P3"}},
      {"id": "hole", "kind": "portal", "title": "", "enabled": true, "depth": [1, 2]}],
    "curves": {"lights.key.intensity": {"after": "loop", "keys": [
      {"time_s": 0.0, "value": 1.0, "easing": "smooth", "tangent": 3}, {"time_s": 2.0, "value": 5.0, "easing": "step"}]}}})";
  nlohmann::json document = nlohmann::json::parse(text());
  document["looks"] = {nlohmann::json::parse(look)};
  std::ofstream(file()) << document.dump();

  project = house.open();
  ASSERT_EQ(project.looks().size(), 1u);
  const Look read = project.looks()[0];
  EXPECT_EQ(read.lighting.lights.size(), 3u);
  EXPECT_EQ(std::get<SpotLight>(at(read, 1).lighting.lights[0].kind).intensity, 3) << "half way, smooth";
  EXPECT_EQ(remarks(read).size(), 1u) << "the portal";
  project.set("surface.iterations", 77);
  project.save();
  EXPECT_EQ(house.open().looks(), project.looks());
  // Everything that was said is said again, with what was left out beside it.
  const nlohmann::json written = nlohmann::json::parse(text())["looks"][0];
  nlohmann::json merged = written;
  nlohmann::json said = nlohmann::json::parse(look);
  for (std::size_t i = 0; i < 3; ++i) merged["lights"][i].merge_patch(said["lights"][i]);
  said.erase("lights");
  merged.merge_patch(said);
  EXPECT_EQ(merged, written);
  EXPECT_EQ(written["lights"][2], nlohmann::json::parse(look)["lights"][2]);
}

TEST_F(ProjectLooks, AnyComesBackFromDiskInItsOrder) {
  for (std::uint64_t seed : {5, 2, 9}) project.setLook(randomLook(seed));
  project.save();
  EXPECT_EQ(house.open().looks(), project.looks());
  Look changed = randomLook(3);
  changed.name = project.looks()[1].name;
  project.setLook(changed);
  project.save();
  EXPECT_EQ(house.open().looks()[1], changed);
  EXPECT_EQ(*house.open().look(changed.name), changed);
  project.removeLook(changed.name);
  project.removeLook("never was");
  project.save();
  EXPECT_EQ(house.open().looks().size(), 2u);
  EXPECT_FALSE(house.open().look(changed.name));
}

TEST_F(ProjectLooks, StayInMemoryUntilSaved) {
  const auto before = everythingIn(house.root());
  project.setLook(namedLook("studio"));
  EXPECT_EQ(everythingIn(house.root()), before);
  EXPECT_TRUE(house.open().looks().empty());
}

TEST_F(ProjectLooks, AProjectWithoutAnyKeepsItsBytes) {
  const std::string before = text();
  EXPECT_EQ(before.find("looks"), std::string::npos);
  const auto all = everythingIn(house.root());
  project = house.open();
  project.save();
  EXPECT_EQ(everythingIn(house.root()), all) << "of before: nothing to do";
  project.setLook(namedLook("studio"));
  project.save();
  EXPECT_NE(text(), before);
  project.removeLook("studio");
  project.save();
  EXPECT_EQ(text(), before);
}

TEST_F(ProjectLooks, SavedAloneMakeNoCopyInHistory) {
  const std::size_t before = copies();
  for (int i = 0; i < 30; ++i) {
    Look look = namedLook("studio");
    look.exposure_stops = i / 10.0;
    project.setLook(look);
    project.save();
    EXPECT_EQ(house.open().looks()[0], look);
  }
  EXPECT_EQ(copies(), before);
  project.set("surface.iterations", 77);
  project.setLook(namedLook("other"));
  project.save();
  EXPECT_EQ(copies(), before + 1);
  const HistoryEntry newest = projectHistory(house.root() / "p.beam").front();
  EXPECT_EQ(readTextFile(newest.file), text()) << "a copy holds the looks, too";
}

TEST_F(ProjectLooks, SavedOverABrokenDocumentMakeACopyAsEver) {
  const std::size_t before = copies();
  std::ofstream(file()) << "{";
  project.setLook(namedLook("studio"));
  project.save();
  EXPECT_EQ(copies(), before + 1);
  EXPECT_EQ(house.open().looks().size(), 1u);
}

TEST_F(ProjectLooks, OnDiskOutliveAChangeOfTakes) {
  project.setLook(randomLook(1));
  project.save();
  changeSavedTakes(house.root() / "p.beam", [](const auto&) { return SavedTakes{{{"000", "002", 2}}, {}}; });
  EXPECT_EQ(house.open().looks(), project.looks());
}

TEST_F(ProjectLooks, ChangeNoKeyAndNoState) {
  house.finish(project);
  TakeSurveyor surveyor;
  surveyor.survey(project);
  const Digest key = project.key("materials.bake"_step, FrameIndex{1});
  // Whoever worked out keys anew would see it.
  house.frames->changed[{0, 1}] = 200;
  project.setLook(randomLook(1));
  EXPECT_EQ(project.key("materials.bake"_step, FrameIndex{1}), key);
  const TakeSurvey survey = surveyor.survey(project);
  for (const SurveyLane& lane : survey.lanes) {
    for (const CellState cell : lane.cells) EXPECT_EQ(cell, CellState::Done) << lane.title;
  }
}

TEST_F(ProjectLooks, ThatAreNotValidAreRefusedAndChangeNothing) {
  project.setLook(namedLook("studio"));
  Look bad = namedLook("studio");
  bad.exposure_stops = 99;
  EXPECT_THAT(messageOf(Error::Kind::Data, [&] { project.setLook(bad); }), HasSubstr("exposure_stops"));
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { project.setLook(namedLook("a/b")); }), HasSubstr("a/b"));
  EXPECT_EQ(project.looks(), (std::vector<Look>{namedLook("studio")}));
}

TEST_F(ProjectLooks, ThatAreBrokenAreToldWithTheirPlaceAndWhatToDo) {
  nlohmann::json document = nlohmann::json::parse(text());
  document["looks"] = {{{"name", "a"}}, {{"name", "b"}, {"lights", {{{"id", "key"}, {"kind", 3}}}}}};
  std::ofstream(file()) << document.dump();
  EXPECT_THAT(
      messageOf(Error::Kind::Data, [&] { house.open(); }),
      AllOf(HasSubstr("p.beam/project.json\" is broken: looks[1].lights[0].kind: expected a text, found 3"),
            HasSubstr("history/ has 1 readable version")));
}

TEST_F(ProjectLooks, OfACopyStillFindTheirFiles) {
  fs::create_directories(house.root() / "hdr");
  std::ofstream(house.root() / "hdr" / "sky.exr") << "sky";
  Look look = namedLook("sky");
  look.lighting.environment.file = referenceTo(house.root() / "hdr" / "sky.exr", project.folder());
  project.setLook(look);
  Progress progress;
  copyProject(project, house.root() / "deep" / "er" / "q.beam", true, progress);
  // Both move: only the relative reference holds.
  fs::create_directories(house.root() / "disk");
  for (const char* name : {"deep", "hdr"}) fs::rename(house.root() / name, house.root() / "disk" / name);
  const Project copy = house.open("disk/deep/er/q.beam");
  const auto found = resolve(copy.look("sky")->lighting.environment.file, copy.folder());
  ASSERT_TRUE(found);
  EXPECT_EQ(readTextFile(*found), "sky");
}

}  // namespace
}  // namespace beam::testing
