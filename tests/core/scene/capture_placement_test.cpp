// SPDX-License-Identifier: Apache-2.0
#include "core/scene/capture_placement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "core/base/error.h"
#include "core/scene/transform.h"
#include "tests/support/sphere_capture.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;

SubjectMeasure tall(double height, dvec3 foot = dvec3(0)) {
  SubjectMeasure m;
  m.subject = SubjectBox{foot - dvec3(0.25 * height, 0, 0.25 * height),
                         foot + dvec3(0.25 * height, height, 0.25 * height)};
  m.focus = RigFocus{foot + dvec3(0, 0.5 * height, 0), foot + dvec3(0, 0.6 * height, 0), 1.6 * height};
  return m;
}

SubjectMeasure seenFrom(double distance, dvec3 point = dvec3(0)) {
  SubjectMeasure m;
  m.focus = RigFocus{point, point, distance};
  return m;
}

CapturePlacement placed(const SubjectMeasure& m, UnitHints hints = {}, UpAxis up = UpAxis::PlusY) {
  return placementOf(m, hints, up);
}

TEST(UnitRule, AHeightOf30CentimetresToFourMetresIsMetresExactly) {
  for (const double height : {0.3, 0.9, 1.75, 2.4, 4.0}) EXPECT_EQ(unitOfHeight(height), 1) << height;
  for (const double height : {std::nextafter(0.3, 0.0), std::nextafter(4.0, 5.0)})
    EXPECT_NE(unitOfHeight(height), 1) << height;
}

TEST(UnitRule, OtherwiseTheUnitInWhichItIsAPerson) {
  for (const auto& [height, unit_m] : std::vector<std::pair<double, double>>{{1712, 0.001},
                                                                             {1200, 0.001},
                                                                             {2400, 0.001},
                                                                             {120, 0.01},
                                                                             {240, 0.01},
                                                                             {47.3, 0.0254},
                                                                             {94, 0.0254},
                                                                             {5.7, 0.3048},
                                                                             {7.8, 0.3048}}) {
    EXPECT_EQ(unitOfHeight(height), unit_m) << height;
  }
}

TEST(UnitRule, OtherwiseItIsScaledToAPerson) {
  for (const double height : {0.035, 0.29, 10.0, 30.0, 100.0, 119.0, 241.0, 1100.0, 2500.0, 1e6})
    EXPECT_DOUBLE_EQ(unitOfHeight(height) * height, 1.75) << height;
}

TEST(UnitRule, WhatIsGivenGoesBeforeTheDescriptionAndThatBeforeTheHeight) {
  const SubjectMeasure m = tall(1712);
  EXPECT_EQ(placed(m, {0.5, 0.01}).unit_m, 0.5);
  EXPECT_EQ(placed(m, {0.5, 0.01}).from, UnitFrom::Given);
  EXPECT_EQ(placed(m, {{}, 0.01}).unit_m, 0.01);
  EXPECT_EQ(placed(m, {{}, 0.01}).from, UnitFrom::Description);
  EXPECT_EQ(placed(m).unit_m, 0.001);
  EXPECT_EQ(placed(m).from, UnitFrom::Height);
  EXPECT_EQ(placed(m).height, 1712);
}

TEST(UnitRule, WithoutMasksOnlyCamerasOutOfEveryRangeScale) {
  for (const double distance : {0.3, 3.0, 30.0}) {
    EXPECT_EQ(placed(seenFrom(distance)).unit_m, 1);
    EXPECT_EQ(placed(seenFrom(distance)).from, UnitFrom::Convention);
  }
  for (const double distance : {0.29, 31.0, 2700.0}) {
    const CapturePlacement p = placed(seenFrom(distance));
    EXPECT_DOUBLE_EQ(p.unit_m * distance, 3);
    EXPECT_THAT(doubtsOf(p, "take"),
                ::testing::ElementsAre(
                    ::testing::AllOf(HasSubstr("\"take\""), HasSubstr("--unit"), HasSubstr("scaled to 3"))));
  }
  EXPECT_EQ(placed({}).unit_m, 1) << "nothing is known";
}

