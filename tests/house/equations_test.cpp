// SPDX-License-Identifier: Apache-2.0
// resources/equations.md against the code: what is cited stands there, what stands there is cited.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/house/sources.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;

// As one line, comment marks taken out: a citation may be broken over two.
std::string flowing(const Source& source) {
  static const std::regex kMark(R"(^\s*(//|#)?\s*)");
  std::string text;
  for (const std::string& line : source.lines) text += std::regex_replace(line, kMark, "") + " ";
  return text;
}

// "2.6-2.7" -> 2.6, 2.7; others as they are.
std::vector<std::string> expanded(const std::string& item) {
  const std::size_t dash = item.find('-');
  if (dash == std::string::npos || item.starts_with("A-")) return {item};
  const auto chapter = [](const std::string& number) { return number.substr(0, number.find('.')); };
  const auto section = [](const std::string& number) {
    return std::stoi(number.substr(number.find('.') + 1));
  };
  const std::string first = item.substr(0, dash), last = item.substr(dash + 1);
  EXPECT_EQ(chapter(first), chapter(last)) << item;
  EXPECT_LT(section(first), section(last)) << item;
  std::vector<std::string> all;
  for (int s = section(first); s <= section(last); ++s)
    all.push_back(chapter(first) + "." + std::to_string(s));
  return all;
}

// Every number that the text cites, as the headings have it: "5.4", "A-19", "eq. 7".
std::set<std::string> citedIn(const std::string& text) {
  static const std::string kItem = R"((?:A-\d+|\d+\.\d+(?:-\d+\.\d+)?))";
  static const std::regex kEntries("[Mm]ethods\\s+(" + kItem + "(?:(?:, | and )" + kItem + ")*)"),
      kOne(kItem), kEquations(R"([Ee]q\.\s+(\d+(?:(?:, | and )\d+)*))"), kNumber(R"(\d+)");
  std::set<std::string> cited;
  const std::sregex_iterator end;
  for (std::sregex_iterator m(text.begin(), text.end(), kEntries); m != end; ++m) {
    const std::string list = (*m)[1];
    for (std::sregex_iterator one(list.begin(), list.end(), kOne); one != end; ++one) {
      for (const std::string& number : expanded(one->str())) cited.insert(number);
    }
  }
  for (std::sregex_iterator m(text.begin(), text.end(), kEquations); m != end; ++m) {
    const std::string list = (*m)[1];
    for (std::sregex_iterator one(list.begin(), list.end(), kNumber); one != end; ++one)
      cited.insert("eq. " + one->str());
  }
  return cited;
}

// By number, with all its lines.
std::map<std::string, std::string> entries() {
  static const std::regex kHeading(R"(^### (eq\. \d+|A-\d+|\d+\.\d+) \S.*)");
  std::map<std::string, std::string> found;
  std::string* entry = nullptr;
  for (const std::string& line : sourceAt(fs::path(BEAM_SOURCE_DIR) / "resources" / "equations.md").lines) {
    std::smatch m;
    if (std::regex_match(line, m, kHeading)) {
      const auto [at, fresh] = found.emplace(m[1], "");
      EXPECT_TRUE(fresh) << line << ": the number stands twice";
      entry = &at->second;
    } else if (line.starts_with('#')) {
      EXPECT_FALSE(line.starts_with("###")) << line << ": expected a number and a title";
      entry = nullptr;
    } else if (entry) {
      *entry += line + "\n";
    }
  }
  return found;
}

// By number: a place that cites it.
std::map<std::string, std::string> citations() {
  std::vector<Source> sources = sourcesIn({"core", "viewers", "ui", "app", "plugins", "tests"});
  for (const char* page : {"README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"})
    sources.push_back(sourceAt(fs::path(BEAM_SOURCE_DIR) / page));
  std::map<std::string, std::string> found;
  for (const Source& source : sources) {
    for (const std::string& number : citedIn(flowing(source))) found.emplace(number, source.path);
  }
  return found;
}

TEST(Equations, ReadAllWaysOfCiting) {
  const Source page{
      "", {"// as of 1.5 (methods 1.2-1.4, A-19 and 2.5,", "//   methods", "// 3.10; eq. 7, 8 and 12)"}};
  EXPECT_EQ(citedIn(flowing(page)),
            (std::set<std::string>{"1.2", "1.3", "1.4", "A-19", "2.5", "3.10", "eq. 7", "eq. 8", "eq. 12"}));
}

TEST(Equations, WhatTheCodeCitesStandsThere) {
  const auto known = entries();
  EXPECT_GT(known.size(), 40u);
  for (const auto& [number, place] : citations())
    EXPECT_TRUE(known.contains(number)) << place << " cites " << number;
}

TEST(Equations, WhatStandsThereIsCited) {
  const auto cited = citations();
  for (const auto& [number, text] : entries()) EXPECT_TRUE(cited.contains(number)) << number;
}

TEST(Equations, EveryEntryNamesItsSource) {
  for (const auto& [number, text] : entries()) {
    const bool of_the_paper = number.starts_with("eq.");
    EXPECT_TRUE(of_the_paper || text.find("\nSource: ") != std::string::npos) << number;
    EXPECT_GT(text.size(), 20u) << number;
  }
}

}  // namespace
}  // namespace beam::testing
