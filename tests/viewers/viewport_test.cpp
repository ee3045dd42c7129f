// SPDX-License-Identifier: Apache-2.0
// The views on a software OpenGL: what is in the framebuffer is what was asked for, the right way up.
#include <gtest/gtest.h>

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QOpenGLWidget>

#include "core/render/cpu_scene_renderer.h"
#include "tests/support/three_balls.h"
#include "tests/support/wait_for.h"
#include "viewers/image/image_view.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

using testing::meanColor;
using testing::plainMaterials;
using testing::sceneOf;
using testing::threeBalls;
using testing::waitFor;

class SplatViewport : public ::testing::Test {
 protected:
  SplatViewport() {
    view.resize(400, 400);
    ViewState state;
    state.orbit = {.target_m = vec3(0), .elevation_rad = 0, .distance_m = 3.2f};
    state.channel = channelOf(kRgbChannel);
    view.setState(state);
    view.show();
    view.setScene(sceneOf(cloud), "frame 0");
  }
  QImage picture() {
    EXPECT_TRUE(waitFor([&] { return view.settled() && view.isVisible(); }));
    return view.grabFramebuffer();
  }
  void press(int key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QKeyEvent event(QEvent::KeyPress, key, modifiers);
    QApplication::sendEvent(&view, &event);
  }

  std::shared_ptr<const GaussianCloud> cloud = threeBalls();
  SplatView view{cpuSceneRenderers(makeCpuDevice())};
};

constexpr QRectF kTop(0.47, 0.22, 0.06, 0.06), kBottom(0.47, 0.72, 0.06, 0.06),
    kRight(0.72, 0.47, 0.06, 0.06), kCorner(0.02, 0.9, 0.05, 0.05), kMiddle(0.47, 0.47, 0.06, 0.06);

TEST_F(SplatViewport, ShowsTheWorldUprightAndInItsColours) {
  const QImage image = picture();
  const vec3 top = meanColor(image, kTop), bottom = meanColor(image, kBottom),
             right = meanColor(image, kRight);
  EXPECT_GT(top.x, 180);
  EXPECT_LT(top.z, 60);
  EXPECT_GT(bottom.z, 180);
  EXPECT_LT(bottom.x, 60);
  EXPECT_GT(right.y, 160);
  EXPECT_LT(meanColor(image, kCorner).x, 45);
}

TEST_F(SplatViewport, NamesWhatItShowsInTheCorner) {
  picture();
  const QImage image = view.grab().toImage();  // as a screenshot of the window takes it
  int bright = 0;
  for (int y = 10; y < 60; ++y) {
    for (int x = 10; x < 200; ++x) bright += image.pixelColor(x, y).lightness() > 150;
  }
  EXPECT_GT(bright, 100) << "the label's words are not there";
}

TEST_F(SplatViewport, ChangesTheChannelWithAKey) {
  picture();
  press(Qt::Key_6);
  const vec3 normal = meanColor(picture(), kTop);  // the ball's front faces the eye at +Z
  EXPECT_NEAR(normal.z, 255, 12);
  EXPECT_NEAR(normal.x, 128, 25);
  press(Qt::Key_7);
  const vec3 depth = meanColor(picture(), kTop);
  EXPECT_GT(glm::distance(depth, normal), 60);
  press(Qt::Key_2);
  EXPECT_GT(meanColor(picture(), kTop).x, 180);
}

TEST_F(SplatViewport, ShowsColourWhereMaterialsAreMissingAndLightWhereTheyAreNot) {
  press(Qt::Key_1);
  EXPECT_GT(meanColor(picture(), kTop).x, 180);
  view.setScene(sceneOf(cloud, plainMaterials(cloud->size())), "frame 0");
  Image<vec3> sky(32, 16, vec3(1), Encoding::Linear);
  view.setLight(std::make_shared<const Environment>(makeEnvironment(std::move(sky))), "white sky");
  const vec3 lit = meanColor(picture(), kTop), lit_bottom = meanColor(picture(), kBottom);
  EXPECT_NEAR(lit.x, lit_bottom.x, 12) << "the same material under a white sky everywhere";
  EXPECT_GT(lit.x, 1.3f * lit.z);
  press(Qt::Key_3);
  EXPECT_NEAR(meanColor(picture(), kTop).x, 203, 6);  // base colour 0.6, encoded
}

