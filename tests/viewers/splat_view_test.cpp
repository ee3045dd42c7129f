// SPDX-License-Identifier: Apache-2.0
// Hands, keys and words of the splat view.
#include <gtest/gtest.h>

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>

#include <future>

#include "core/render/cpu_scene_renderer.h"
#include "tests/support/three_balls.h"
#include "tests/support/wait_for.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

using testing::meanColor;
using testing::plainMaterials;
using testing::sceneOf;
using testing::threeBalls;
using testing::waitFor;

constexpr QRectF kMiddle(0.47, 0.47, 0.06, 0.06), kTop(0.47, 0.22, 0.06, 0.06);

std::shared_ptr<const Environment> whiteSky() {
  return std::make_shared<const Environment>(makeEnvironment(Image<vec3>(32, 16, vec3(1), Encoding::Linear)));
}

class SplatHands : public ::testing::Test {
 protected:
  SplatHands() {
    view.resize(400, 400);
    ViewState state;
    state.orbit = {.target_m = vec3(0), .elevation_rad = 0, .distance_m = 3.2f};
    state.channel = channelOf(kRgbChannel);
    view.setState(state);
    view.show();
    view.setScene(sceneOf(cloud), "frame 0");
  }
  bool settle() {
    return waitFor([this] { return view.settled() && view.isVisible(); });
  }
  QImage picture() {
    EXPECT_TRUE(settle());
    return view.picture();
  }
  bool press(int key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QKeyEvent event(QEvent::KeyPress, key, modifiers);
    return view.handleKey(event);
  }
  void type(int key) {
    QKeyEvent event(QEvent::KeyPress, key, Qt::NoModifier);
    QApplication::sendEvent(&view, &event);
  }
  void wheel(QPointF at, int units) {
    QWheelEvent event(at, view.mapToGlobal(at.toPoint()), {}, {0, units}, Qt::NoButton, Qt::NoModifier,
                      Qt::NoScrollPhase, false);
    QApplication::sendEvent(&view, &event);
  }
  void doubleClick(QPointF at) {
    QMouseEvent event(QEvent::MouseButtonDblClick, at, Qt::LeftButton, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&view, &event);
  }
  dvec2 pixelOf(vec3 point) const {
    const Camera camera = view.state().orbit.camera(400, 400);
    return project(camera.intrinsics, camera.camera_from_world * dvec3(point));
  }

  std::shared_ptr<const GaussianCloud> cloud = threeBalls();
  SplatView view{cpuSceneRenderers(makeCpuDevice())};
};

TEST_F(SplatHands, TheWheelZoomsToThePointer) {
  ASSERT_TRUE(settle());
  const vec3 point(0.6f, 0, 0);  // at the target's depth
  const dvec2 before = pixelOf(point);
  wheel({before.x, before.y}, 360);
  EXPECT_LT(view.state().orbit.distance_m, 3.2f);
  const dvec2 after = pixelOf(point);
  EXPECT_NEAR(after.x, before.x, 0.1);
  EXPECT_NEAR(after.y, before.y, 0.1);
}

TEST_F(SplatHands, FFramesTheSubjectFromWhereOneLooksAndHGoesHome) {
  ASSERT_TRUE(settle());
  ViewState state = view.state();
  state.orbit = {.target_m = vec3(5, 5, 5), .azimuth_rad = 1.1f, .elevation_rad = 0.4f, .distance_m = 40};
  view.setState(state);
  EXPECT_TRUE(press(Qt::Key_F));
  EXPECT_NEAR(view.state().orbit.azimuth_rad, 1.1f, 1e-5);
  EXPECT_NEAR(view.state().orbit.elevation_rad, 0.4f, 1e-5);
  EXPECT_LT(glm::distance(view.state().orbit.target_m, vec3(0)), 0.6f);
  EXPECT_LT(view.state().orbit.distance_m, 10);
  EXPECT_TRUE(press(Qt::Key_H));
  EXPECT_EQ(view.state().orbit.azimuth_rad, OrbitCamera{}.azimuth_rad);
}

