// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/log.h"
#include "core/io/file.h"
#include "core/pipeline/file_lock.h"
#include "core/pipeline/project_report.h"
#include "core/scene/transform.h"
#include "tests/core/pipeline/fake_pipeline.h"
#include "tests/support/message_of.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;

TEST(ProjectSettings, AnUnknownKeyNamesTheNearest) {
  FakeHouse house;
  Project p = house.newProject();
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { p.set("surface.iteration", 5); }),
              HasSubstr("surface.iterations"));
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { p.set("surfaces.iterations", 5); }),
              HasSubstr("surface.iterations"));
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { p.setPreset("drift"); }), HasSubstr("draft"));
}

TEST(ProjectSettings, WrongTypesAndRangesAreRefusedAndChangeNothing) {
  FakeHouse house;
  Project p = house.newProject();
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { p.set("surface.iterations", std::string("many")); }),
              HasSubstr("surface.iterations"));
  messageOf(Error::Kind::Usage, [&] { p.set("surface.iterations", 0); });
  messageOf(Error::Kind::Usage, [&] { p.set("surface.iterations", 2.5); });
  messageOf(Error::Kind::Usage, [&] { p.set("surface.solver", std::string("magic")); });
  EXPECT_TRUE(p.document().settings.empty());
}

TEST(ProjectSettings, OnlyWhatDiffersFromThePresetIsKept) {
  FakeHouse house;
  Project p = house.newProject();
  p.set("surface.iterations", 3);
  EXPECT_EQ(p.document().settings.size(), 1u);
  p.setPreset("draft");  // says 3 too
  EXPECT_TRUE(p.document().settings.empty());
  EXPECT_EQ(std::get<int>(p.value("surface.iterations")), 3);
  p.set("surface.iterations", 10);
  p.save();
  EXPECT_EQ(std::get<int>(house.open().value("surface.iterations")), 10);
}

// Lets the house find that its capture is in millimetres, far away; counts how often it is asked to.
void findsMillimetres(FakeHouse& house, int& found) {
  house.setup->open_capture = [&found, open = house.setup->open_capture](const auto& folder,
                                                                         const ImportOptions& options) {
    ImportedCapture imported = open(folder, options);
    found += !options.placement;
    imported.placement = options.placement.value_or(
        CapturePlacement{options.unit_m.value_or(0.001), {210000.5, 0.1, -3}, UnitFrom::Height, 1712.25});
    if (options.unit_m && !options.placement) imported.placement.from = UnitFrom::Given;
    imported.set =
        transformed(std::move(imported.set), worldFromCapture(imported.set.up, imported.placement));
    return imported;
  };
}

TEST(ProjectWorld, IsFoundOnceWhenAProjectIsMadeAndKept) {
  FakeHouse house;
  int found = 0;
  findsMillimetres(house, found);
  Project made = house.newProject();
  EXPECT_EQ(found, 1);
  const Project again = house.open();
  EXPECT_EQ(again.imported().placement, made.imported().placement) << "to the last bit";
  EXPECT_EQ(again.document().world, made.imported().placement);
  EXPECT_EQ(again.capture().capture_from_world, made.capture().capture_from_world);
  EXPECT_EQ(again.key("surface.fit"_step, FrameIndex{0}), made.key("surface.fit"_step, FrameIndex{0}));
  made.setUp(UpAxis::PlusZ);
  made.capture();
  EXPECT_EQ(found, 1);
}

TEST(ProjectWorld, AProjectOfBeforeOnlyTurnsItsCapture) {
  FakeHouse house;
  const Project before = house.newProject();
  ProjectDocument document = before.document();
  document.world.reset();
  writeFileAtomically(before.folder() / "project.json", toJson(document));
  int found = 0;
  findsMillimetres(house, found);
  Project again = house.open();
  EXPECT_TRUE(isIdentity(again.capture().capture_from_world));
  again.save();
  EXPECT_EQ(found, 0);
  EXPECT_EQ(readTextFile(before.folder() / "project.json"), toJson(document)) << "there is nothing to do";
  EXPECT_EQ(again.key("surface.fit"_step, FrameIndex{0}), before.key("surface.fit"_step, FrameIndex{0}));
}

TEST(ProjectWorld, AUnitThatIsGivenHoldsAndIsAskedForOnce) {
  FakeHouse house;
  int found = 0;
  findsMillimetres(house, found);
  Project p = house.newProject();
  p.setUnit(0.01);
  p.save();
  EXPECT_EQ(found, 2);
  Project again = house.open();
  again.setUnit(0.01);
  EXPECT_EQ(again.imported().placement.unit_m, 0.01);
  EXPECT_EQ(again.imported().placement.from, UnitFrom::Given);
  EXPECT_EQ(found, 2);
}