TEST_F(SplatViewport, TurnsTheLightWithShiftAndTheRightButton) {
  view.setScene(sceneOf(cloud, plainMaterials(cloud->size())), "frame 0");
  Image<vec3> sky(64, 32, vec3(0.02f), Encoding::Linear);
  for (int y = 8; y < 20; ++y) {
    for (int x = 28; x < 36; ++x) sky(x, y) = vec3(30);  // from +Z, behind the eye
  }
  view.setLight(std::make_shared<const Environment>(makeEnvironment(std::move(sky))), "lamp");
  press(Qt::Key_1);
  const vec3 front = meanColor(picture(), kTop);
  const auto mouse = [&](QEvent::Type type, QPointF at) {
    QMouseEvent event(type, at, Qt::NoButton, Qt::RightButton, Qt::ShiftModifier);
    QApplication::sendEvent(&view, &event);
  };
  mouse(QEvent::MouseButtonPress, {50, 200});
  mouse(QEvent::MouseMove, {50 + 314, 200});  // half a turn
  EXPECT_NEAR(std::abs(view.state().yaw_rad), kPi, 0.02);
  EXPECT_LT(meanColor(picture(), kTop).x, 0.6f * front.x);
}

TEST_F(SplatViewport, OrbitsWithTheLeftButtonAndComesHome) {
  const auto mouse = [&](QEvent::Type type, QPointF at) {
    QMouseEvent event(type, at, Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&view, &event);
  };
  picture();
  mouse(QEvent::MouseButtonPress, {200, 200});
  mouse(QEvent::MouseMove, {200 + 224, 200});  // a quarter turn: the green ball goes behind the middle
  EXPECT_LT(meanColor(picture(), kRight).y, 60);
  press(Qt::Key_H);
  EXPECT_NEAR(view.state().orbit.azimuth_rad, 0, 1e-6);
}

// Photographs of one colour for the cameras.
class PlainSource final : public FrameSource {
 public:
  bool has(ViewIndex, FrameIndex) const override { return true; }
  Image<u8vec3> photo(ViewIndex, FrameIndex) const override {
    return Image<u8vec3>(100, 200, u8vec3(200, 200, 0));
  }
  Image<std::uint8_t> mask(ViewIndex, FrameIndex) const override { return {}; }
};

TEST_F(SplatViewport, LooksThroughACameraWithItsPhotographOverTheRender) {
  auto capture = std::make_shared<CaptureSet>();
  View camera{"cam0", OrbitCamera{.target_m = vec3(0), .elevation_rad = 0, .distance_m = 4}.camera(100, 200),
              Split::Train};
  capture->views = {camera, camera};
  capture->views[1].name = "cam1";
  capture->frames = {"0"};
  capture->source = std::make_shared<PlainSource>();
  view.setCapture(capture, FrameIndex{0});
  press(Qt::Key_BracketRight);
  ASSERT_TRUE(view.state().look_through);
  view.setPhotoOpacity(1);
  EXPECT_TRUE(waitFor([&] { return glm::distance(meanColor(picture(), kMiddle), vec3(200, 200, 0)) < 5; }));
  EXPECT_LT(meanColor(picture(), kCorner).x, 45) << "the photograph fills only its own frame";
  press(Qt::Key_BracketRight);
  EXPECT_EQ(view.state().look_through->value, 1);
  press(Qt::Key_Escape);
  EXPECT_FALSE(view.state().look_through);
}

TEST(ImageViewport, WipesBetweenTwoPicturesAtTheLine) {
  ImageView view;
  view.resize(400, 300);
  view.show();
  view.setPicture(0, "A", [] { return pictureOf(Image<u8vec3>(40, 30, u8vec3(250, 0, 0)), "left"); });
  view.setPicture(1, "B", [] { return pictureOf(Image<u8vec3>(40, 30, u8vec3(0, 0, 250)), "right"); });
  view.setWipe(true);
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  QImage image = view.grabFramebuffer();
  EXPECT_GT(meanColor(image, {0.2, 0.6, 0.1, 0.1}).x, 240);
  EXPECT_GT(meanColor(image, {0.7, 0.6, 0.1, 0.1}).z, 240);
  view.swapSides();
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  image = view.grabFramebuffer();
  EXPECT_GT(meanColor(image, {0.2, 0.6, 0.1, 0.1}).z, 240);
}

TEST(ImageViewport, SaysWhyAPictureCannotBeShownAndStaysAlive) {
  ImageView view;
  view.resize(300, 200);
  view.show();
  view.setPicture(0, "A", []() -> Picture { throw std::runtime_error("the file is gone"); });
  EXPECT_TRUE(waitFor([&] { return view.settled(); }));
  EXPECT_FALSE(view.grabFramebuffer().isNull());
}

