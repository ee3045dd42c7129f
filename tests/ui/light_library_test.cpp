// SPDX-License-Identifier: Apache-2.0
// The panoramas one can light with: what is in the list, what is chosen, and what of it is there.
#include "ui/light_library.h"

#include <gtest/gtest.h>

#include "core/io/file.h"
#include "core/io/image_file.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using testing::TempDir;
using testing::waitFor;

// A library whose panoramas are told apart by their radiance, and what it said.
class Library : public ::testing::Test {
 protected:
  Library() {
    QObject::connect(&lights, &LightLibrary::entriesChanged, &lights, [this] { ++lists; });
    QObject::connect(&lights, &LightLibrary::failed, &lights,
                     [this](const QString& what, const QString& why) { failures << what + ": " + why; });
    for (int i = 1; i <= 3; ++i) writeSky(i, static_cast<float>(i));
    writeFileAtomically(bad(), "no panorama");
  }
  fs::path sky(int i) const { return folder / ("sky" + std::to_string(i) + ".exr"); }
  void writeSky(int i, float radiance) const {
    writeExr(sky(i), Planes(16, 8, 3, radiance), {"R", "G", "B"}, ExrPrecision::Float);
  }
  fs::path bad() const { return folder / "bad.exr"; }
  bool settle() {
    return waitFor([this] { return lights.settled(); });
  }
  // The radiance of the light that is there; 0: none.
  float shining() const { return lights.light() ? radianceFrom(*lights.light(), vec3(0, 0, 1)).x : 0; }
  QStringList names() const {
    QStringList out;
    for (const LightEntry& e : lights.entries()) out << e.name;
    return out;
  }

  TempDir folder;
  LightLibrary lights;
  int lists = 0;
  QStringList failures;
};

TEST_F(Library, IsEmptyAndAtRestBeforeACaptureIsOpen) {
  EXPECT_EQ(lights.chosen(), -1);
  EXPECT_TRUE(lights.name().isEmpty());
  EXPECT_TRUE(lights.entries().empty());
  EXPECT_TRUE(lights.settled());
  EXPECT_FALSE(lights.reading());
  EXPECT_EQ(shining(), 0);
}

TEST_F(Library, StartsWithTheDomeOfTheCaptureAndAnewWithTheNextCapture) {
  lights.reset(sky(1));
  EXPECT_EQ(lights.chosen(), 0);
  EXPECT_EQ(lights.name(), "Dome of the capture");
  ASSERT_TRUE(settle());
  EXPECT_FLOAT_EQ(shining(), 1);
  lights.add(sky(2));
  lights.reset(sky(3));
  EXPECT_EQ(names(), QStringList{"Dome of the capture"});
  ASSERT_TRUE(settle());
  EXPECT_FLOAT_EQ(shining(), 3);
  writeSky(3, 9);
  lights.reset(sky(3));
  ASSERT_TRUE(settle());
  EXPECT_FLOAT_EQ(shining(), 9) << "what the file holds now";
  lights.reset({});
  EXPECT_EQ(lights.chosen(), -1);
  EXPECT_TRUE(lights.entries().empty());
  EXPECT_TRUE(lights.settled());
}

TEST_F(Library, TakesAFileOnceUnderItsNameAndChoosesIt) {
  lights.reset(sky(1));
  lights.add(sky(2));
  lights.add(sky(3));
  EXPECT_EQ(names(), QStringList({"Dome of the capture", "sky2", "sky3"}));
  EXPECT_EQ(lights.name(), "sky3");
  const int before = lists;
  lights.add(sky(2));
  EXPECT_EQ(lights.entries().size(), 3u);
  EXPECT_EQ(lists, before) << "the list is the same";
  EXPECT_EQ(lights.chosen(), 1);
  ASSERT_TRUE(settle());
  EXPECT_FLOAT_EQ(shining(), 2);
  EXPECT_TRUE(failures.isEmpty());
}

