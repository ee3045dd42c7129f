// SPDX-License-Identifier: Apache-2.0
#include "core/image/planes.h"

#include <gtest/gtest.h>

namespace beam {
namespace {

TEST(Planes, OfNumbersAreTheNumbers) {
  Image<float> image(3, 2);
  for (int i = 0; i < 6; ++i) image.pixels[i] = 0.5f * static_cast<float>(i);
  const Planes p = planesOf(image);
  EXPECT_EQ(ivec3(p.width, p.height, p.channels), ivec3(3, 2, 1));
  EXPECT_EQ(p.values, image.pixels);
  EXPECT_TRUE(planesOf(Image<float>()).empty());
}

TEST(Planes, OfVectorsHoldOneAxisEachAndCanBeTurned) {
  Image<vec3> image(4, 3);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) image(x, y) = vec3(x, 10 * y, -1);
  }
  const Planes p = planesOf(image, dmat3(1.0));
  // The columns are where the axes go: x to y, y to z, z to x.
  const Planes turned = planesOf(image, dmat3(dvec3(0, 1, 0), dvec3(0, 0, 1), dvec3(1, 0, 0)));
  EXPECT_EQ(ivec3(p.width, p.height, p.channels), ivec3(4, 3, 3));
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      const std::size_t at = image.index(x, y);
      EXPECT_EQ(vec3(p.plane(0)[at], p.plane(1)[at], p.plane(2)[at]), image(x, y));
      EXPECT_EQ(vec3(turned.plane(1)[at], turned.plane(2)[at], turned.plane(0)[at]), image(x, y));
    }
  }
}

TEST(Image, LiesInRowsFromTheTop) {
  Image<int> image(4, 3);
  image(1, 2) = 7;
  EXPECT_EQ(image.pixels[9], 7);
  EXPECT_EQ(image.index(3, 1), 7u);
  EXPECT_TRUE(Image<int>().empty());
  Planes p(4, 3, 2);
  p.plane(1)[p.planeSize() - 1] = 5;
  EXPECT_EQ(p.values.back(), 5);
}

}  // namespace
}  // namespace beam
