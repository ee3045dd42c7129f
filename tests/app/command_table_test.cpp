// SPDX-License-Identifier: Apache-2.0
// What every command owes, asked of every command that the program says it has: a new one joins by itself.
// The words for a call are made of the arguments and flags as the help tells them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "tests/app/help_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

// A place that a command writes to, and how it is named in a call.
struct Place {
  std::string flag;  // "--out"; empty: by its place
  bool file = false, required = false;
};

struct Call {
  std::string name;  // "render"
  Json said;         // what the help says of it
  std::vector<Place> places;

  const Json* flag(const std::string& wanted) const {
    for (const Json& f : said["flags"])
      for (const Json& n : f["names"])
        if (n == wanted) return &f;
    return nullptr;
  }
};

std::string typeOf(const Json& facts) { return facts.value("type", std::string()); }

// Commands make projects and folders where they say so, and read everything else.
bool isNewPlace(const std::string& command, const std::string& argument) {
  return (command == "new" && argument == "PROJECT") || argument == "FOLDER";
}

std::vector<Call> allCommands() {
  std::vector<Call> calls;
  for (const Json& said : helpOfProgram()["commands"]) {
    const std::string path = said["command"];
    if (path == "beam") continue;
    Call call{path.substr(5), said, {}};
    for (const Json& a : said["arguments"])
      if (isNewPlace(call.name, a["names"].back())) call.places.push_back({"", false, a["required"]});
    for (const Json& f : said["flags"]) {
      const std::string name = f["names"].back();
      if (name == "--out") call.places.push_back({name, typeOf(f) == "FILE", f["required"]});
      if (name == "--json-file") call.places.push_back({name, true, false});
    }
    calls.push_back(std::move(call));
  }
  return calls;
}

class CommandTable : public ::testing::Test {
 protected:
  void SetUp() override { ExampleHouse::get().copyInto(folder_.path()); }

  std::string at(const std::string& name) const { return (folder_.path() / name).string(); }

  // What an argument that is read is given.
  std::string given(const std::string& word, const Json& facts) const {
    if (facts.contains("choices")) return facts["choices"].front();
    if (word == "PROJECT") return at("Take.beam");
    if (word == "CAPTURE" || word == "PATH") return at("CAPTURE");
    if (word == "FILE") return at("studio.exr");
    return "";
  }

  // A call that works; `place` stands where `chosen` is written, its other places elsewhere.
  Words wordsOf(const Call& call, const Place* chosen = nullptr, const std::string& place = "") const {
    Words words = {call.name};
    const auto placeOf = [&](const Place& p) {
      const bool is_chosen = chosen && p.flag == chosen->flag;
      return is_chosen ? place : at("other-" + call.name + (p.file ? ".out" : ""));
    };
    for (const Json& a : call.said["arguments"]) {
      const std::string name = a["names"].back();
      const Place* own = nullptr;
      for (const Place& p : call.places)
        if (p.flag.empty() && isNewPlace(call.name, name)) own = &p;
      const std::string word = own ? placeOf(*own) : a["required"] ? given(name, a) : std::string();
      if (!word.empty()) words.push_back(word);
    }
    for (const Json& f : call.said["flags"]) {
      const std::string name = f["names"].back();
      for (const Place& p : call.places) {
        if (p.flag == name && (p.required || (chosen && chosen->flag == name)))
          words = words + Words{name, placeOf(p)};
      }
      if (f["required"] && name != "--out") words = words + Words{name, given(typeOf(f), f)};
    }
    return words + lessWork(call);
  }

  // What keeps a call short.
  static Words lessWork(const Call& call) {
    Words words;
    if (call.name == "sample") words = {"--cameras", "2", "--size", "16x16", "--samples", "1"};
    if (call.name == "process" || call.name == "run") words = tinyTake() + Words{"--frames", "0"};
    if (call.flag("--frames") && words.empty()) words = {"--frames", "0"};
    return words;
  }

  Said beam(const Words& words) const { return Running(folder_.path(), words).wait(); }
  Said shell(const std::string& line) const { return typed(folder_.path(), line); }