TEST(UnitRule, ANamedUnitThatMakesNoPersonIsKeptAndDoubted) {
  const CapturePlacement p = placed(tall(1712), {{}, 1.0});
  EXPECT_EQ(p.unit_m, 1);
  EXPECT_THAT(doubtsOf(p, "take"), ::testing::ElementsAre(::testing::AllOf(HasSubstr("1,712 m in metres"),
                                                                           HasSubstr("fit millimetres"))));
  EXPECT_THAT(doubtsOf(placed(tall(1712), {1.0, {}}), "take"),
              ::testing::ElementsAre(HasSubstr("--unit says")));
  EXPECT_THAT(doubtsOf(placed(tall(1.7), {{}, 1.0}), "take"), ::testing::IsEmpty());
  EXPECT_THAT(doubtsOf(placed(tall(1712)), "take"), ::testing::IsEmpty());
}

TEST(OriginRule, StaysExactlyWhereItIsUnlessTheSubjectIsFar) {
  EXPECT_EQ(placed(tall(1.7, {9, 0, 0})).origin, dvec3(0));
  EXPECT_EQ(placed(tall(1700, {9000, 0, 0})).origin, dvec3(0)) << "9 m away";
  EXPECT_TRUE(isTurn(worldFromCapture(UpAxis::PlusZ, placed(tall(1.7, {9, 0, 0})))));
  EXPECT_EQ(placed(tall(1.7, {210, 0, 3})).origin, dvec3(210, 0, 3)) << "where it stands";
  EXPECT_EQ(placed(seenFrom(3, {0, 210, 3})).origin, dvec3(0, 210, 3));
  SubjectMeasure looks_far = seenFrom(3, {0, 210, 3});
  looks_far.focus->middle = dvec3(0);
  EXPECT_EQ(placed(looks_far).origin, dvec3(0)) << "the cameras are near";
}

TEST(OriginRule, IsKeptInTheCapturesOwnAxesAndLiesAtZeroOfTheWorld) {
  const CapturePlacement p = placed(tall(1712, {210000, 500, -3000}), {}, UpAxis::PlusZ);
  EXPECT_EQ(p.origin, dvec3(-3000, 210000, 500)) << "x = z, y = x, z = y of the world";
  const Similarity3 s = worldFromCapture(UpAxis::PlusZ, p);
  EXPECT_LT(glm::length(s * p.origin), 1e-12);
  EXPECT_LT(glm::length(s * (p.origin + dvec3(0, 0, 1712)) - dvec3(0, 1.712, 0)), 1e-12) << "up";
}

TEST(Units, AreNamedByTheirWordsOrAsMetres) {
  EXPECT_EQ(unitNamed("mm"), 0.001);
  EXPECT_EQ(unitNamed("metre"), 1);
  EXPECT_EQ(unitNamed("feet"), 0.3048);
  EXPECT_EQ(unitNamed("0.35"), 0.35);
  for (const char* bad : {"", "parsec", "0", "-1", "nan", "inf", "1e300", "1 m", "M"})
    EXPECT_EQ(unitNamed(bad), std::nullopt) << bad;
  EXPECT_EQ(nameOfUnit(0.001), "millimetres");
  EXPECT_EQ(nameOfUnit(0.35), "units of 0.35 m");
  EXPECT_EQ(toText(placed(tall(1712.2))), "the subject is 1,712 units tall: taken as millimetres");
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(parseUnitFrom(toText(static_cast<UnitFrom>(i))), static_cast<UnitFrom>(i));
  EXPECT_THROW(parseUnitFrom("hearsay"), Error);
}

TEST(Units, APlacementThatIsNoSizeIsRefused) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  EXPECT_NO_THROW(validate(CapturePlacement{}));
  EXPECT_THROW(validate(CapturePlacement{.unit_m = 0}), Error);
  EXPECT_THROW(validate(CapturePlacement{.unit_m = kInfinite}), Error);
  EXPECT_THROW(validate(CapturePlacement{.origin = {0, kInfinite, 0}}), Error);
  EXPECT_THROW(validate(CapturePlacement{.height = -1}), Error);
}

// The masks of a sphere, from cameras around it.
class SphereFrames final : public FrameSource {
 public:
  explicit SphereFrames(std::vector<FrameView> views) : views_(std::move(views)) {}
  bool has(ViewIndex, FrameIndex) const override { return true; }
  Image<u8vec3> photo(ViewIndex v, FrameIndex) const override { return at(v).photo; }
  Image<std::uint8_t> mask(ViewIndex v, FrameIndex frame) const override {
    if (frame.value == 0) return Image<std::uint8_t>(at(v).mask.width, at(v).mask.height);
    return at(v).mask;
  }

 private:
  const FrameView& at(ViewIndex v) const { return views_[static_cast<std::size_t>(v.value)]; }
  std::vector<FrameView> views_;
};