TEST_F(SplatHands, TheTitleIsOfThePictureThatIsSeenWhileFramesPass) {
  ASSERT_TRUE(settle());
  view.setPassing(2);
  view.setScene(sceneOf(threeBalls()), "frame 1");
  EXPECT_TRUE(view.title().contains("frame 0")) << view.title().toStdString();
  ASSERT_TRUE(waitFor([&] { return view.title().contains("frame 1"); }));
  view.setPassing(0);
  ASSERT_TRUE(settle());
  EXPECT_TRUE(view.title().contains("frame 1"));
}

TEST_F(SplatHands, WhatIsUnderThePointerIsReadAnewWithEveryPicture) {
  ASSERT_TRUE(settle());
  QString said;
  QObject::connect(&view, &SplatView::hovered, &view, [&](const QString& words) { said = words; });
  const dvec2 red = pixelOf(vec3(0, 0.6f, 0));
  QMouseEvent move(QEvent::MouseMove, QPointF(red.x, red.y), Qt::NoButton, Qt::NoButton, Qt::NoModifier);
  QApplication::sendEvent(&view, &move);
  EXPECT_TRUE(said.contains("Colour")) << said.toStdString();
  view.setChannel(channelOf(kDepthChannel));
  ASSERT_TRUE(settle());
  EXPECT_TRUE(said.contains("Depth")) << said.toStdString();
  QEvent leave(QEvent::Leave);
  QApplication::sendEvent(&view, &leave);
  EXPECT_TRUE(said.isEmpty());
  view.setChannel(channelOf(kRgbChannel));
  ASSERT_TRUE(settle());
  EXPECT_TRUE(said.isEmpty());
}

TEST_F(SplatHands, TheNumberPadLooksAlongTheAxes) {
  ASSERT_TRUE(settle());
  EXPECT_TRUE(press(Qt::Key_3, Qt::KeypadModifier));
  EXPECT_EQ(view.state().channel, channelOf(kRgbChannel)) << "a digit of the pad is no channel";
  EXPECT_GT(centerOf(view.state().orbit.camera(10, 10)).x, 2);
  EXPECT_FALSE(press(Qt::Key_2, Qt::KeypadModifier));
  press(Qt::Key_7, Qt::KeypadModifier);
  EXPECT_GT(centerOf(view.state().orbit.camera(10, 10)).y, 2);
  press(Qt::Key_1, Qt::KeypadModifier | Qt::ControlModifier);
  EXPECT_LT(centerOf(view.state().orbit.camera(10, 10)).z, -2);
  QKeyEvent ask(QEvent::ShortcutOverride, Qt::Key_1, Qt::KeypadModifier | Qt::ControlModifier);
  ask.ignore();
  QApplication::sendEvent(&view, &ask);
  EXPECT_TRUE(ask.isAccepted()) << "else the window's Ctrl+1 takes it";
}

TEST_F(SplatHands, ADoubleClickSetsTheFocusOnTheSurfaceAndNowhereElse) {
  ASSERT_TRUE(settle());
  const dvec2 red = pixelOf(vec3(0, 0.6f, 0));
  doubleClick({red.x, red.y});
  const vec3 target = view.state().orbit.target_m;
  EXPECT_NEAR(glm::distance(target, vec3(0, 0.6f, 0)), 0.3f, 0.06f) << "on the ball's skin";
  EXPECT_GT(target.z, 0.2f) << "on the side of the eye";
  ASSERT_TRUE(settle());
  doubleClick({5, 395});
  EXPECT_EQ(view.state().orbit.target_m, target);
}

TEST_F(SplatHands, ReturnEntersACameraOnlyWhereTheViewItselfHasIt) {
  auto capture = std::make_shared<CaptureSet>();
  capture->views = {{"cam0", OrbitCamera{}.camera(100, 200), Split::Train}};
  capture->frames = {"0"};
  view.setCapture(capture, FrameIndex{0});
  EXPECT_FALSE(press(Qt::Key_Return)) << "as passed on by the window";
  EXPECT_FALSE(view.state().look_through);
  type(Qt::Key_Return);
  EXPECT_TRUE(view.state().look_through);
  EXPECT_TRUE(press(Qt::Key_Escape));
  EXPECT_FALSE(press(Qt::Key_Escape)) << "there is nothing to leave";
}