TEST(ProjectWorld, WhatIsNoPlacementIsRefusedAndWhatALaterProgramSaysOfItStays) {
  FakeHouse house;
  int found = 0;
  findsMillimetres(house, found);
  const std::string text = readTextFile(house.newProject().folder() / "project.json");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    return changed.replace(changed.find(from), from.size(), to);
  };
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"\"unit_m\": 0.001", "\"unit_m\": 0"},
                                                        {"\"unit_m\": 0.001", "\"unit_m\": \"mm\""},
                                                        {"\"unit_m\": 0.001", "\"unit_m\": null"},
                                                        {"210000.5,", ""},
                                                        {"\"from\": \"height\"", "\"from\": \"hearsay\""},
                                                        {"\"height\": 1712.25", "\"height\": -1"}}) {
    EXPECT_THROW(parseProjectDocument(with(from, to), "p"), BrokenDocument) << to;
  }
  const std::string later = with("\"unit_m\"", "\"turned\": [1, 2], \"unit_m\"");
  const ProjectDocument read = parseProjectDocument(later, "p");
  EXPECT_EQ(read.world->origin, dvec3(210000.5, 0.1, -3));
  EXPECT_EQ(parseProjectDocument(toJson(read), "p").world_unknown, R"({"turned":[1,2]})");
}

TEST(ProjectSettings, EveryFieldIsListedUnderItsFullName) {
  FakeHouse house;
  const std::vector<Field> fields = house.newProject().fields();
  ASSERT_EQ(fields.size(), 13u);
  EXPECT_EQ(fields[9].info.name, "surface.refine.normal_weight");
  EXPECT_EQ(fields.back().info.name, "materials.solver");
}

TEST(ProjectFolder, OpeningAndLookingWriteNothing) {
  FakeHouse house;
  house.finish(house.newProject());
  const auto before = everythingIn(house.root());
  const Project p = house.open();
  EXPECT_THAT(statusText(p), HasSubstr("done"));
  EXPECT_THAT(statusJson(p), HasSubstr("done"));
  EXPECT_EQ(everythingIn(house.root()), before);
}

TEST(ProjectFolder, SavingTheSameWritesNothing) {
  FakeHouse house;
  Project p = house.newProject();
  const auto before = everythingIn(house.root());
  p.save();
  EXPECT_EQ(everythingIn(house.root()), before);
}

TEST(ProjectFolder, TheLastTwentyDocumentsAreKept) {
  FakeHouse house;
  Project p = house.newProject();
  for (int i = 20; i < 50; ++i) {
    p.set("surface.iterations", i);
    p.save();
  }
  std::vector<std::string> names;
  for (const auto& e : std::filesystem::directory_iterator(house.root() / "p.beam" / "history")) {
    names.push_back(e.path().filename().string());
  }
  EXPECT_EQ(names.size(), 20u);
  EXPECT_THAT(names, ::testing::Contains("00000031.json"));
}

TEST(ProjectFolder, MembersOfALaterVersionSurviveASave) {
  FakeHouse house;
  house.newProject();
  const auto file = house.root() / "p.beam" / "project.json";
  std::string text = readTextFile(file);
  text.insert(text.find("\"preset\""), "\"rooms\": {\"studio\": [1, 2]},\n  ");
  std::ofstream(file) << text;
  Project p = house.open();
  p.set("surface.iterations", 77);
  p.save();
  EXPECT_THAT(readTextFile(file), HasSubstr("studio"));
  EXPECT_EQ(std::get<int>(house.open().value("surface.iterations")), 77);
}

TEST(ProjectFolder, TakesOnDiskOutliveASaveOfTheSettingsOfAnother) {
  FakeHouse house;
  Project p = house.newProject();
  const auto seen = changeSavedTakes(house.root() / "p.beam", [](const auto& takes) {
    EXPECT_EQ(takes, SavedTakes());
    return SavedTakes{{{"000", "002", 2}}, {}};
  });
  EXPECT_EQ(seen.now, (std::vector<SavedTake>{{"000", "002", 2}}));
  p.set("surface.iterations", 77);
  p.save();
  EXPECT_EQ(house.open().document().takes, seen.now);
  EXPECT_EQ(p.document().takes, seen.now);
  EXPECT_EQ(std::get<int>(house.open().value("surface.iterations")), 77);
  changeSavedTakes(house.root() / "p.beam", [](const auto& takes) { return takes; });
  EXPECT_EQ(everythingIn(house.root() / "p.beam" / "history").size(), 2u) << "for what people change";
}

Look lookNamed(const std::string& name) {
  Look look;
  look.name = name;
  return look;
}