TEST(SceneViewport, ShowsEllipsoidsCamerasAndMesh) {
  SceneView view;
  view.resize(400, 400);
  view.show();
  const auto cloud = threeBalls();
  view.setCloud(cloud);
  auto mesh = std::make_shared<Mesh>();
  mesh->vertices = {vec3(-1, 0, 0), vec3(1, 0, 0), vec3(0, 1.5f, 0)};
  mesh->triangles = {{0, 1, 2}};
  view.setMesh(mesh);
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  const QImage with = view.grab().toImage();
  view.setLayerShown(SceneLayer::Gaussians, false);
  const QImage without = view.grab().toImage();
  EXPECT_NE(with, without);
  EXPECT_FALSE(view.layerShown(SceneLayer::Mesh)) << "the mesh would hide the ellipsoids";
  view.setLayerShown(SceneLayer::Mesh, true);
  EXPECT_NE(view.grab().toImage(), without);
}

// What is out of date on arrival is dropped at once, while the thread that made it may not be done yet.
TEST(SceneViewport, LayersMayBeReplacedAsFastAsTheyAreMade) {
  SceneView view;
  auto mesh = std::make_shared<Mesh>();
  mesh->vertices = {vec3(-1, 0, 0), vec3(1, 0, 0), vec3(0, 1.5f, 0)};
  mesh->triangles = {{0, 1, 2}};
  for (int i = 0; i < 20000; ++i) {
    view.setMesh(mesh);
    QApplication::processEvents();
  }
  EXPECT_TRUE(waitFor([&] { return view.settled(); }));
}

TEST(SceneViewport, ShowsJointsOverTheSkinAndFindsTheOneUnderTheHand) {
  SceneView view;
  view.resize(400, 400);
  view.show();
  view.setCloud(threeBalls());
  view.goHome();  // looks at (0, 0.9, 0)
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  const QImage without = view.grab().toImage();
  view.setJoints({{vec3(0, 0.5f, 0), vec3(1, 0.9f, 0)}, {vec3(0, 0.9f, 0), vec3(1, 0.9f, 0)}}, {});
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  EXPECT_NE(view.grab().toImage(), without);
  const QWidget* picture = view.findChild<QOpenGLWidget*>();
  ASSERT_NE(picture, nullptr);
  const QPointF middle = picture->geometry().center();
  EXPECT_EQ(view.jointAt(middle), 0);
  EXPECT_EQ(view.jointAt(middle + QPointF(0, 60)), -1) << "the trail is not the joint";
  int picked = 7;
  QObject::connect(&view, &SceneView::jointPicked, &view, [&](int joint) { picked = joint; });
  const auto press = [&](QPointF from, QPointF to) {
    auto* target = view.findChild<QOpenGLWidget*>();
    const QPointF offset = picture->geometry().topLeft();
    QMouseEvent down(QEvent::MouseButtonPress, from - offset, Qt::LeftButton, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(target, &down);
    QMouseEvent up(QEvent::MouseButtonRelease, to - offset, Qt::LeftButton, Qt::NoButton, Qt::NoModifier);
    QApplication::sendEvent(target, &up);
  };
  press(middle, middle + QPointF(40, 0));
  EXPECT_EQ(picked, 7) << "a drag turns the camera";
  view.goHome();
  press(middle, middle);
  EXPECT_EQ(picked, 0);
  view.setLayerShown(SceneLayer::Joints, false);
  EXPECT_EQ(view.jointAt(middle), -1) << "what is hidden cannot be picked";
}

TEST(SceneViewport, ColoursTheSkinByTheInfluenceOfAJoint) {
  SceneView view;
  view.resize(400, 400);
  view.show();
  const auto cloud = threeBalls();
  view.setCloud(cloud);
  view.setInfluence(0, std::make_shared<const std::vector<float>>(cloud->size() - 1, 1.0f));
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  const QImage own = view.grab().toImage();
  view.setInfluence(0, std::make_shared<const std::vector<float>>(cloud->size(), 1.0f));
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  const QImage shares = view.grab().toImage();
  EXPECT_NE(shares, own);
  view.setInfluence(-1, nullptr);
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  EXPECT_EQ(view.grab().toImage(), own) << "shares of another cloud are not shown";
}

}  // namespace
}  // namespace beam