// A photograph of one colour a frame; that of frame 0 can be kept waiting, frame 2 has none.
class FrameColours final : public FrameSource {
 public:
  explicit FrameColours(std::shared_future<void> open = {}) : open_(std::move(open)) {}
  bool has(ViewIndex, FrameIndex frame) const override { return frame.value < 2; }
  Image<u8vec3> photo(ViewIndex, FrameIndex frame) const override {
    if (frame.value == 0 && open_.valid()) open_.wait();
    return Image<u8vec3>(100, 200, frame.value == 0 ? u8vec3(200, 200, 0) : u8vec3(0, 200, 200));
  }
  Image<std::uint8_t> mask(ViewIndex, FrameIndex) const override { return {}; }

 private:
  std::shared_future<void> open_;
};

std::shared_ptr<CaptureSet> threeFrames(std::shared_ptr<const FrameSource> source) {
  auto capture = std::make_shared<CaptureSet>();
  const Camera camera =
      OrbitCamera{.target_m = vec3(0), .elevation_rad = 0, .distance_m = 4}.camera(100, 200);
  capture->views = {{"cam0", camera, Split::Train}};
  capture->frames = {"000000", "000001", "000002"};
  capture->source = std::move(source);
  return capture;
}

TEST_F(SplatHands, NeverShowsThePhotographOfAnotherFrame) {
  const auto capture = threeFrames(std::make_shared<FrameColours>());
  view.setCapture(capture, FrameIndex{0});
  view.lookThrough(ViewIndex{0});
  view.setPhotoOpacity(1);
  const vec3 yellow(200, 200, 0), cyan(0, 200, 200);
  const auto shows = [&](vec3 color) { return glm::distance(meanColor(picture(), kMiddle), color) < 8; };
  ASSERT_TRUE(waitFor([&] { return shows(yellow); }));
  view.setCapture(capture, FrameIndex{1});
  EXPECT_FALSE(shows(yellow)) << "the old one goes before the new one is there";
  EXPECT_TRUE(waitFor([&] { return shows(cyan); }));
  view.setCapture(capture, FrameIndex{2});
  EXPECT_FALSE(shows(cyan));
  EXPECT_FALSE(view.words().foot.isEmpty()) << "says that there is none";
}

TEST_F(SplatHands, AnAnswerForAnEarlierFrameIsDropped) {
  std::promise<void> gate;
  const auto capture = threeFrames(std::make_shared<FrameColours>(gate.get_future().share()));
  view.setCapture(capture, FrameIndex{0});
  view.lookThrough(ViewIndex{0});
  view.setPhotoOpacity(1);
  view.setCapture(capture, FrameIndex{2});  // has no photograph that could replace a late one
  gate.set_value();
  const vec3 yellow(200, 200, 0);
  EXPECT_FALSE(waitFor([&] { return glm::distance(meanColor(picture(), kMiddle), yellow) < 8; }, 500));
}

TEST_F(SplatHands, SaysThatTheLightIsBeingReadAndKeepsTheOneBefore) {
  view.setScene(sceneOf(cloud, plainMaterials(cloud->size())), "frame 0");
  view.setChannel(channelOf(kRelightChannel));
  view.setLight(nullptr, {}, false);
  const QImage without = picture();
  view.setLight(nullptr, "dome", true);
  EXPECT_TRUE(view.settled()) << "words alone need no rendering";
  EXPECT_NE(view.picture(), without) << "the words are others";
  view.setLight(whiteSky(), "dome");
  const QImage lit = picture();
  EXPECT_NE(meanColor(lit, kTop), meanColor(without, kTop));
  view.setLight(nullptr, "sunset", true);
  EXPECT_TRUE(view.settled());
  EXPECT_EQ(meanColor(view.picture(), kTop), meanColor(lit, kTop));
  EXPECT_FALSE(view.words().foot.isEmpty());
}

