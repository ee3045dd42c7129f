// SPDX-License-Identifier: Apache-2.0
// The image view's judging: difference, figures, limits, and words that stay inside.
#include <gtest/gtest.h>

#include <QKeyEvent>
#include <QPainter>

#include <future>

#include "core/math/color.h"
#include "tests/support/wait_for.h"
#include "viewers/image/image_view.h"

namespace beam {
namespace {

using testing::waitFor;

PictureLoader plain(float value, const std::string& label = "picture") {
  return [=] { return pictureOf(Image<vec3>(40, 30, vec3(value), Encoding::Srgb), label); };
}

PictureLoader depth(float metres) {
  return [=] {
    Image<float> image(40, 30, metres);
    for (int x = 0; x < 20; ++x) image(x, 3) = 2 * metres;
    Picture p = pictureOf(image, "Depth");
    p.false_color = true;
    p.unit = std::string("m");
    return p;
  };
}

class ImageJudging : public ::testing::Test {
 protected:
  ImageJudging() {
    view.resize(400, 300);
    view.show();
  }
  bool settle() {
    return waitFor([this] { return view.settled(); });
  }
  void press(int key) {
    QKeyEvent event(QEvent::KeyPress, key, Qt::NoModifier);
    QApplication::sendEvent(&view, &event);
  }
  QColor middle() { return view.picture().pixelColor(200, 200); }