  static std::string typedLine(const Words& words) {
    std::string line = "beam";
    for (const std::string& word : words) line += " '" + word + "'";
    return line;
  }

  TempDir folder_;
};

TEST_F(CommandTable, HelpIsEnoughAloneAndFits) {
  for (const Call& call : allCommands()) {
    const Said said = beam({call.name, "--help"});
    EXPECT_EQ(said.code, 0) << call.name;
    EXPECT_EQ(said.err, "") << call.name;
    EXPECT_THAT(said.out, HasSubstr("Examples")) << call.name;
    std::istringstream lines(said.out);
    for (std::string line; std::getline(lines, line);)
      EXPECT_LE(line.size(), 80u) << call.name << ": " << line;
  }
}

TEST_F(CommandTable, AWrongFlagIsRefusedByNameAndNothingIsDone) {
  for (const Call& call : allCommands()) {
    const Said said = beam(wordsOf(call) + Words{"--no-such-flag"});
    EXPECT_EQ(said.code, 2) << call.name;
    EXPECT_THAT(said.err, HasSubstr("--no-such-flag")) << call.name;
    EXPECT_EQ(said.out, "") << call.name;
    for (const Place& place : call.places)
      EXPECT_FALSE(fs::exists(at("other-" + call.name + (place.file ? ".out" : "")))) << call.name;
  }
}

TEST_F(CommandTable, AFullStandardOutputEndsWith74) {
  for (const Call& call : allCommands()) {
    EXPECT_EQ(shell("beam " + call.name + " --help > /dev/full").code, 74) << call.name;
    const Said said = shell(typedLine(wordsOf(call)) + " > /dev/full");
    // A run says everything on standard error.
    const bool silent = call.name == "run" || call.name == "process";
    EXPECT_EQ(said.code, silent ? 0 : 74) << call.name << "\n" << said.err;
  }
}

TEST_F(CommandTable, APlaceThatCannotBeWrittenEndsWith74AndALineThatNamesIt) {
  for (const Call& call : allCommands()) {
    for (const Place& place : call.places) {
      const Said said = beam(wordsOf(call, &place, "/dev/null/x"));
      EXPECT_THAT(said.code, AnyOf(74, 2)) << call.name << " " << place.flag << "\n" << said.err;
      EXPECT_THAT(said.err, HasSubstr("\"/dev/null")) << call.name << " " << place.flag;
    }
  }
}

TEST_F(CommandTable, NothingIsWrittenIntoACaptureOrAProject) {
  for (const Call& call : allCommands()) {
    for (const Place& place : call.places) {
      for (const char* owner : {"CAPTURE", "Take.beam"}) {
        const auto before = filesIn(fs::canonical(at(owner)));
        const Said said = beam(wordsOf(call, &place, at(std::string(owner) + "/inside")));
        EXPECT_EQ(said.code, 2) << call.name << " " << place.flag << "\n" << said.err;
        EXPECT_EQ(filesIn(fs::canonical(at(owner))), before) << call.name;
      }
    }
  }
}

TEST_F(CommandTable, WhatItWroteItReplacesAndWhatOthersWroteItDoesNot) {
  for (const Call& call : allCommands()) {
    for (const Place& place : call.places) {
      SCOPED_TRACE(call.name + " " + place.flag);
      const std::string target = at("place-" + call.name + place.flag + (place.file ? ".out" : ""));
      const Words words = wordsOf(call, &place, target);
      ASSERT_EQ(beam(words).code, 0) << beam(words).err;
      const auto contents = [&] {
        return place.file ? std::map<std::string, std::string>{{"", textOf(target)}} : filesIn(target);
      };
      const Said again = beam(words);
      EXPECT_THAT(again.code, AnyOf(0, 2)) << again.err;
      if (again.code == 2) {
        EXPECT_THAT(again.err, HasSubstr("exists"));
      }
      if (fs::exists(fs::path(target) / "project.json")) continue;  // it is the project's from now on
      for (const auto& [name, content] : contents())
        std::ofstream(name.empty() ? fs::path(target) : fs::path(target) / name) << "mine";
      const auto mine = contents();
      const Said refused = beam(words);
      EXPECT_EQ(refused.code, 2) << refused.err;
      EXPECT_EQ(contents(), mine);
    }
  }
}

