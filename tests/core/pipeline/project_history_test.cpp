// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/project_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/pipeline/fake_pipeline.h"
#include "tests/support/message_of.h"

namespace beam::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// A project with three versions: as made, with one setting, with two.
class ProjectHistory : public ::testing::Test {
 protected:
  ProjectHistory() {
    Project p = house.newProject();
    p.set("surface.iterations", 20);
    p.save();
    p.set("surface.batch", 7);
    p.save();
  }
  std::filesystem::path folder() const { return house.root() / "p.beam"; }
  std::filesystem::path file() const { return folder() / "project.json"; }
  void write(const std::string& text) const { std::ofstream(file()) << text; }
  std::string refusal() {
    try {
      house.open();
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), Error::Kind::Data);
      return e.what();
    }
    ADD_FAILURE() << "it was opened";
    return {};
  }
  FakeHouse house;
};

TEST_F(ProjectHistory, ListsVersionsTheNewestFirstWithWhatTheySay) {
  std::ofstream(folder() / "history" / "00000002.json") << "{";
  std::ofstream(folder() / "history" / "notes.json") << "{}";
  const std::vector<HistoryEntry> entries = projectHistory(folder());
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0].file.filename(), "00000003.json");
  EXPECT_EQ(entries[0].summary, "preset standard, 2 settings differ");
  EXPECT_FALSE(entries[1].readable);
  EXPECT_THAT(entries[1].summary, HasSubstr("broken"));
  EXPECT_EQ(entries[2].summary, "preset standard, no setting differs");
  const auto age = std::chrono::system_clock::now() - entries[0].file_time;
  EXPECT_LT(age, std::chrono::hours(1));
  EXPECT_GE(age, std::chrono::seconds(-2));
}

TEST_F(ProjectHistory, ABrokenDocumentIsToldInWordsWithItsPlaceAndWhatToDo) {
  std::string text = readTextFile(file());
  text.erase(text.find("\"preset\": ") + 8, 2);  // the colon
  write(text);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("p.beam/project.json"), HasSubstr("line "), HasSubstr("column "),
                               HasSubstr("expected ':'"), HasSubstr("history/ has 3 readable versions"),
                               Not(HasSubstr("exception")), Not(HasSubstr("parse_error"))));
}

TEST_F(ProjectHistory, EveryKindOfDamageIsToldWithoutAnExceptionsName) {
  const std::string good = readTextFile(file());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  const std::vector<std::pair<std::string, std::string>> damages = {
      {"", "it is empty"},
      {"[1, 2]", "expected object, found array"},
      {"{}", "expected \"format\", found none"},
      {with("\"preset\": \"standard\"", "\"preset\": 7"), "preset: expected string, found number"},
      {with("\"id\"", "\"di\""), "expected \"id\", found none"},
      {with("\"surface.batch\": 7", "\"surface.batch\": [7]"), "expected a JSON scalar"},
      {with("\"hold_out\"", "\"up\": \"left\", \"hold_out\""), "expected +Y"},
      {with("\"xxh3_128\": \"", "\"xxh3_128\": \"zz"), "broken"},
      {good.substr(0, good.size() / 2), "line "},
  };
  for (const auto& [text, told] : damages) {
    write(text);
    EXPECT_THAT(refusal(), AllOf(HasSubstr(told), HasSubstr("project.json"), HasSubstr("3 readable versions"),
                                 Not(HasSubstr("exception"))));
  }
}

TEST_F(ProjectHistory, RestoringKeepsTheBrokenFileAside) {
  const std::string good = readTextFile(file());
  for (int n = 1; n <= 2; ++n) {
    const std::string broken = "{ broken " + std::to_string(n);
    write(broken);
    restoreProject(folder(), projectHistory(folder()).front());
    EXPECT_EQ(readTextFile(file()), good);
    EXPECT_EQ(readTextFile(file().string() + ".broken-" + std::to_string(n)), broken);
    EXPECT_EQ(std::get<int>(house.open().value("surface.batch")), 7);
  }
  EXPECT_EQ(projectHistory(folder()).size(), 3u);
}

