// SPDX-License-Identifier: Apache-2.0
// What a shell offers for a beginning of a line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/app/help_support.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

class Completion : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(typed(folder_.path(), "beam completion bash > beam.bash").code, 0); }

  // What bash offers for the words, the last of which is begun.
  Words offered(const Words& line) const {
    std::string words;
    for (const std::string& word : line) words += " '" + word + "'";
    const Said said = typed(folder_.path(), "source ./beam.bash && COMP_WORDS=(" + words +
                                                ") COMP_CWORD=" + std::to_string(line.size() - 1) +
                                                " && _beam && printf '%s\\n' \"${COMPREPLY[@]}\"");
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_EQ(said.err, "");
    std::istringstream in(said.out);
    Words found;
    for (std::string word; std::getline(in, word);)
      if (!word.empty()) found.push_back(word);
    return found;
  }
  TempDir folder_;
};

TEST_F(Completion, OfBashIsAScriptThatBashTakes) {
  const Said said = typed(folder_.path(), "bash -n beam.bash && source ./beam.bash && complete -p beam");
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_EQ(said.out, "complete -F _beam beam\n");
}

TEST_F(Completion, OffersCommandsFlagsAndWords) {
  EXPECT_THAT(offered({"beam", "ru"}), ElementsAre("run"));
  EXPECT_THAT(offered({"beam", "run", "--pre"}), ElementsAre("--preset"));
  EXPECT_THAT(offered({"beam", "run", "P", "--preset", "dr"}), ElementsAre("draft"));
  EXPECT_THAT(offered({"beam", "run", "P", "--preset", "=", "st"}), ElementsAre("standard"));
  EXPECT_THAT(offered({"beam", "run", "P", "--preset", "="}),
              UnorderedElementsAre("draft", "standard", "paper"));
  EXPECT_THAT(offered({"beam", "render", "P", "--frame-of", "w"}), ElementsAre("world"));
  EXPECT_THAT(offered({"beam", "render", "P", "--channels", "rgb,no"}), ElementsAre("rgb,normal"));
  EXPECT_THAT(offered({"beam", "help", "exit"}), ElementsAre("exit-codes"));
  EXPECT_THAT(offered({"beam", "completion", ""}), UnorderedElementsAre("bash", "zsh"));
  EXPECT_THAT(offered({"beam", "run", "P", "--frames", ""}), ElementsAre());
}

TEST_F(Completion, OffersKeysOfSettings) {
  EXPECT_THAT(offered({"beam", "run", "P", "--unset", "surface.iter"}), ElementsAre("surface.iterations"));
  EXPECT_THAT(offered({"beam", "run", "P", "--set", "surface.iter"}), ElementsAre("surface.iterations="));
  EXPECT_THAT(typed(folder_.path(), "beam help run").out, Not(::testing::HasSubstr("surface.cap")));
}

TEST_F(Completion, OffersEveryCommandAndFlag) {
  for (const auto& command : helpOfProgram().at("commands")) {
    std::istringstream in(command.at("command").get<std::string>());
    Words words;
    for (std::string word; in >> word;) words.push_back(word);
    if (words.size() == 2) {
      EXPECT_THAT(offered({"beam", words[1]}), Contains(words[1]));
    }
    const Words flags = offered(words + Words{"-"});
    for (const auto& flag : command.at("flags"))
      EXPECT_THAT(flags, Contains(flag.at("names").back().get<std::string>())) << command.at("command");
    EXPECT_THAT(flags, Contains("--quiet")) << command.at("command");
  }
}

TEST_F(Completion, OffersFilesWhereTheyAreAskedFor) {
  fs::create_directory(folder_.path() / "Take.beam");
  std::ofstream(folder_.path() / "Tall.exr") << "";
  EXPECT_THAT(offered({"beam", "run", "Ta"}), ElementsAre("Take.beam"));
  EXPECT_THAT(offered({"beam", "render", "P", "--out", "Ta"}), ElementsAre("Take.beam"));
  EXPECT_THAT(offered({"beam", "render", "P", "--environment", "Ta"}), Contains("Tall.exr"));
  EXPECT_THAT(offered({"beam", "check", "Ta"}), UnorderedElementsAre("Take.beam", "Tall.exr"));
}

TEST_F(Completion, OfZshIsAScriptThatZshTakes) {
  ASSERT_EQ(typed(folder_.path(), "beam completion zsh > _beam").code, 0);
  EXPECT_THAT(textOf(folder_.path() / "_beam"), ::testing::StartsWith("#compdef beam\n"));
  if (typed(folder_.path(), "command -v zsh").code != 0)
    GTEST_SKIP() << "zsh is not installed: its script is not tried";
  // zsh itself takes the words that do not begin as typed away.
  std::ofstream(folder_.path() / "try.zsh") << R"(
compdef() { print "$@" }
compadd() { print -- "$@" }
source ./_beam
words=(beam run P --preset dr) CURRENT=5
_beam
words=(beam ru) CURRENT=2
_beam
)";
  const Said said = typed(folder_.path(), "zsh -n _beam && zsh -f try.zsh");
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, ::testing::StartsWith("_beam beam\n-- draft standard paper\n-- process new run "));
}

TEST(CompletionOfAnotherShell, IsRefused) {
  const TempDir folder;
  const Said said = Running(folder.path(), {"completion", "fish"}).wait();
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, ::testing::HasSubstr("beam completion: SHELL expects bash, zsh, found \"fish\""));
}

}  // namespace
}  // namespace beam::testing
