// SPDX-License-Identifier: Apache-2.0
// What holds of a cloud and its materials, and that the first one that breaks it is named.
#include "core/scene/gaussian_cloud.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "core/base/error.h"
#include "core/scene/pose.h"

namespace beam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::size_t kCount = 9;
const float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

GaussianCloud goodCloud() {
  GaussianCloud c;
  for (std::size_t i = 0; i < kCount; ++i) {
    c.position_m.emplace_back(i, 1, -2);
    c.rotation.push_back(glm::normalize(quat(1, 0.1f * static_cast<float>(i), 0.5f, 0)));
    c.scale_m.emplace_back(0.01f, 0.02f, 0.001f);
    c.opacity.push_back(0.5f);
  }
  c.color = ShBlock(kCount, 3);
  return c;
}

Materials goodMaterials() {
  Materials m;
  m.roughness.assign(kCount, 0.6f);
  m.base_color = ShBlock(kCount, 3);
  m.ambient_occlusion = ShBlock(kCount, 1);
  return m;
}

template <class Call>
std::string refusalOf(Call&& call) {
  try {
    call();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::Data);
    return e.what();
  }
  ADD_FAILURE() << "expected a refusal";
  return "";
}

// Spoils two of nine: the first one is named.
void expectFirstNamed(const char* expected, const std::function<void(GaussianCloud&, std::size_t)>& spoil) {
  GaussianCloud c = goodCloud();
  spoil(c, 7);
  spoil(c, 4);
  EXPECT_THAT(refusalOf([&] { validate(c); }), AllOf(StartsWith("Gaussian 4: "), HasSubstr(expected)));
}

TEST(ValidCloud, IsAnyThatHoldsWhatItPromisesAlsoAnEmptyOne) {
  EXPECT_NO_THROW(validate(goodCloud()));
  EXPECT_NO_THROW(validate(GaussianCloud()));
  EXPECT_NO_THROW(validate(goodMaterials(), goodCloud()));
}

TEST(ValidCloud, NamesTheFirstGaussianThatIsWrong) {
  for (const float bad : {kNan, kInf, -kInf}) {
    expectFirstNamed("position", [=](GaussianCloud& c, std::size_t i) { c.position_m[i].y = bad; });
    expectFirstNamed("colour coefficient", [=](GaussianCloud& c, std::size_t i) { c.color.of(i)[47] = bad; });
  }
  for (const float bad : {kNan, kInf, 0.0f, -1.0f})
    expectFirstNamed("scales", [=](GaussianCloud& c, std::size_t i) { c.scale_m[i].z = bad; });
  for (const float bad : {kNan, 0.0f, 1.0f, -0.5f, 2.0f})
    expectFirstNamed("opacity", [=](GaussianCloud& c, std::size_t i) { c.opacity[i] = bad; });
  for (const float bad : {kNan, 0.0f, 1.01f})
    expectFirstNamed("quaternion", [=](GaussianCloud& c, std::size_t i) { c.rotation[i] *= bad; });
}

TEST(ValidCloud, HasArraysOfOneLength) {
  const auto refused = [](const char* what, const std::function<void(GaussianCloud&)>& spoil) {
    GaussianCloud c = goodCloud();
    spoil(c);
    EXPECT_THAT(refusalOf([&] { validate(c); }), HasSubstr(what));
  };
  refused("9 rotations, found 8", [](GaussianCloud& c) { c.rotation.pop_back(); });
  refused("9 scales, found 10", [](GaussianCloud& c) { c.scale_m.emplace_back(1); });
  refused("9 opacities, found 0", [](GaussianCloud& c) { c.opacity.clear(); });
  refused("432 colour coefficients, found 431", [](GaussianCloud& c) { c.color.coefficients.pop_back(); });
}

TEST(ValidMaterials, NameTheFirstGaussianThatIsWrong) {
  const auto refused = [](const char* what, const std::function<void(Materials&, std::size_t)>& spoil) {
    Materials m = goodMaterials();
    spoil(m, 7);
    spoil(m, 4);
    EXPECT_THAT(refusalOf([&] { validate(m, goodCloud()); }),
                AllOf(StartsWith("Gaussian 4: "), HasSubstr(what)));
  };
  for (const float bad : {kNan, 0.039f, 1.001f})
    refused("roughness", [=](Materials& m, std::size_t i) { m.roughness[i] = bad; });
  refused("base-colour", [](Materials& m, std::size_t i) { m.base_color.of(i)[0] = kNan; });
  refused("ambient-occlusion", [](Materials& m, std::size_t i) { m.ambient_occlusion.of(i)[15] = kInf; });
  Materials short_by_one = goodMaterials();
  short_by_one.ambient_occlusion.coefficients.pop_back();
  EXPECT_THAT(refusalOf([&] { validate(short_by_one, goodCloud()); }), HasSubstr("144"));
}

TEST(Pose, TakenFromACloudAndSetAgainChangesNothingAndMakesUnits) {
  GaussianCloud c = goodCloud();
  Pose pose = poseOf(c);
  ASSERT_EQ(pose.size(), kCount);
  for (quat& q : pose.rotation) q *= 3.0f;
  const std::vector<quat> before = c.rotation;
  setPose(c, pose);
  EXPECT_EQ(c.position_m, goodCloud().position_m);
  for (std::size_t i = 0; i < kCount; ++i) EXPECT_NEAR(glm::dot(c.rotation[i], before[i]), 1, 1e-6);
  EXPECT_NO_THROW(validate(c));
}

}  // namespace
}  // namespace beam