TEST_F(ProjectHistory, AnEarlierVersionCanBeChosenAndAnUnreadableOneCannot) {
  write("{");
  const std::vector<HistoryEntry> entries = projectHistory(folder());
  restoreProject(folder(), entries[2]);
  EXPECT_TRUE(house.open().document().settings.empty());
  std::ofstream(entries[0].file) << "[";
  const std::string before = readTextFile(file());
  EXPECT_THROW(restoreProject(folder(), entries[0]), Error);
  EXPECT_EQ(readTextFile(file()), before);
}

TEST_F(ProjectHistory, AProjectThatLostItsDocumentIsKnownAndRestored) {
  std::filesystem::remove(file());
  EXPECT_TRUE(looksLikeProject(folder()));
  EXPECT_THAT(refusal(), AllOf(HasSubstr("lost its project.json"), HasSubstr("3 readable versions")));
  restoreProject(folder(), projectHistory(folder()).front());
  EXPECT_EQ(std::get<int>(house.open().value("surface.batch")), 7);
  EXPECT_FALSE(std::filesystem::exists(file().string() + ".broken-1"));
}

TEST_F(ProjectHistory, ResultsAloneTellAProjectFromAForeignFolder) {
  house.finish(house.open());
  std::filesystem::remove(file());
  std::filesystem::remove_all(folder() / "history");
  EXPECT_TRUE(looksLikeProject(folder()));
  EXPECT_THAT(refusal(), HasSubstr("no readable version"));
  EXPECT_FALSE(looksLikeProject(house.root()));
  std::filesystem::create_directories(house.root() / "mine" / "results" / "2024");
  EXPECT_FALSE(looksLikeProject(house.root() / "mine"));
}

TEST_F(ProjectHistory, OfANewerProgramIsNotCalledBroken) {
  std::string text = readTextFile(file());
  text.replace(text.find("\"major\": 1"), 10, "\"major\": 2");
  write(text);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("newer"), Not(HasSubstr("broken"))));
}

TEST_F(ProjectHistory, ForeignFilesInTheFolderChangeNoNumberAndStay) {
  std::ofstream(folder() / "history" / "zz-mine.json") << "{}";
  const std::string first = readTextFile(folder() / "history" / "00000001.json");
  Project p = house.open();
  p.set("surface.batch", 9);
  p.save();
  EXPECT_EQ(projectHistory(folder()).front().file.filename(), "00000004.json");
  EXPECT_EQ(readTextFile(folder() / "history" / "00000001.json"), first);
  EXPECT_TRUE(std::filesystem::exists(folder() / "history" / "zz-mine.json"));
}

TEST_F(ProjectHistory, ADeepDocumentIsRefusedBeforeItExhaustsTheStack) {
  const std::size_t deep = 300000;
  std::string text = readTextFile(file());
  text.insert(1, "\"later\": " + std::string(deep, '[') + std::string(deep, ']') + ",");
  write(text);
  EXPECT_THAT(refusal(), HasSubstr("levels"));
}

TEST_F(ProjectHistory, WhatWouldNotBeReadAgainIsNotWritten) {
  const std::string before = readTextFile(file());
  ProjectDocument document = parseProjectDocument(before, "p");
  document.unknown = "{\"later\": \"" + std::string(kMostTextBytes, 'x') + "\"}";
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { writeProjectDocument(folder(), document); }),
              AllOf(HasSubstr("cannot be saved"), HasSubstr("67108864")));
  EXPECT_EQ(readTextFile(file()), before);
  EXPECT_EQ(projectHistory(folder()).size(), 3u);
}

TEST_F(ProjectHistory, ALongDocumentIsWrittenWithoutBlanksSoThatItIsReadAgain) {
  std::string list = "[0";
  for (std::size_t i = 1; i < kMostTextBytes / 6; ++i) list += ",0";
  ProjectDocument document = parseProjectDocument(readTextFile(file()), "p");
  document.unknown = "{\"later\":" + list + "]}";
  writeProjectDocument(folder(), document);
  EXPECT_EQ(parseProjectDocument(readTextFile(file()), "p").unknown, document.unknown);
}

}  // namespace
}  // namespace beam::testing