TEST_F(Library, GivesTheLightThatWasChosenLastHoweverFastOneChooses) {
  lights.reset(sky(1));
  for (int round = 0; round < 5; ++round) {
    for (int i = 2; i <= 3; ++i) lights.add(sky(i));
    lights.choose(0);
    lights.choose(1);
  }
  ASSERT_TRUE(settle());
  EXPECT_EQ(lights.chosen(), 1);
  EXPECT_FLOAT_EQ(shining(), 2);
}

TEST_F(Library, KeepsWhatWasPreparedAndHasItAtOnce) {
  lights.reset(sky(1));
  ASSERT_TRUE(settle());
  const auto dome = lights.light();
  lights.add(sky(2));
  EXPECT_TRUE(lights.reading());
  EXPECT_EQ(lights.light(), nullptr) << "not the one before under another name";
  ASSERT_TRUE(settle());
  int heard = 0;
  QObject::connect(&lights, &LightLibrary::lightChanged, &lights, [&] { ++heard; });
  lights.choose(0);
  EXPECT_FALSE(lights.reading());
  EXPECT_EQ(lights.light(), dome);
  EXPECT_EQ(heard, 1);
}

TEST_F(Library, CanBeToldToLightWithNothing) {
  lights.reset(sky(1));
  ASSERT_TRUE(settle());
  lights.choose(-1);
  EXPECT_TRUE(lights.settled());
  EXPECT_EQ(lights.light(), nullptr);
  EXPECT_TRUE(lights.name().isEmpty());
  EXPECT_EQ(lights.entries().size(), 1u) << "it can be chosen again";
}

TEST_F(Library, OfOneThatCannotBeReadSaysWhyAndGoesBackToTheLastThatCould) {
  lights.reset(sky(1));
  ASSERT_TRUE(settle());
  lights.add(sky(2));
  ASSERT_TRUE(settle());
  lights.add(bad());
  EXPECT_EQ(names().back(), "bad");
  ASSERT_TRUE(settle());
  ASSERT_EQ(failures.size(), 1);
  EXPECT_TRUE(failures[0].contains("bad.exr")) << failures[0].toStdString();
  EXPECT_EQ(names(), QStringList({"Dome of the capture", "sky2"}));
  EXPECT_EQ(lights.name(), "sky2");
  EXPECT_FLOAT_EQ(shining(), 2);
}

TEST_F(Library, OfADomeThatCannotBeReadHasNoLight) {
  lights.reset(bad());
  ASSERT_TRUE(settle());
  EXPECT_EQ(failures.size(), 1);
  EXPECT_EQ(lights.chosen(), -1);
  EXPECT_TRUE(lights.entries().empty());
  EXPECT_EQ(lights.light(), nullptr);
  lights.add(sky(3));
  ASSERT_TRUE(settle());
  EXPECT_FLOAT_EQ(shining(), 3);
}

TEST_F(Library, SaysNothingOfABadOneThatIsNotWantedAnyMore) {
  lights.reset(sky(1));
  ASSERT_TRUE(settle());
  lights.add(bad());
  lights.choose(0);
  EXPECT_FALSE(waitFor([this] { return !failures.isEmpty(); }, 300));
  EXPECT_EQ(names(), QStringList({"Dome of the capture", "bad"}));
  EXPECT_FLOAT_EQ(shining(), 1);
  lights.choose(1);
  ASSERT_TRUE(settle());
  EXPECT_EQ(failures.size(), 1) << "wanted again, it is told";
}

TEST(LibraryThatGoes, WhileItReadsTakesNobodyWithIt) {
  const TempDir folder;
  writeExr(folder / "sky.exr", Planes(256, 128, 3, 1.0f), {"R", "G", "B"}, ExrPrecision::Float);
  for (int i = 0; i < 3; ++i) {
    LightLibrary lights;
    lights.reset(folder / "sky.exr");
  }
  QApplication::processEvents();
}

}  // namespace
}  // namespace beam