TEST(ProjectSave, KeepsWhatAnotherProgramChangedMeanwhile) {
  FakeHouse house;
  Project ours = house.newProject(), theirs = house.open();
  theirs.set("surface.iterations", 77);
  theirs.setHoldOut({"top"});
  theirs.setLook(lookNamed("dusk"));
  theirs.save();
  ours.set("surface.refine.normal_weight", 0.5);
  ours.setLook(lookNamed("noon"));
  ours.save();
  for (const Project& p : {ours, house.open()}) {
    EXPECT_EQ(std::get<int>(p.value("surface.iterations")), 77);
    EXPECT_EQ(std::get<double>(p.value("surface.refine.normal_weight")), 0.5);
    EXPECT_EQ(p.capture().views[2].split, Split::Test);
    EXPECT_TRUE(p.look("dusk") && p.look("noon"));
  }
  theirs.reset("surface.iterations");
  theirs.removeLook("dusk");
  theirs.save();
  EXPECT_EQ(std::get<double>(theirs.value("surface.refine.normal_weight")), 0.5);
  const Project now = house.open();
  EXPECT_EQ(std::get<int>(now.value("surface.iterations")), 10);
  EXPECT_FALSE(now.look("dusk"));
  EXPECT_TRUE(now.look("noon"));
}

TEST(ProjectSave, WithoutAChangeOfItsOwnWritesNoOldSettings) {
  FakeHouse house;
  Project ours = house.newProject(), theirs = house.open();
  theirs.set("surface.iterations", 77);
  theirs.save();
  ours.save();
  EXPECT_EQ(std::get<int>(house.open().value("surface.iterations")), 77);
}

TEST(ProjectSave, WarnsOfWhatBothChangedAndOursHolds) {
  FakeHouse house;
  Project ours = house.newProject(), theirs = house.open();
  theirs.set("surface.iterations", 77);
  theirs.set("surface.solver", std::string("fancy"));
  theirs.save();
  ours.set("surface.iterations", 55);
  ours.set("surface.solver", std::string("fancy"));
  std::vector<std::string> warnings;
  const int sink = addLogSink([&](const LogRecord& r) { warnings.push_back(r.text); });
  ours.save();
  removeLogSink(sink);
  EXPECT_THAT(warnings, ::testing::ElementsAre(::testing::AllOf(HasSubstr("another program"),
                                                                HasSubstr("surface.iterations"),
                                                                ::testing::Not(HasSubstr("solver")))));
  EXPECT_EQ(std::get<int>(house.open().value("surface.iterations")), 55);
}

TEST(ProjectFolder, ANewerMajorFormatIsRefusedByName) {
  FakeHouse house;
  house.newProject();
  const auto file = house.root() / "p.beam" / "project.json";
  std::string text = readTextFile(file);
  text.replace(text.find("\"major\": 1"), 10, "\"major\": 2");
  std::ofstream(file) << text;
  EXPECT_THAT(messageOf(Error::Kind::Data, [&] { house.open(); }), HasSubstr("newer"));
}

TEST(ProjectFolder, DamagedDocumentsAreBadInput) {
  FakeHouse house;
  house.newProject();
  const auto file = house.root() / "p.beam" / "project.json";
  const std::string good = readTextFile(file);
  for (std::size_t length = 0; length + 2 < good.size(); length += 37) {
    std::ofstream(file) << good.substr(0, length);
    messageOf(Error::Kind::Data, [&] { house.open(); });
  }
}

TEST(ProjectFolder, AForeignFolderIsNeverTaken) {
  FakeHouse house;
  std::filesystem::create_directories(house.root() / "mine");
  std::ofstream(house.root() / "mine" / "letter.txt") << "dear";
  messageOf(Error::Kind::Usage, [&] { Project::create(house.root() / "mine", {}, house.setup); });
  messageOf(Error::Kind::Data, [&] { house.open("mine"); });
}

TEST(ProjectFolder, AnotherWriterIsNamed) {
  FakeHouse house;
  Project p = house.newProject();
  const auto lock = FileLock::tryAcquire(house.root() / "p.beam" / "LOCK");
  ASSERT_TRUE(lock);
  p.set("surface.iterations", 99);
  EXPECT_THAT(messageOf(Error::Kind::Locked, [&] { p.save(); }),
              HasSubstr("process " + std::to_string(::getpid())));
}

TEST(ProjectFolder, CaptureAndProjectMayMoveTogether) {
  FakeHouse house;
  house.newProject();
  std::filesystem::create_directories(house.root() / "disk");
  for (const char* name : {"p.beam", "capture"}) {
    std::filesystem::rename(house.root() / name, house.root() / "disk" / name);
  }
  const Project p = house.open("disk/p.beam");
  EXPECT_EQ(p.captureFolder().lexically_normal(), (house.root() / "disk" / "capture").lexically_normal());
}

TEST(ProjectFolder, ALostCaptureIsNamed) {
  FakeHouse house;
  house.newProject();
  std::filesystem::rename(house.root() / "capture", house.root() / "elsewhere");
  EXPECT_THAT(messageOf(Error::Kind::Data, [&] { house.open().capture(); }), HasSubstr("capture"));
  EXPECT_TRUE(house.open().isCapture(house.root() / "elsewhere"));
}

}  // namespace
}  // namespace beam::testing
