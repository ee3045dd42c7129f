// SPDX-License-Identifier: Apache-2.0
// The help as a newcomer reads it: it is there for everything, fits a terminal, and its examples do what they
// say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>

#include "core/scene/channel.h"
#include "tests/app/help_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// Words of a command: "beam help run" -> help, run.
Words wordsOf(const std::string& line) {
  std::istringstream in(line);
  Words words;
  for (std::string word; in >> word;)
    if (word != "beam") words.push_back(word);
  return words;
}

Said beam(const Words& words) {
  const TempDir scratch;
  return Running(scratch.path(), words).wait();
}

std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::size_t lettersOf(const std::string& line) {
  return static_cast<std::size_t>(
      std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

// As one line.
std::string flat(const std::string& text) { return std::regex_replace(text, std::regex("\\s+"), " "); }

void expectNarrow(const std::string& text) {
  for (const std::string& line : linesOf(text)) EXPECT_LE(lettersOf(line), 80u) << line;
}

void expectUsage(const Words& words, const std::string& sentence) {
  const Said said = beam(words);
  EXPECT_EQ(said.code, 2);
  EXPECT_EQ(said.out, "");
  EXPECT_THAT(said.err, HasSubstr("error: " + sentence));
}

TEST(Help, OfEveryCommandIsEnoughAlone) {
  for (const json& command : helpOfProgram().at("commands")) {
    const std::string path = command.at("command");
    SCOPED_TRACE(path);
    const Words words = wordsOf(path);
    const Said said = beam(words + Words{"--help"});
    EXPECT_EQ(said.code, 0);
    EXPECT_EQ(said.err, "");
    expectNarrow(said.out);
    EXPECT_THAT(said.out,
                AllOf(HasSubstr("Usage: " + path), HasSubstr("\nFlags:\n"), HasSubstr("\nExamples:\n")));
    EXPECT_GE(command.at("examples").size(), 2u) << "give it examples in app/cli/examples.cpp";
    EXPECT_EQ(beam(Words{"help"} + words).out, said.out);
  }
}

TEST(Help, NamesAValueByWhatItIs) {
  const std::set<std::string> lower = {"VALUE", "TEXT", "INT", "UINT", "FLOAT", "BOOLEAN"};
  for (const json& command : helpOfProgram().at("commands")) {
    for (const json& flag : command.at("flags")) {
      EXPECT_EQ(lower.count(flag.value("type", "")), 0u) << command.at("command") << " " << flag.at("names");
      EXPECT_NE(flag.at("help"), "") << command.at("command") << " " << flag.at("names");
    }
  }
}

TEST(Help, ShowsDefaultsRangesAndWords) {
  const std::string run = flat(beam({"run", "--help"}).out), render = flat(beam({"render", "--help"}).out);
  EXPECT_THAT(run, AllOf(HasSubstr("--frames LIST"), HasSubstr("default: all"), HasSubstr("0 to 4096"),
                         HasSubstr("draft, standard, paper"), HasSubstr("--quiet")));
  EXPECT_THAT(render, AllOf(HasSubstr("default: test"), HasSubstr("--out FOLDER"), HasSubstr("required"),
                            HasSubstr("base_color")));
}

TEST(Help, ListsCommandsOneALine) {
  const std::vector<std::string> lines = linesOf(beam({"help", "--list"}).out);
  EXPECT_EQ(lines.size() + 1, helpOfProgram().at("commands").size());
  EXPECT_THAT(lines, ::testing::Contains("beam run"));
}

TEST(Help, OfEveryTopicFitsATerminal) {
  for (const json& topic : helpOfProgram().at("topics")) {
    SCOPED_TRACE(topic.at("topic"));
    const Said said = beam({"help", topic.at("topic")});
    EXPECT_EQ(said.code, 0);
    expectNarrow(said.out);
    EXPECT_THAT(beam({"help"}).out, HasSubstr(topic.at("summary")));
  }
  EXPECT_EQ(beam({"help"}).out, beam({"--help"}).out);
}

TEST(Help, OfSeveralIsThatOfEach) {
  EXPECT_EQ(beam({"help", "render", "files"}).out,
            beam({"help", "render"}).out + "\n" + beam({"help", "files"}).out);
  expectUsage({"help", "render", "exprot"},
              "beam help: there is no topic or command \"exprot\"; did you mean \"export\"?");
  expectUsage({"help", "render", "--list"}, "beam help: --list is of everything");
}

TEST(Help, AsJsonOfACommandIsOfThatAlone) {
  const json run = json::parse(beam({"help", "run", "--json"}).out);
  ASSERT_EQ(run.at("commands").size(), 1u);
  EXPECT_EQ(run["commands"][0].at("command"), "beam run");
  EXPECT_TRUE(run.at("topics").empty());
  EXPECT_EQ(run.at("json").size(), 2u) << "of run and of run --dry-run";
  const json frames = json::parse(beam({"help", "frames", "--json"}).out);
  EXPECT_TRUE(frames.at("commands").empty());
  EXPECT_EQ(frames["topics"].at(0).at("text").get<std::string>() + "\n", beam({"help", "frames"}).out);
}

TEST(Help, OfCapturesNamesWhatLiesInOneAndIsNamedWhereOneIsAskedFor) {
  const std::string text = beam({"help", "captures"}).out;
  const TempDir dir;
  for (const auto& entry : fs::directory_iterator(SampleHouse::capture())) {
    const std::string name = entry.path().filename().string();
    if (name != "gt") {
      EXPECT_THAT(text, HasSubstr(name));
    }
  }
  for (const Words& words : std::vector<Words>{
           {"new", "--help"}, {"process", "--help"}, {"check", dir.path().string()}, {"help"}}) {
    const Said said = beam(words);
    EXPECT_THAT(flat(said.out + said.err),
                ::testing::ContainsRegex("beam help captures|captures +what the folder"));
  }
}

TEST(Help, OfFilesNamesWhatAProjectHolds) {
  const std::string text = beam({"help", "files"}).out;
  for (const auto& entry : fs::directory_iterator(SolvedHouse::project()))
    EXPECT_THAT(text, HasSubstr(entry.path().filename().string()));
  EXPECT_THAT(flat(text), Not(HasSubstr("what the window told")));
}

TEST(Help, OfFilesNamesEveryChannel) {
  const std::string text = beam({"help", "files"}).out;
  for (const std::string& id : channelIds()) EXPECT_THAT(text, HasSubstr("  " + id));
}

TEST(Help, OfExitCodesIsWhatTheProgramEndsWith) {
  const std::string text = beam({"help", "exit-codes"}).out;
  for (const char* code : {"0", "2", "10", "65", "69", "70", "71", "73", "74", "75"})
    EXPECT_THAT(text, HasSubstr(std::string("\n  ") + code + " "));
}

TEST(Help, OfTheEnvironmentNamesEveryVariableThatIsRead) {
  const std::string text = beam({"help", "environment"}).out;
  const std::regex read("getenv\\(\"([A-Z_]+)\"\\)");
  for (const char* folder : {"app/cli", "core"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(BEAM_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".cpp") continue;
      const std::string source = textOf(entry.path());
      for (std::sregex_iterator i(source.begin(), source.end(), read), end; i != end; ++i)
        EXPECT_THAT(text, HasSubstr((*i)[1].str())) << entry.path();
    }
  }
}

TEST(Help, OfWhatIsNotThereSaysWhatIs) {
  expectUsage({"help", "file"}, "beam help: there is no topic or command \"file\"; did you mean \"files\"?");
  expectUsage({"help", "weather"}, "beam help: there is no topic or command \"weather\"");
  EXPECT_THAT(beam({"help", "weather"}).err, AllOf(HasSubstr("exit-codes"), Not(HasSubstr("did you mean"))));
}

TEST(Help, IsThePageThatIsInTheRepository) {
  EXPECT_EQ(beam({"help", "--markdown"}).out, textOf(fs::path(BEAM_SOURCE_DIR) / "resources/command-line.md"))
      << "the help has changed; in the source folder: build/release/bin/beam help --markdown > "
         "resources/command-line.md";
}

TEST(Words, ThatAreUnknownAreToldWithTheSimilarOneOrNone) {
  expectUsage({"rnu"}, "beam: there is no command \"rnu\"; did you mean \"run\"? See beam --help");
  expectUsage({"run", "x", "--frame", "0"},
              "beam run: there is no flag \"--frame\"; did you mean \"--frames\"? See beam run --help");
  expectUsage({"run", "--frames=0", "--fames=0"},
              "beam run: there is no flag \"--fames\"; did you mean \"--frames\"? See beam run --help");
  expectUsage({"run", "x", "--wobble"}, "beam run: there is no flag \"--wobble\". See beam run --help");
  expectUsage({"frobnicate"}, "beam: there is no command \"frobnicate\"; there are process, new, run");
  expectUsage({"status", "x", "y"}, "beam status: \"y\" is a word too many. See beam status --help");
}

TEST(Words, ThatPeopleTypeForACommandNameIt) {
  expectUsage({"import", "x"}, "beam: there is no command \"import\"; did you mean beam new or beam check?");
  expectUsage(
      {"relight", "x", "--out", "y"},
      "beam: there is no command \"relight\"; did you mean beam render --channels relight --environment");
  expectUsage({"Train"}, "beam: there is no command \"Train\"; did you mean beam run?");
  const std::string commands = beam({"help", "--list"}).out + "\n";
  for (const char* word : {"convert", "view", "gc", "info", "eval", "validate", "config", "demo", "man"}) {
    const std::string err = beam({word}).err;
    std::smatch meant;
    ASSERT_TRUE(std::regex_search(err, meant, std::regex("did you mean (beam [a-z]+|beam-studio)"))) << err;
    if (meant[1] != "beam-studio") {
      EXPECT_THAT(commands, HasSubstr(meant[1].str() + "\n"));
    }
    EXPECT_THAT(commands, Not(HasSubstr(std::string("beam ") + word + "\n"))) << "it is a command by now";
  }
}

TEST(Words, BehindTwoDashesAFlagIsToldWhereItBelongs) {
  expectUsage({"run", "--", "x", "--dry-run"},
              "beam run: \"--dry-run\" stands behind \"--\", where nothing is taken for a flag");
}

TEST(Words, ThatAreHalfANumberAreRefused) {
  const TempDir dir;
  for (const char* size : {"16x16x16", "16x17abc", "x16", "16", "16 x 16", "+16x16", "16x"})
    expectUsage({"sample", (dir / "s").string(), "--size", size}, "--size expects WIDTHxHEIGHT");
  EXPECT_FALSE(fs::exists(dir / "s"));
}

TEST(Words, ThatAreMissingOrWrongAreToldAsSentences) {
  expectUsage({"run"}, "beam run: PROJECT is missing (Project folder). See beam run --help");
  expectUsage({"render", "x"}, "beam render: --out FOLDER is missing (Folder for the pictures). See");
  expectUsage({"run", "x", "--until"}, "beam run: --until needs a value, STAGE. See");
  expectUsage({"run", "x", "--every", "two"}, "beam run: --every expects 1 ");
  expectUsage({"run", "x", "--threads", "9999"},
              "beam run: --threads expects 0 to 4096, found \"9999\". See");
  expectUsage(
      {"run", "x", "--preset", "drift"},
      "beam run: --preset expects draft, standard, paper, found \"drift\"; did you mean \"draft\"? See");
  expectUsage({"render", "x", "--out", "y", "--channels", "rgb,norm"}, "beam render: --channels expects ");
  expectUsage({"run", "x", "--stage", "surface", "--until", "surface"}, "beam run: --");
}

TEST(Version, IsACommandAndAFlag) {
  const std::string version = beam({"version"}).out;
  EXPECT_THAT(version, ::testing::MatchesRegex("beam 0\\.[0-9.]+\n"));
  EXPECT_EQ(beam({"--version"}).out, version);
  EXPECT_EQ(beam({"-V"}).out, version);
  const std::string verbose = beam({"version", "--verbose"}).out;
  EXPECT_THAT(verbose, AllOf(HasSubstr(version), HasSubstr("device:"), HasSubstr("resources:")));
  EXPECT_EQ(beam({"--version", "--verbose"}).out, verbose);
}

class Examples : public ::testing::Test {
 protected:
  static void expectDone(const fs::path& folder, const std::string& line) {
    const Said said = typed(folder, line, ExampleHouse::get().bin());
    EXPECT_EQ(said.code, 0) << line << "\n" << said.err;
  }
  // The line alone, in a folder of its own; what it makes is not there before.
  static void tryOut(const std::string& line) {
    const TempDir folder;
    ExampleHouse::get().copyInto(folder.path());
    if (line.starts_with("beam new ")) fs::remove_all(folder.path() / "Take.beam");
    if (line.starts_with("beam sample ")) fs::remove(folder.path() / "CAPTURE");
    expectDone(folder.path(), line);
  }
};

TEST_F(Examples, OfTheHelpWorkAsTyped) {
  for (const json& command : helpOfProgram().at("commands"))
    for (const json& example : command.at("examples")) tryOut(example.at("line"));
}

TEST_F(Examples, OfTheReadmeWorkAsTyped) {
  const TempDir folder;
  ExampleHouse::get().copyInto(folder.path());
  bool inside = false;
  int tried = 0;
  for (const std::string& line : linesOf(textOf(fs::path(BEAM_SOURCE_DIR) / "README.md"))) {
    if (line.starts_with("```")) inside = !inside;
    if (!inside || !line.starts_with("beam ")) continue;
    expectDone(folder.path(), line);
    ++tried;
  }
  EXPECT_GE(tried, 5);
}

}  // namespace
}  // namespace beam::testing
