// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/core/pipeline/fake_pipeline.h"

namespace beam::testing {
namespace {

using Keys = std::map<StepId, Digest>;

Keys keysOf(const Project& project, FrameIndex frame = FrameIndex{0}) {
  Keys keys;
  for (const StepId& step : {"capture.import"_step, "light.import"_step, "surface.seed"_step,
                             "surface.fit"_step, "surface.refine"_step, "materials.bake"_step}) {
    keys[step] = project.key(step, frame);
  }
  return keys;
}

// Steps whose keys differ.
std::vector<StepId> changedSteps(const Keys& a, const Keys& b) {
  std::vector<StepId> changed;
  for (const auto& [step, key] : a) {
    if (key != b.at(step)) changed.push_back(step);
  }
  return changed;
}

class KeyLaw : public ::testing::Test {
 protected:
  FakeHouse house_;
  Project project_ = house_.newProject();
  Keys before_ = keysOf(project_);
  std::vector<StepId> changedBy(std::string_view key, const FieldValue& value) {
    project_.set(key, value);
    return changedSteps(before_, keysOf(project_));
  }
};

TEST_F(KeyLaw, SpeedOnlyFieldsVoidNothing) { EXPECT_TRUE(changedBy("surface.batch", 7).empty()); }

TEST_F(KeyLaw, AValueEqualToTheDefaultVoidsNothing) {
  EXPECT_TRUE(changedBy("surface.iterations", 10).empty());
  EXPECT_TRUE(changedBy("surface.refine.normal_weight", 0.03).empty());
}

TEST_F(KeyLaw, AResultFieldVoidsItsStageAndWhatFollows) {
  EXPECT_EQ(changedBy("surface.iterations", 20),
            (std::vector<StepId>{"materials.bake"_step, "surface.fit"_step, "surface.refine"_step,
                                 "surface.seed"_step}));
}

TEST_F(KeyLaw, AFieldOfAStepsGroupLeavesEarlierStepsAlone) {
  EXPECT_EQ(changedBy("surface.refine.normal_weight", 0.1),
            (std::vector<StepId>{"materials.bake"_step, "surface.refine"_step}));
}

TEST_F(KeyLaw, AFieldOfAnEarlierStageVoidsOnlyWhatReadsIt) {
  EXPECT_EQ(changedBy("light.iterations", 20),
            (std::vector<StepId>{"light.import"_step, "materials.bake"_step}));
}

TEST_F(KeyLaw, GoingBackFindsTheOldKey) {
  changedBy("surface.iterations", 20);
  EXPECT_TRUE(changedBy("surface.iterations", 10).empty());
}

TEST_F(KeyLaw, APresetThatSaysTheSameAsASettingGivesTheSameKey) {
  project_.set("surface.iterations", 3);
  const Keys by_setting = keysOf(project_);
  project_.reset("surface.iterations");
  project_.setPreset("draft");
  EXPECT_EQ(keysOf(project_), by_setting);
}

TEST_F(KeyLaw, APictureVoidsItsOwnFrameOnly) {
  const Keys other_before = keysOf(project_, FrameIndex{1});
  house_.frames->changed[{2, 0}] = 99;
  EXPECT_EQ(changedSteps(before_, keysOf(project_)),
            (std::vector<StepId>{"materials.bake"_step, "surface.fit"_step, "surface.refine"_step,
                                 "surface.seed"_step}));
  EXPECT_EQ(keysOf(project_, FrameIndex{1}), other_before);
}

TEST_F(KeyLaw, WhereMasksAreVoidsWhatReadsPictures) {
  house_.masks = MaskKind::Alpha;
  EXPECT_EQ(changedSteps(before_, keysOf(house_.open())),
            (std::vector<StepId>{"materials.bake"_step, "surface.fit"_step, "surface.refine"_step,
                                 "surface.seed"_step}));
}

// The step of that name of a house whose stages say so.
Digest keyWith(MaskKind masks, int version, int unmasked_version) {
  std::vector<StageInfo> stages = fakeStages();
  stages[2].steps[2].version = version;
  stages[2].steps[2].unmasked_version = unmasked_version;
  FakeHouse house(stages);
  house.masks = masks;
  return house.newProject().key("surface.refine"_step, FrameIndex{0});
}

TEST(KeyVersion, OfCapturesWithoutMasksVoidsThemAlone) {
  for (const MaskKind masks : {MaskKind::Files, MaskKind::Alpha, MaskKind::Key})
    EXPECT_EQ(keyWith(masks, 1, 1), keyWith(masks, 1, 0));
  EXPECT_NE(keyWith(MaskKind::None, 1, 1), keyWith(MaskKind::None, 1, 0));
  // Whichever is raised, none of before is taken for it.
  EXPECT_NE(keyWith(MaskKind::None, 2, 1), keyWith(MaskKind::None, 1, 1));
  EXPECT_NE(keyWith(MaskKind::Files, 2, 1), keyWith(MaskKind::Files, 1, 1));
}

TEST_F(KeyLaw, ThePanoramaVoidsMaterialsOnly) {
  std::ofstream(house_.root() / "light.hdr") << "other light";
  EXPECT_EQ(changedSteps(before_, keysOf(house_.open())),
            (std::vector<StepId>{"light.import"_step, "materials.bake"_step}));
}

TEST_F(KeyLaw, HeldOutCamerasVoidSurface) {
  project_.setHoldOut({"top"});
  EXPECT_EQ(changedSteps(before_, keysOf(project_)).size(), 5u);
}

TEST_F(KeyLaw, HeldOutPicturesEnterNoKey) {
  project_.setHoldOut({"top"});
  const Keys held = keysOf(project_);
  house_.frames->changed[{2, 0}] = 99;  // of "top"
  EXPECT_EQ(keysOf(project_), held);
}

TEST_F(KeyLaw, NamesPathsAndFurtherFramesEnterNoKey) {
  std::filesystem::rename(house_.root() / "p.beam", house_.root() / "other.beam");
  std::filesystem::rename(house_.root() / "light.hdr", house_.root() / "moved.hdr");
  Project moved = house_.open("other.beam");
  moved.setEnvironment(house_.root() / "moved.hdr");
  house_.frame_names.push_back("003");
  EXPECT_EQ(keysOf(moved), before_);
}

// A byte more and no result of before is found again.
TEST(KeyText, IsWhatItAlwaysWas) {
  const Digest pictures = digestOf("p"), seed = digestOf("s"), before = digestOf("b"), track = digestOf("t");
  const KeyIngredients made{"surface.fit"_step,
                            2,
                            {{"surface.cap", "9"}},
                            {{"pictures", pictures}},
                            {{"surface.seed"_step, seed}, {"capture.import"_step, track}},
                            {{"surface.refine"_step, before}},
                            true};
  EXPECT_EQ(canonicalText(made),
            "step surface.fit\nversion 2\nlater\nparameter surface.cap 1:9\ninput pictures " +
                pictures.hex() + "\nresult capture.import " + track.hex() +
                "\nresult previous surface.refine " + before.hex() + "\nresult surface.seed " + seed.hex() +
                "\n");
}

TEST(KeyText, ListsThatReadAlikeDiffer) {
  KeyIngredients a{"s.t"_step, 1, {{"x", "1\nparameter y 1:2"}}, {}, {}};
  KeyIngredients b{"s.t"_step, 1, {{"x", "1"}, {"y", "2"}}, {}, {}};
  EXPECT_NE(keyOf(a), keyOf(b));
  b.version = 2;
  EXPECT_NE(keyOf(b), keyOf({"s.t"_step, 1, {{"x", "1"}, {"y", "2"}}, {}, {}}));
}

}  // namespace
}  // namespace beam::testing
