// SPDX-License-Identifier: Apache-2.0
// What the lanes of the timeline draw: no failed frame is lost however many share a pixel, and every state
// has a shape of its own.
#include <gtest/gtest.h>

#include <QApplication>
#include <QPainter>

#include <set>

#include "ui/theme.h"
#include "ui/timeline_lanes.h"

namespace beam {
namespace {

std::shared_ptr<TakeSurvey> surveyOf(int frames, CellState state) {
  auto survey = std::make_shared<TakeSurvey>();
  for (int f = 0; f < frames; ++f)
    survey->frames.push_back(QString("%1").arg(f, 6, 10, QChar('0')).toStdString());
  const std::vector<std::string> notes(survey->frames.size());
  const std::vector<CellState> cells(survey->frames.size(), state);
  survey->lanes = {{"surface", "Surface", "", cells, notes}, {"materials", "Materials", "", cells, notes}};
  survey->stamps.resize(survey->frames.size());
  return survey;
}

QImage picture(QWidget& widget) {
  QImage image(widget.size(), QImage::Format_RGB32);
  image.fill(Qt::black);
  widget.render(&image);
  return image;
}

// Columns of row `y` that have the colour.
std::set<int> columnsOf(const QImage& image, int y, const QColor& color) {
  std::set<int> columns;
  for (int x = 0; x < image.width(); ++x) {
    if (image.pixelColor(x, y) == color) columns.insert(x);
  }
  return columns;
}

TEST(Lanes, AFailedFrameOfAThousandIsSeenAtEveryPositionAndWidth) {
  constexpr int kFrames = 1000;
  std::vector<LaneShade> shades(kFrames, LaneShade::Done);
  for (const int pixels : {150, 180, 299, 300, 641, 777, 900, 999, 1000, 1001, 1500, 3999}) {
    for (int f = 0; f < kFrames; ++f) {
      shades[f] = LaneShade::Failed;
      const std::vector<LanePiece> pieces = lanePieces(shades, pixels);
      int seen = 0, covered = 0;
      for (const LanePiece& piece : pieces) {
        covered += piece.end - piece.begin;
        if (piece.shade != LaneShade::Failed) continue;
        ++seen;
        EXPECT_LE(piece.begin, (f + 1) * pixels / kFrames);
        EXPECT_GE(piece.end, f * pixels / kFrames);
      }
      EXPECT_EQ(seen, 1) << "frame " << f << " over " << pixels << " pixels";
      EXPECT_EQ(covered, pixels);
      shades[f] = LaneShade::Done;
    }
  }
}

TEST(Lanes, DrawsTheFailedFrameAboveAndBelowItsLane) {
  for (const int width : {300, 450, 637, 900}) {
    TimelineLanes lanes;
    lanes.resize(width, 200);
    for (int f = 0; f < 1000; f += width == 450 ? 1 : 37) {
      auto survey = surveyOf(1000, CellState::Done);
      survey->lanes[0].cells[f] = CellState::Failed;
      lanes.setSurvey(survey);
      lanes.setFrame(f < 500 ? 999 : 0);
      lanes.setRange({0, 999});
      const QImage image = picture(lanes);
      const QRectF box = lanes.laneBox(0);
      for (const double y : {box.top() - 1, box.center().y(), box.bottom() + 1})
        EXPECT_FALSE(columnsOf(image, static_cast<int>(y), colors().failed).empty()) << f << " at " << width;
      EXPECT_TRUE(columnsOf(image, static_cast<int>(lanes.laneBox(1).center().y()), colors().failed).empty());
    }
  }
}

TEST(Lanes, FramesThatAreWideEnoughHaveASeamBetweenThem) {
  const std::vector<LanePiece> pieces =
      lanePieces({LaneShade::Done, LaneShade::Done, LaneShade::Failed, LaneShade::Done}, 40);
  ASSERT_EQ(pieces.size(), 4u);
  EXPECT_EQ(pieces[1], (LanePiece{10, 19, LaneShade::Done}));
  EXPECT_EQ(pieces[2].shade, LaneShade::Failed);
  EXPECT_TRUE(lanePieces({}, 40).empty());
}

// Whether a pixel stands out of the empty lane, without colour: light against dark.
std::vector<bool> silhouette(LaneShade shade, int pixels) {
  QImage image(pixels, 20, QImage::Format_Grayscale8);
  image.fill(colors().inside);
  QPainter p(&image);
  paintLane(p, QRectF(0, 3, pixels, 14), {{0, pixels, shade}}, 1, 2);
  p.end();
  const int ground = qGray(colors().inside.rgb());
  std::vector<bool> shape;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < pixels; ++x) shape.push_back(std::abs(qGray(image.pixel(x, y)) - ground) > 14);
  }
  return shape;
}

TEST(Lanes, StatesDifferByShapeWithoutColour) {
  for (const Theme theme : {Theme::Dark, Theme::Light}) {
    applyTheme(*static_cast<QApplication*>(QCoreApplication::instance()), theme);
    for (const int pixels : {3, 12, 60}) {
      for (int a = 0; a < kLaneShades; ++a) {
        for (int b = a + 1; b < kLaneShades; ++b) {
          const std::vector<bool> one = silhouette(static_cast<LaneShade>(a), pixels),
                                  two = silhouette(static_cast<LaneShade>(b), pixels);
          int different = 0;
          for (std::size_t i = 0; i < one.size(); ++i) different += one[i] != two[i];
          EXPECT_GE(different, 2 * pixels)
              << wordsOf(static_cast<LaneShade>(a)).toStdString() << " and "
              << wordsOf(static_cast<LaneShade>(b)).toStdString() << " over " << pixels << " pixels";
        }
      }
    }
  }
  applyTheme(*static_cast<QApplication*>(QCoreApplication::instance()));
}

TEST(Lanes, TheLegendNamesEveryState) {
  const QString legend = laneLegend(16);
  for (int i = 0; i < kLaneShades; ++i) EXPECT_TRUE(legend.contains(wordsOf(static_cast<LaneShade>(i)))) << i;
  EXPECT_EQ(legend.count("<img"), kLaneShades);
}

TEST(Lanes, GrowWithTheTextAndKeepTheirNamesApartFromTheCells) {
  TimelineLanes lanes;
  lanes.resize(480, 300);
  lanes.setSurvey(surveyOf(10, CellState::Done));
  const int before = lanes.sizeHint().height();
  QFont font = lanes.font();
  font.setPixelSize(2 * QFontInfo(font).pixelSize());
  lanes.setFont(font);
  EXPECT_GT(lanes.sizeHint().height(), before);
  EXPECT_LE(lanes.laneBox(0).bottom(), lanes.laneBox(1).top());
  EXPECT_GT(lanes.laneBox(0).width(), lanes.width() / 2);
}

}  // namespace
}  // namespace beam