TEST_F(CommandTable, AStopEndsItWith75AndTheSameCallWorksAfterwardsOrSaysWhatToDo) {
  for (const Call& call : allCommands()) {
    SCOPED_TRACE(call.name);
    const Running run(folder_.path(), wordsOf(call));
    run.awaitHandlerOf(SIGTERM);
    run.signal(SIGTERM);
    const Said said = run.wait();
    EXPECT_THAT(said.code, AnyOf(0, 75)) << said.err;
    if (said.code == 75) {
      EXPECT_THAT(said.err, HasSubstr("interrupted"));
    }
    const Said again = beam(wordsOf(call));
    EXPECT_THAT(again.code, AnyOf(0, 2)) << again.err;
    if (again.code == 2) {
      EXPECT_THAT(said.err + again.err, AnyOf(HasSubstr("remove it"), HasSubstr("exists")));
    }
  }
}

TEST_F(CommandTable, JsonIsWhatStandardOutputHolds) {
  int with_json = 0;
  for (const Call& call : allCommands()) {
    if (!call.flag("--json")) continue;
    SCOPED_TRACE(call.name);
    ++with_json;
    const Said said = beam(wordsOf(call) + Words{"--json"});
    EXPECT_EQ(said.code, 0) << said.err;
    if (Json::accept(said.out)) continue;
    std::istringstream lines(said.out);
    for (std::string line; std::getline(lines, line);) EXPECT_TRUE(Json::accept(line)) << line;
  }
  EXPECT_GE(with_json, 6);
}

// The paths of what a JSON holds, as `beam help json` writes them: "stages[].id".
void addPaths(const Json& value, const std::string& path, std::set<std::string>& paths) {
  if (value.is_object()) {
    for (const auto& [name, below] : value.items())
      addPaths(below, path.empty() ? name : path + "." + name, paths);
  } else if (value.is_array()) {
    for (const Json& below : value) addPaths(below, path + "[]", paths);
  } else {
    paths.insert(path);
  }
}

// Whether `path` is of the form, in which "*" is any name.
bool isOfForm(const std::string& path, const std::string& form) {
  std::string pattern;
  for (const char c : form) {
    if (c == '*')
      pattern += "[^\\[\\]]+";
    else if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
      pattern += c;
    else
      pattern += std::string("\\") + c;
  }
  return std::regex_match(path, std::regex(pattern));
}

TEST_F(CommandTable, EveryKeyOfJsonIsDocumented) {
  const Json& told = helpOfProgram()["json"];
  for (const Call& call : allCommands()) {
    if (!call.flag("--json") || call.name == "help") continue;
    std::vector<std::pair<std::string, Words>> calls = {{call.name, wordsOf(call)}};
    if (call.flag("--dry-run") && call.name == "run")
      calls.push_back({"run --dry-run", wordsOf(call) + Words{"--dry-run"}});
    if (call.name == "evaluate") calls[0].second = calls[0].second + Words{"--ground-truth", at("CAPTURE")};
    if (call.name == "stages") calls[0].second.push_back(at("Take.beam"));
    for (const auto& [name, words] : calls) {
      SCOPED_TRACE(name);
      const Json& forms = told.at(name == "process" ? "run" : name);
      const Said said = beam(words + Words{"--json"});
      ASSERT_EQ(said.code, 0) << said.err;
      std::set<std::string> paths;
      if (Json::accept(said.out)) {
        addPaths(Json::parse(said.out), "", paths);
      } else {
        std::istringstream lines(said.out);
        for (std::string line; std::getline(lines, line);) addPaths(Json::parse(line), "", paths);
      }
      EXPECT_GT(paths.size(), 3u);
      for (const std::string& path : paths) {
        if (path == "written_by.program") continue;
        const bool documented = std::any_of(forms.items().begin(), forms.items().end(),
                                            [&](const auto& form) { return isOfForm(path, form.key()); });
        EXPECT_TRUE(documented) << path << " is not in beam help json";
      }
    }
  }
}

}  // namespace
}  // namespace beam::testing
