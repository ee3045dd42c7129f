// SPDX-License-Identifier: Apache-2.0
// Pictures of looks: what a file holds of light, coverage, exposure and what is behind.
#include "core/stages/look_picture.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/error.h"
#include "core/io/image_file.h"
#include "core/math/color.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 32, kHeight = 24;

// Half of it is covered: light 0.2 of a surface of alpha 0.5.
struct HalfCovered {
  Planes relit{kWidth, kHeight, 3}, alpha{kWidth, kHeight, 1};
  Camera camera{{30, 30, 16, 12}, kWidth, kHeight, {}};

  HalfCovered() {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth / 2; ++x) {
        alpha.plane(0)[y * kWidth + x] = 0.5f;
        for (int c = 0; c < 3; ++c) relit.plane(c)[y * kWidth + x] = 0.1f;
      }
    }
  }
};

class LookPictures : public ::testing::Test {
 protected:
  fs::path written(const Look& look, const Environment* panorama = nullptr) {
    const fs::path file = folder_.path() / fmt::format("{}.{}", ++count_, lookFileExtension(look));
    writeLookPicture(file, lookPicture(view_.relit, view_.alpha, look, {view_.camera, panorama}), {});
    return file;
  }
  TempDir folder_;
  HalfCovered view_;
  int count_ = 0;
};

TEST_F(LookPictures, HasStraightAlphaWhereNothingIsBehind) {
  Look look;
  look.exposure_stops = 1;
  const fs::path file = written(look);
  const Image<u8vec3> photo = readPhoto(file);
  EXPECT_EQ(photo(3, 3), u8vec3(byteOf(srgbFromLinear(0.4f))));
  EXPECT_EQ(photo(30, 3), u8vec3(0));
  const Image<std::uint8_t> alpha = readAlpha(file);
  EXPECT_EQ(alpha(3, 3), 128);
  EXPECT_EQ(alpha(30, 3), 0);
}

TEST_F(LookPictures, StandsBeforeAColour) {
  Look look;
  look.background.kind = "color";
  look.background.color = dvec3(0.4, 0, 0);
  const fs::path file = written(look);
  EXPECT_FALSE(readImageSize(file).has_alpha);
  const Image<u8vec3> photo = readPhoto(file);
  EXPECT_EQ(photo(3, 3),
            u8vec3(byteOf(srgbFromLinear(0.3f)), byteOf(srgbFromLinear(0.1f)), byteOf(srgbFromLinear(0.1f))));
  EXPECT_EQ(photo(30, 3), u8vec3(byteOf(srgbFromLinear(0.4f)), 0, 0));
}

TEST_F(LookPictures, StandsBeforeThePanoramaAsItIsTurned) {
  Image<vec3> sky(64, 32, vec3(0.1f), Encoding::Linear);
  for (int y = 0; y < 32; ++y)
    for (int x = 28; x < 36; ++x) sky(x, y) = vec3(0.5f);  // +Z, which the camera looks along
  const Environment panorama = makeEnvironment(std::move(sky));
  Look look;
  look.lighting.environment.background = true;
  look.lighting.environment.gain = 2;
  EXPECT_EQ(readPhoto(written(look, &panorama))(17, 12), u8vec3(255));
  look.lighting.environment.rotation_deg = 90;
  EXPECT_EQ(readPhoto(written(look, &panorama))(17, 12), u8vec3(byteOf(srgbFromLinear(0.2f))));
}

TEST_F(LookPictures, IsOnBlackInAFilm) {
  Look look;
  EXPECT_EQ(onBlack(lookPicture(view_.relit, view_.alpha, look, {view_.camera}))(3, 3),
            u8vec3(byteOf(srgbFromLinear(0.1f))));
}

TEST_F(LookPictures, IsRawInOpenExr) {
  Look look;
  look.view_transform = kRawTransform;
  look.exposure_stops = -1;
  const fs::path file = written(look);
  EXPECT_EQ(file.extension(), ".exr");
  const Planes p = readExr(file, {"R", "A"});
  EXPECT_NEAR(p.plane(0)[3], 0.05f, 1e-4f);  // premultiplied
  EXPECT_EQ(p.plane(1)[3], 0.5f);
  EXPECT_EQ(p.plane(1)[30], 0);
}

TEST_F(LookPictures, IsFiniteHoweverBrightItsLightIs) {
  Look look;
  look.view_transform = kRawTransform;
  view_.relit.plane(0)[3] = std::numeric_limits<float>::infinity();
  view_.relit.plane(0)[4] = std::numeric_limits<float>::quiet_NaN();
  view_.relit.plane(0)[5] = 1e30f;
  const Planes p = readExr(written(look), {"R"});
  for (int x = 3; x < 6; ++x) EXPECT_EQ(p.plane(0)[x], 65504) << x;
  for (const char* name : {"standard", "neutral"}) {
    look.view_transform = name;
    EXPECT_GT(readPhoto(written(look))(3, 0).x, 250) << name;
  }
}

TEST_F(LookPictures, IsOfAViewTransformThatIsDrawn) {
  Look look;
  look.view_transform = "aces";
  EXPECT_THROW(lookFileExtension(look), Error);
}

}  // namespace
}  // namespace beam::testing