  ImageView view;
};

TEST_F(ImageJudging, ShowsHowFarAAndBAreApartWithANumberAndALegend) {
  view.setPicture(0, "A", plain(0.5f));
  view.setPicture(1, "B", plain(0.6f));
  ASSERT_TRUE(settle());
  const QColor before = middle();
  EXPECT_FALSE(view.legend().shown);
  press(Qt::Key_D);
  EXPECT_TRUE(view.difference());
  ASSERT_TRUE(settle());
  EXPECT_NE(middle(), before);
  EXPECT_EQ(view.verdict(), "PSNR 20.00 dB · mean 0.1 · over all pixels, 1,200 pixels");
  EXPECT_TRUE(view.legend().shown);
  EXPECT_FALSE(view.words().scale.isEmpty());
  press(Qt::Key_D);
  ASSERT_TRUE(settle());
  EXPECT_EQ(middle(), before);
}

TEST_F(ImageJudging, WipeAndDifferenceTakeTurns) {
  view.setPicture(0, "A", plain(0.2f));
  view.setPicture(1, "B", plain(0.9f));
  press(Qt::Key_W);
  EXPECT_TRUE(view.wipe());
  press(Qt::Key_D);
  EXPECT_TRUE(view.difference());
  EXPECT_FALSE(view.wipe());
  press(Qt::Key_W);
  EXPECT_FALSE(view.difference());
  EXPECT_TRUE(view.wipe());
}

TEST_F(ImageJudging, AnotherPictureTakesTheOldDifferenceAwayAtOnce) {
  view.setPicture(0, "A", plain(0.2f));
  view.setPicture(1, "B", plain(0.9f));
  view.setDifference(true);
  ASSERT_TRUE(settle());
  EXPECT_TRUE(view.verdict().contains("dB"));
  std::promise<void> gate;
  const std::shared_future<void> open = gate.get_future().share();
  view.setPicture(1, "B", [open] {
    open.wait();
    return plain(0.4f)();
  });
  QApplication::processEvents();
  EXPECT_FALSE(view.verdict().contains("dB")) << view.verdict().toStdString();
  EXPECT_FALSE(view.legend().shown);
  gate.set_value();
  ASSERT_TRUE(settle());
  EXPECT_TRUE(view.verdict().contains("dB"));
  view.setPicture(1, "B", plain(0.2f));
  ASSERT_TRUE(settle());
  EXPECT_TRUE(view.verdict().contains("identical"));
}

TEST_F(ImageJudging, SaysWhyThereIsNoDifferenceAndShowsAAlone) {
  view.setPicture(0, "A", plain(0.5f));
  ASSERT_TRUE(settle());
  const QColor a = middle();
  view.setDifference(true);
  EXPECT_TRUE(view.verdict().contains("choose a picture")) << view.verdict().toStdString();
  view.setPicture(1, "B", depth(2));
  ASSERT_TRUE(settle());
  EXPECT_TRUE(view.verdict().contains("of one kind")) << view.verdict().toStdString();
  EXPECT_EQ(middle(), a);
  EXPECT_FALSE(view.words().foot.isEmpty());
  view.setPicture(1, "B", []() -> Picture { throw std::runtime_error("camera C has no photograph"); });
  ASSERT_TRUE(settle());
  EXPECT_TRUE(view.verdict().contains("camera C has no photograph")) << view.verdict().toStdString();
}

TEST_F(ImageJudging, CountsTheMaskOfThePhotographWhicheverSideItIsOn) {
  const PictureLoader photo = [] {
    Picture p = plain(0.5f)();
    p.mask = [] {
      Image<std::uint8_t> mask(40, 30, 0);
      for (int x = 0; x < 40; ++x) mask(x, 0) = 255;
      return mask;
    };
    return p;
  };
  view.setPicture(0, "A", photo);
  view.setPicture(1, "B", plain(0.6f));
  view.setDifference(true);
  ASSERT_TRUE(settle());
  const QString figures = view.verdict();
  EXPECT_TRUE(figures.endsWith("over the mask, 40 pixels")) << figures.toStdString();
  view.swapSides();
  ASSERT_TRUE(settle());
  EXPECT_EQ(view.verdict(), figures);
}

TEST_F(ImageJudging, KeepsLockedLimitsOverOtherPicturesAndLetsThemGo) {
  view.setPicture(0, "A", depth(2));
  ASSERT_TRUE(settle());
  EXPECT_NEAR(view.legend().limits.high, 4, 0.01);
  view.lockLimits(Limits{1, 9});
  ASSERT_TRUE(settle());
  EXPECT_TRUE(view.legend().locked);
  view.setPicture(0, "A", depth(3));
  ASSERT_TRUE(settle());
  EXPECT_EQ(view.legend().limits.low, 1);
  EXPECT_EQ(view.legend().limits.high, 9);
  view.lockLimits({});
  ASSERT_TRUE(settle());
  EXPECT_FALSE(view.legend().locked);
  EXPECT_NEAR(view.legend().limits.high, 6, 0.01);
}

TEST_F(ImageJudging, LockedLimitsOfDifferencesAreNotThoseOfDepths) {
  view.setPicture(0, "A", depth(2));
  view.setPicture(1, "B", depth(3));
  ASSERT_TRUE(settle());
  view.lockLimits(Limits{1, 9});
  view.setDifference(true);
  ASSERT_TRUE(settle());
  EXPECT_FALSE(view.legend().locked);
  EXPECT_EQ(view.legend().limits.low, 0);
  view.lockLimits(Limits{0, 5});
  ASSERT_TRUE(settle());
  const QColor wide = middle();
  view.lockLimits(Limits{0, 1});
  ASSERT_TRUE(settle());
  EXPECT_NE(middle(), wide);
  view.setDifference(false);
  ASSERT_TRUE(settle());
  EXPECT_EQ(view.legend().limits.high, 9);
}

TEST_F(ImageJudging, BTakesTheLimitsOfAWhicheverComesFirst) {
  std::promise<void> gate;
  const std::shared_future<void> open = gate.get_future().share();
  view.setPicture(0, "A", [open] {
    open.wait();
    return depth(2)();
  });
  view.setPicture(1, "B", depth(8));
  QApplication::processEvents();
  gate.set_value();
  ASSERT_TRUE(settle());
  view.setWipe(true);
  const QImage b_under_limits_of_a = view.picture();
  EXPECT_EQ(view.legend().limits.high, 4);
  EXPECT_EQ(QColor(b_under_limits_of_a.pixelColor(300, 200)), [] {
    const u8vec3 top = falseColor(1.0f);
    return QColor(top.x, top.y, top.z);
  }());
}

TEST_F(ImageJudging, ForgetsWhatBelongedToTheProjectBefore) {
  view.setPicture(0, "A", depth(2));
  view.setPicture(1, "B", depth(3));
  view.setDifference(true);
  view.setExposure(2);
  view.setBadge("stale: made with other settings");
  ASSERT_TRUE(settle());
  view.lockLimits(Limits{0, 5});
  view.resetState();
  ASSERT_TRUE(settle());
  EXPECT_FALSE(view.difference());
  EXPECT_EQ(view.exposure(), 0);
  EXPECT_TRUE(view.badge().isEmpty());
  view.setPicture(0, "A", depth(2));
  view.setPicture(1, "B", depth(3));
  view.setDifference(true);
  ASSERT_TRUE(settle());
  EXPECT_FALSE(view.legend().locked);
}

TEST_F(ImageJudging, TheBadgeStandsOverWhatItIsTrueOfAlone) {
  const auto photo = [] { return pictureOf(Image<vec3>(40, 30, vec3(0.4f), Encoding::Srgb), "Photograph"); };
  view.setBadge("stale: made with other settings");
  view.setPicture(0, "A", photo, false);
  view.setPicture(1, "B", photo, true);
  const auto badge = [&] {
    EXPECT_TRUE(settle());
    view.picture();
    return view.words().badge;
  };
  EXPECT_TRUE(badge().isEmpty());
  view.setWipe(true);
  EXPECT_GE(badge().left(), view.width() / 2);
  view.swapSides();
  EXPECT_LE(badge().right(), view.width() / 2);
  EXPECT_FALSE(badge().isEmpty());
  view.setDifference(true);
  EXPECT_FALSE(badge().isEmpty()) << "a difference is of both";
  view.setPicture(0, "A", photo, false);
  EXPECT_TRUE(badge().isEmpty());
}

TEST_F(ImageJudging, KeepsItsWordsInsideANarrowViewWithLargeTypeAndOffTheLegend) {
  QFont large = view.font();
  large.setPointSizeF(1.5 * large.pointSizeF());
  view.setFont(large);
  view.resize(300, 400);
  view.setBadge("stale: made with other settings");
  const auto labelled = [](float value, const char* label) {
    return [=] { return pictureOf(Image<vec3>(40, 30, vec3(value), Encoding::Srgb), label); };
  };
  view.setPicture(
      0, "A", labelled(0.4f, "Photograph · camera a_camera_with_a_very_long_name_of_its_own · frame 000000"));
  view.setPicture(1, "B", labelled(0.5f, "Rendered Radiance · camera C03 · frame 000000"));
  for (const bool difference : {false, true}) {
    view.setDifference(difference);
    view.setWipe(!difference);
    ASSERT_TRUE(settle());
    view.picture();
    const WordBoxes& words = view.words();
    const QRectF inside = view.rect();
    EXPECT_TRUE(inside.contains(words.title)) << difference;
    EXPECT_TRUE(inside.contains(words.badge)) << difference;
    EXPECT_FALSE(words.badge.intersects(words.title)) << difference;
    if (!difference) continue;
    ASSERT_FALSE(words.scale.isEmpty());
    EXPECT_TRUE(inside.contains(words.scale));
    EXPECT_FALSE(words.scale.intersects(words.title));
    EXPECT_FALSE(words.scale.intersects(words.badge));
  }
}

TEST(Labels, BreakBetweenPartsThenBetweenWordsAndElideWhatIsTooLong) {
  const QFontMetricsF metrics{QFont()};
  const auto width = [&](const QString& text) { return metrics.horizontalAdvance(text); };
  EXPECT_EQ(labelLines(metrics, "one · two", 1e6), QStringList("one · two"));
  EXPECT_EQ(labelLines(metrics, "one two · three", width("one two") + 1), QStringList({"one two", "three"}));
  EXPECT_EQ(labelLines(metrics, "one two", width("one") + 1), QStringList({"one", "two"}));
  const QString word(200, 'w');
  for (const QString& line : labelLines(metrics, "a " + word + " b", 80)) EXPECT_LE(width(line), 80);
  EXPECT_TRUE(labelLines(metrics, word, 80).first().contains("…"));
}

TEST(Labels, GiveTheScaleDigitsThatTellItsValuesApart) {
  EXPECT_EQ(scaleText(0.05f, {0, 0.1f}, ""), "0.050");
  EXPECT_EQ(scaleText(2.5f, {2, 4}, "m"), "2.50 m");
  EXPECT_EQ(scaleText(90, {0, 180}, "°"), "90°");
}

TEST(Labels, MessagesStayInsideTheirArea) {
  QImage image(300, 300, QImage::Format_ARGB32);
  image.fill(Qt::black);
  QPainter painter(&image);
  const QRectF area(40, 40, 220, 220);
  paintMessage(painter, area, "A title of a good many words that has to break",
               "And a body of even more words, which tells what happened, what was expected and what to do.");
  painter.end();
  int outside = 0, inside = 0;
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 300; ++x) {
      const bool painted = image.pixelColor(x, y).lightness() > 40;
      (area.contains(QPointF(x, y)) ? inside : outside) += painted;
    }
  }
  EXPECT_EQ(outside, 0);
  EXPECT_GT(inside, 500);
}

}  // namespace
}  // namespace beam
