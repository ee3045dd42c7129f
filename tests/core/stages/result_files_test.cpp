// SPDX-License-Identifier: Apache-2.0
// Files of results that are no files of ours: named, with what to do about them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/stages/score_files.h"
#include "core/stages/screening_file.h"
#include "core/stages/track_files.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

template <class Read>
std::string refusal(Read&& read) {
  try {
    read();
  } catch (const Error& e) {
    return e.what();
  }
  return "taken";
}

TEST(ResultFiles, OfAnotherKindAreNamedWithWhatToDo) {
  const TempDir result;
  for (const char* file : {"track.json", "scores.json", "screening.json"})
    writeFileAtomically(result / file, "{}");
  const auto toDo = [&](const char* file) {
    return AllOf(HasSubstr((result / file).string()),
                 HasSubstr("delete the folder \"" + result.path().string() + "\" and run again"));
  };
  EXPECT_THAT(refusal([&] { readTrackNote(result.path()); }), toDo("track.json"));
  EXPECT_THAT(refusal([&] { readScores(result.path()); }), toDo("scores.json"));
  EXPECT_THAT(refusal([&] { readScreening(result.path()); }), toDo("screening.json"));
}

}  // namespace
}  // namespace beam::testing