TEST_F(SplatHands, PaintsABadgeUnderTheTitleWithoutRenderingAnew) {
  ASSERT_TRUE(settle());
  view.setBadge("stale: made with other settings");
  EXPECT_TRUE(view.settled());
  const QImage image = view.picture();
  const QRectF badge = view.words().badge;
  ASSERT_FALSE(badge.isEmpty());
  EXPECT_GE(badge.top(), view.words().title.bottom());
  const QColor amber = image.pixelColor(badge.topLeft().toPoint() + QPoint(4, 4));
  EXPECT_GT(amber.red(), 180);
  EXPECT_LT(amber.blue(), 110);
  view.setBadge({});
  view.picture();
  EXPECT_TRUE(view.words().badge.isEmpty());
}

TEST_F(SplatHands, KeepsItsWordsInsideANarrowViewWithLargeTypeAndOffTheLegend) {
  QFont large = view.font();
  large.setPointSizeF(1.5 * large.pointSizeF());
  view.setFont(large);
  view.resize(300, 440);
  view.setScene(sceneOf(cloud, plainMaterials(cloud->size())),
                "frame 000004 is not solved: held from a_frame_with_a_name_that_is_very_long_indeed");
  view.setBadge("stale: made with other settings");
  view.setExposure(1.5f);
  const QRectF inside(0, 0, 300, 440);
  for (const ChannelInfo& channel :
       {channelOf(kDepthChannel), channelOf(kRoughnessChannel), channelOf(kRelightChannel)}) {
    view.setChannel(channel);
    picture();
    const WordBoxes& words = view.words();
    EXPECT_TRUE(inside.contains(words.title));
    EXPECT_TRUE(inside.contains(words.badge));
    EXPECT_FALSE(words.title.intersects(words.badge));
    if (channel == channelOf(kRelightChannel)) {
      EXPECT_TRUE(inside.contains(words.foot)) << "no light is chosen";
      continue;
    }
    ASSERT_FALSE(words.scale.isEmpty());
    EXPECT_TRUE(inside.contains(words.scale));
    for (const QRectF& box : {words.title, words.badge, words.foot})
      EXPECT_FALSE(words.scale.intersects(box));
  }
}

TEST_F(SplatHands, HoldsTheLimitsOfDepthWhileTheCameraMoves) {
  view.setChannel(channelOf(kDepthChannel));
  const vec3 near = meanColor(picture(), kTop);
  view.lockDepth(true);
  ASSERT_TRUE(view.state().depth_limits);
  const Limits held = *view.state().depth_limits;
  EXPECT_EQ(meanColor(picture(), kTop), near);
  ViewState state = view.state();
  state.orbit.distance_m = 3.4f;
  view.setState(state);
  const vec3 locked = meanColor(picture(), kTop);
  EXPECT_EQ(view.state().depth_limits->low, held.low);
  view.lockDepth(false);
  const vec3 automatic = meanColor(picture(), kTop);
  EXPECT_GT(glm::distance(locked, automatic), 20) << "farther away is another colour between the same limits";
  view.setChannel(channelOf(kNormalChannel));
  picture();
  view.lockDepth(true);
  EXPECT_FALSE(view.state().depth_limits) << "there are none to hold";
}

TEST_F(SplatHands, ForgetsWhatBelongedToTheProjectBefore) {
  const auto capture = threeFrames(std::make_shared<FrameColours>());
  view.setCapture(capture, FrameIndex{0});
  view.lookThrough(ViewIndex{0});
  view.setPhotoOpacity(0.9f);
  view.setExposure(2);
  view.setYaw(1);
  view.setSky(true);
  view.setChannel(channelOf(kDepthChannel));
  view.setLight(whiteSky(), "dome");
  view.setBadge("preview of a cancelled run");
  view.resetState();
  const ViewState& state = view.state();
  EXPECT_FALSE(state.look_through);
  EXPECT_EQ(state.channel, channelOf(kRelightChannel));
  EXPECT_EQ(state.exposure_stops, 0);
  EXPECT_EQ(state.yaw_rad, 0);
  EXPECT_FALSE(state.sky);
  EXPECT_EQ(state.photo_opacity, 0);
  EXPECT_TRUE(view.badge().isEmpty());
  view.lookThrough(ViewIndex{0});
  EXPECT_EQ(view.state().photo_opacity, 0.5f) << "the fade chosen before is not kept";
}

}  // namespace
}  // namespace beam