// The sphere of 0.3 m radius at (0, 1, 0), of which the first frame's masks are empty.
CaptureSet sphereCapture(MaskKind masks = MaskKind::Files) {
  std::vector<FrameView> views = photographs({.cameras = 8, .size_px = 128});
  CaptureSet set;
  set.frames = {"0", "1"};
  set.masks = masks;
  for (const FrameView& v : views) set.views.push_back({v.name, v.camera});
  for (int i = 0; i < 400; ++i) {  // Fibonacci sphere
    const float z = 1 - (2 * i + 1.0f) / 400, r = std::sqrt(1 - z * z), phi = 2.39996323f * i;
    set.seed_points.position_m.push_back(vec3(0, 1, 0) +
                                         0.29f * vec3(r * std::cos(phi), r * std::sin(phi), z));
  }
  set.source = std::make_shared<SphereFrames>(std::move(views));
  return set;
}

TEST(MeasureSubject, FindsAHeightInTheFirstFrameThatHasMasks) {
  const SubjectMeasure m = measureSubject(sphereCapture());
  ASSERT_TRUE(m.subject);
  EXPECT_NEAR(m.subject->high.y - m.subject->low.y, 0.6, 0.06);
  EXPECT_LT(glm::length(0.5 * (m.subject->low + m.subject->high) - dvec3(0, 1, 0)), 0.05);
  ASSERT_TRUE(m.seeds);
  EXPECT_GT(m.seeds->share, 0.8);
  EXPECT_EQ(m.seeds->factor, 1);
}

TEST(MeasureSubject, IsTheSameInEveryUnitAndFromEveryOrigin) {
  const SubjectMeasure one = measureSubject(sphereCapture());
  ASSERT_TRUE(one.subject);
  for (const double scale : {0.02, 1000.0}) {
    const Similarity3 s{dmat3(1.0), scale, scale * dvec3(210, 5, -30)};
    const SubjectMeasure m = measureSubject(transformed(sphereCapture(), s));
    ASSERT_TRUE(m.subject) << scale;
    EXPECT_LT(glm::length(m.subject->low - s * one.subject->low), 1e-6 * scale);
    EXPECT_LT(glm::length(m.subject->high - s * one.subject->high), 1e-6 * scale);
    EXPECT_NEAR(m.focus->distance_m / scale, one.focus->distance_m, 1e-6);
  }
}

TEST(MeasureSubject, WithoutMasksKnowsOnlyWhatTheCamerasLookAt) {
  const SubjectMeasure m = measureSubject(sphereCapture(MaskKind::None));
  EXPECT_FALSE(m.subject);
  ASSERT_TRUE(m.focus);
  EXPECT_LT(glm::length(m.focus->point - dvec3(0, 1, 0)), 1e-9);
}

TEST(MeasureSubject, NamesTheFactorOfSeedPointsInAnotherUnit) {
  for (const double factor : {0.001, 0.01, 0.0254, 0.1, 0.3048, 10.0, 1000.0}) {
    CaptureSet set = sphereCapture();
    set.seed_points = transformed(set.seed_points, {dmat3(1.0), 1 / factor});
    const SubjectMeasure m = measureSubject(set);
    ASSERT_TRUE(m.seeds);
    EXPECT_LT(m.seeds->share, 0.02);
    EXPECT_NEAR(m.seeds->factor, factor, 1e-12);
  }
}

TEST(MeasureSubject, SeedPointsOfAnotherPlaceHaveNoFactor) {
  CaptureSet set = sphereCapture();
  for (vec3& p : set.seed_points.position_m) p = vec3(p.y, 0.1f * p.x, 0.2f * p.z);
  const SubjectMeasure m = measureSubject(set);
  ASSERT_TRUE(m.seeds);
  EXPECT_LT(m.seeds->share, 0.02);
  EXPECT_EQ(m.seeds->factor, 1) << "made small they would all lie in the body, as one speck";
}

TEST(RigFocus, ParallelCamerasAndThoseThatLookAwayLookAtNothing) {
  std::vector<Camera> parallel, outwards;
  for (int i = 0; i < 4; ++i) {
    parallel.push_back(cameraLookingAt({0.1 * i, 1, 0}, {0.1 * i, 1, 3}, 64, 80));
    const dvec3 at(std::cos(1.5 * i), 1, std::sin(1.5 * i));
    outwards.push_back(cameraLookingAt(at, 3.0 * at - dvec3(0, 2, 0), 64, 80));
  }
  EXPECT_FALSE(focusOf(parallel));
  EXPECT_FALSE(focusOf(outwards));
}

}  // namespace
}  // namespace beam::testing
