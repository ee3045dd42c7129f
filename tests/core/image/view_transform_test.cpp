// SPDX-License-Identifier: Apache-2.0
// View transforms: ends, order, hue, and the numbers of the neutral one's specification.
#include "core/image/view_transform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/math/color.h"
#include "tests/support/message_of.h"

namespace beam::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ViewTransform, LeavesBlackGrowsWithLightAndEndsAtWhite) {
  for (const std::string& name : viewTransforms()) {
    const ViewTransform shown = viewTransformOf(name);
    EXPECT_EQ(shown(vec3(0)), vec3(0)) << name;
    float before = 0;
    for (float light = 0.01f; light < 50; light *= 1.1f) {
      const vec3 c = shown(vec3(light));
      EXPECT_GE(c.x, before) << name << " " << light;
      EXPECT_LE(c.x, 1) << name << " " << light;
      EXPECT_NEAR(c.x, c.y, 1e-6f) << name;  // grey stays grey
      EXPECT_NEAR(c.x, c.z, 1e-6f) << name;
      before = c.x;
    }
    EXPECT_GT(before, 0.99f) << name;
  }
}

TEST(ViewTransform, StandardIsTheCurveClipped) {
  const ViewTransform shown = viewTransformOf("standard");
  EXPECT_FLOAT_EQ(shown(vec3(0.18f)).x, srgbFromLinear(0.18f));
  const vec3 clipped = shown(vec3(4, 0.5f, 0));
  EXPECT_FLOAT_EQ(clipped.x, 1);
  EXPECT_FLOAT_EQ(clipped.y, srgbFromLinear(0.5f));
  EXPECT_EQ(clipped.z, 0);
}

// Under the start of compression a base colour loses the 0.04 that a dielectric reflects, and nothing else.
TEST(ViewTransform, NeutralKeepsBaseColoursAndFadesHighlights) {
  const ViewTransform shown = viewTransformOf("neutral");
  for (const vec3& c : {vec3(0.5f, 0.3f, 0.1f), vec3(0.7f, 0.6f, 0.08f)}) {
    const vec3 expected = srgbFromLinear(c - 0.04f);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(shown(c)[k], expected[k], 1e-5f);
  }
  const vec3 dim = shown(vec3(1, 0.1f, 0.1f)), bright = shown(vec3(40, 4, 4));
  EXPECT_GT(bright.y, dim.y + 0.2f);
  EXPECT_GT(bright.x, bright.y - 1e-6f);
}

TEST(ViewTransform, NamesThoseThatAreDrawn) {
  EXPECT_THAT(messageOf(Error::Kind::Usage, [] { viewTransformOf("agx"); }),
              AllOf(HasSubstr("\"agx\" is not drawn"), HasSubstr("standard, neutral")));
}

}  // namespace
}  // namespace beam::testing
