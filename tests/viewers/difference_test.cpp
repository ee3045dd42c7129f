// SPDX-License-Identifier: Apache-2.0
// Laws of the difference of two pictures.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/math/color.h"
#include "viewers/image/difference.h"

namespace beam {
namespace {

Picture colours(int w, int h, vec3 value, Encoding encoding = Encoding::Srgb) {
  Image<vec3> image(w, h, value, encoding);
  return pictureOf(image, "colours");
}

Picture numbers(std::vector<float> values, std::string unit, bool false_color = true) {
  Image<float> image(static_cast<int>(values.size()), 1);
  image.pixels = std::move(values);
  Picture p = pictureOf(image, "numbers");
  p.unit = std::move(unit);
  p.false_color = false_color;
  return p;
}

Picture directions(std::vector<vec3> values) {
  Image<vec3> image(static_cast<int>(values.size()), 1);
  image.pixels = std::move(values);
  return pictureOf(image, "normals");
}

// Values that differ from pixel to pixel and channel to channel.
Picture uneven(float seed) {
  Picture p = colours(8, 6, vec3(0));
  for (std::size_t i = 0; i < p.values.values.size(); ++i)
    p.values.values[i] = 0.5f + 0.4f * std::sin(seed * static_cast<float>(i + 1));
  return p;
}

TEST(Difference, OfAPictureWithItselfIsNothing) {
  const Difference d = differenceOf(uneven(1.3f), uneven(1.3f));
  EXPECT_TRUE(d.identical);
  EXPECT_FALSE(d.psnr_db);
  EXPECT_EQ(d.mean, 0);
  EXPECT_EQ(describe(d), "identical · over all pixels, 48 pixels");
  const Limits limits = limitsOf(d);
  EXPECT_GT(limits.high, limits.low);
}

TEST(Difference, OfAKnownOffsetHasItsDecibels) {
  const Difference d = differenceOf(colours(10, 10, vec3(0.5f)), colours(10, 10, vec3(0.6f)));
  ASSERT_TRUE(d.psnr_db);
  EXPECT_NEAR(*d.psnr_db, 20, 1e-4);  // 10 log10(1 / 0.1^2)
  EXPECT_NEAR(d.mean, 0.1, 1e-6);
  EXPECT_EQ(describe(d), "PSNR 20.00 dB · mean 0.1 · over all pixels, 100 pixels");
  const Difference one_channel =
      differenceOf(colours(10, 10, vec3(0.5f)), colours(10, 10, vec3(0.5f, 0.5f, 0.8f)));
  EXPECT_NEAR(one_channel.mean, 0.1, 1e-6) << "the mean of the channels";
  EXPECT_NEAR(*one_channel.psnr_db, -10 * std::log10(0.09 / 3), 1e-4) << "of all channels";
}

TEST(Difference, IsTheSameWhenAAndBAreSwapped) {
  const Difference ab = differenceOf(uneven(1.3f), uneven(0.7f)),
                   ba = differenceOf(uneven(0.7f), uneven(1.3f));
  EXPECT_EQ(ab.map.values.values, ba.map.values.values);
  EXPECT_EQ(ab.psnr_db, ba.psnr_db);
  EXPECT_EQ(ab.mean, ba.mean);
  const Difference near = differenceOf(directions({vec3(0, 1, 0)}), directions({vec3(0, 0.8f, 0.6f)}));
  const Difference far = differenceOf(directions({vec3(0, 0.8f, 0.6f)}), directions({vec3(0, 1, 0)}));
  EXPECT_EQ(near.map.values.values, far.map.values.values);
}

TEST(Difference, ComparesLightAndPhotographsAsTheyAreSeen) {
  const float encoded = 0.5f;
  const Difference d = differenceOf(colours(4, 4, vec3(encoded)),
                                    colours(4, 4, vec3(linearFromSrgb(encoded)), Encoding::Linear));
  EXPECT_LT(d.mean, 1e-6);
  const Difference over = differenceOf(colours(4, 4, vec3(1)), colours(4, 4, vec3(7), Encoding::Linear));
  EXPECT_LT(over.mean, 1e-6) << "both are white on the screen";
}

TEST(Difference, OfDirectionsIsTheAngleInDegrees) {
  const Difference d =
      differenceOf(directions({vec3(0, 1, 0), vec3(0, 1, 0), vec3(0), vec3(1, 0, 0)}),
                   directions({vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(-1, 0, 0)}));
  EXPECT_EQ(d.map.unit, "°");
  EXPECT_EQ(d.map.values.values[0], 0);
  EXPECT_NEAR(d.map.values.values[1], 90, 1e-4);
  EXPECT_TRUE(std::isnan(d.map.values.values[2])) << "one of the two has nothing there";
  EXPECT_NEAR(d.map.values.values[3], 180, 1e-4);
  EXPECT_EQ(d.pixels, 3u);
  EXPECT_NEAR(d.mean, 90, 1e-4);
  EXPECT_FALSE(d.psnr_db);
  EXPECT_EQ(describe(d), "mean 90° · over all pixels, 3 pixels");
}

TEST(Difference, OfNumbersKeepsTheirUnitAndLeavesOutWhereOneHasNothing) {
  const Difference d = differenceOf(numbers({2.0f, 0, 3.0f}, "m"), numbers({2.5f, 4, 3.0f}, "m"));
  EXPECT_EQ(d.pixels, 2u);
  EXPECT_NEAR(d.mean, 0.25, 1e-6);
  EXPECT_FALSE(d.psnr_db) << "metres have no peak";
  EXPECT_EQ(describe(d), "mean 0.25 m · over all pixels, 2 pixels");
  const Difference shares = differenceOf(numbers({0, 0.5f}, "", false), numbers({0, 0.6f}, "", false));
  EXPECT_EQ(shares.pixels, 2u) << "none is a share, too";
  EXPECT_NEAR(*shares.psnr_db, -10 * std::log10(0.01 / 2), 1e-3);
}

TEST(Difference, CountsThePixelsOfTheMaskAloneAndSaysSo) {
  Picture b = colours(2, 1, vec3(0.5f));
  for (int c = 0; c < 3; ++c) b.values.plane(c)[1] = 1;
  Image<std::uint8_t> mask(2, 1, 255);
  mask.pixels[1] = 100;
  const Difference d = differenceOf(colours(2, 1, vec3(0.4f)), b, mask);
  EXPECT_EQ(d.pixels, 1u);
  EXPECT_NEAR(*d.psnr_db, 20, 1e-4);
  EXPECT_NEAR(limitsOf(d).high, 0.1f, 1e-3f);
  EXPECT_EQ(describe(d), "PSNR 20.00 dB · mean 0.1 · over the mask, 1 pixel");
  const Image<u8vec4> whole = displayed(differenceOf(colours(2, 1, vec3(0.4f)), b), {0, 1});
  const Image<u8vec4> masked = displayed(d, {0, 1});
  EXPECT_EQ(masked.pixels[0], whole.pixels[0]);
  EXPECT_LT(luma(u8vec3(masked.pixels[1])), luma(u8vec3(whole.pixels[1]))) << "what does not count is darker";
  mask.pixels.assign(2, 0);
  EXPECT_EQ(describe(differenceOf(colours(2, 1, vec3(0.4f)), b, mask)), "no pixel to compare in the mask");
}

TEST(Difference, ShowsEqualPixelsInTheLowestColourNotAsNothing) {
  const Difference d = differenceOf(colours(1, 1, vec3(0.4f)), colours(1, 1, vec3(0.4f)));
  EXPECT_EQ(u8vec3(displayed(d, {0, 1}).pixels[0]), falseColor(0.0f));
}

TEST(Difference, SaysWhyTwoPicturesCannotBeCompared) {
  EXPECT_EQ(incomparable(colours(4, 3, vec3(0)), colours(4, 3, vec3(1))), "");
  const std::string sizes = incomparable(colours(4, 3, vec3(0)), colours(8, 6, vec3(0)));
  EXPECT_NE(sizes.find("A is 4 x 3 pixels and B 8 x 6"), std::string::npos) << sizes;
  const std::string kinds = incomparable(colours(1, 1, vec3(0)), numbers({1}, "m"));
  EXPECT_NE(kinds.find("A shows colour and B a number in m"), std::string::npos) << kinds;
  EXPECT_NE(incomparable(numbers({1}, "m"), numbers({1}, "weight")), "");
  EXPECT_NE(incomparable(directions({vec3(0)}), colours(1, 1, vec3(0))), "");
  EXPECT_THROW(differenceOf(colours(4, 3, vec3(0)), colours(8, 6, vec3(0))), Error);
  EXPECT_THROW(differenceOf(colours(4, 3, vec3(0)), colours(4, 3, vec3(0)), Image<std::uint8_t>(2, 2, 255)),
               Error);
}

}  // namespace
}  // namespace beam
