// SPDX-License-Identifier: Apache-2.0
// The scene view under the hand: wheel, drags, presses and keys sent as events to what is on the screen.
#include <gtest/gtest.h>

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QOpenGLWidget>
#include <QToolButton>
#include <QWheelEvent>

#include <cmath>

#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"
#include "tests/support/wait_for.h"
#include "viewers/scene/coarse_mesh.h"
#include "viewers/scene/narrow_rows.h"
#include "viewers/scene/scene_view.h"

namespace beam {
namespace {

using testing::addSphere;
using testing::cameraLookingAt;
using testing::waitFor;

const vec3 kMiddle(0.2f, 0.9f, -0.1f);

// Eight cameras in a ring around a ball of seed points, a twentieth of which lies far away.
std::shared_ptr<CaptureSet> ringCapture() {
  auto capture = std::make_shared<CaptureSet>();
  for (int i = 0; i < 8; ++i) {
    const double turn = 2 * kPi * i / 8;
    const dvec3 eye = dvec3(kMiddle) + dvec3(2.5 * std::cos(turn), 0.3 * (i % 2), 2.5 * std::sin(turn));
    capture->views.push_back({"C0" + std::to_string(i), cameraLookingAt(eye, kMiddle, 200, 240),
                              i == 3 ? Split::Test : Split::Train});
  }
  for (int i = 0; i < 400; ++i) {
    const auto at = static_cast<float>(i);
    const vec3 n = glm::normalize(vec3(std::sin(at), std::cos(1.7f * at), std::sin(2.3f * at + 1)));
    capture->seed_points.position_m.push_back(i % 20 == 0 ? vec3(60, 40, 90) : kMiddle + 0.5f * n);
  }
  capture->frames = {"0"};
  return capture;
}

std::shared_ptr<const GaussianCloud> ball(vec3 center = kMiddle) {
  auto cloud = std::make_shared<GaussianCloud>();
  addSphere(*cloud, center, 0.3f, 400);
  return cloud;
}

// A bumpy sheet of 2 * side * side triangles, a metre a side.
std::shared_ptr<const Mesh> sheet(int side) {
  auto mesh = std::make_shared<Mesh>();
  for (int y = 0; y <= side; ++y) {
    for (int x = 0; x <= side; ++x) {
      const vec2 at = vec2(x, y) / static_cast<float>(side);
      mesh->vertices.emplace_back(at.x - 0.5f, 0.4f + at.y, 0.05f * std::sin(20 * at.x));
    }
  }
  const auto id = [side](int x, int y) { return static_cast<std::uint32_t>(y * (side + 1) + x); };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      mesh->triangles.push_back({id(x, y), id(x + 1, y), id(x + 1, y + 1)});
      mesh->triangles.push_back({id(x, y), id(x + 1, y + 1), id(x, y + 1)});
    }
  }
  return mesh;
}

class SceneHand : public ::testing::Test {
 protected:
  SceneHand() {
    view.resize(600, 640);
    view.show();
    view.setCapture(capture);
    picture = view.findChild<QOpenGLWidget*>();
    settle();
  }
  void settle() {
    ASSERT_TRUE(waitFor([&] { return view.settled() && view.isVisible(); }));
  }
  QImage seen() {
    settle();
    return view.picture();
  }
  void mouse(QEvent::Type type, QPointF at, Qt::MouseButton button, Qt::MouseButtons held) {
    QMouseEvent event(type, at, button, held, Qt::NoModifier);
    QApplication::sendEvent(picture, &event);
  }
  void drag(Qt::MouseButton button, QPointF from, QPointF to) {
    mouse(QEvent::MouseButtonPress, from, button, button);
    mouse(QEvent::MouseMove, to, Qt::NoButton, button);
    mouse(QEvent::MouseButtonRelease, to, button, Qt::NoButton);
  }
  void press(QPointF at) {
    mouse(QEvent::MouseButtonPress, at, Qt::LeftButton, Qt::LeftButton);
    mouse(QEvent::MouseButtonRelease, at, Qt::LeftButton, Qt::NoButton);
  }
  void pressTwice(QPointF at) {
    press(at);
    mouse(QEvent::MouseButtonDblClick, at, Qt::LeftButton, Qt::LeftButton);
    mouse(QEvent::MouseButtonRelease, at, Qt::LeftButton, Qt::NoButton);
  }
  void wheel(QPointF at, int notches) {
    QWheelEvent event(at, picture->mapToGlobal(at.toPoint()), {}, {0, 120 * notches}, Qt::NoButton,
                      Qt::NoModifier, Qt::NoScrollPhase, false);
    QApplication::sendEvent(picture, &event);
  }
  void key(int key, Qt::KeyboardModifiers with = Qt::NoModifier, const QString& text = {}) {
    QKeyEvent down(QEvent::KeyPress, key, with, text), up(QEvent::KeyRelease, key, with, text);
    QApplication::sendEvent(picture, &down);
    QApplication::sendEvent(picture, &up);
  }
  QPointF onScreen(vec3 point) const {
    const Camera c = view.orbit().camera(picture->width(), picture->height());
    const dvec2 at = project(c.intrinsics, c.camera_from_world * dvec3(point));
    return {at.x, at.y};
  }
  QPointF eyeOf(int camera) const { return onScreen(vec3(centerOf(capture->views[camera].camera))); }
  QPointF middle() const { return QPointF(picture->width(), picture->height()) / 2; }
  vec3 forward() const {
    const OrbitCamera& o = view.orbit();
    return glm::normalize(o.target_m - vec3(centerOf(o.camera(10, 10))));
  }

  std::shared_ptr<CaptureSet> capture = ringCapture();
  SceneView view;
  QOpenGLWidget* picture = nullptr;
};

// Another page than this one must not wait for geometry that nobody sees.
TEST_F(SceneHand, BuildsWhatCanBeSeen) {
  view.setLayerShown(SceneLayer::Gaussians, false);
  view.setMesh(sheet(20));
  view.setCloud(ball());
  settle();
  EXPECT_EQ(view.drawnTriangles(), 0u);
  view.setLayerShown(SceneLayer::Mesh, true);
  settle();
  EXPECT_EQ(view.drawnTriangles(), 800u);
  view.hide();
  view.setMesh(sheet(30));
  EXPECT_TRUE(view.settled());
  EXPECT_EQ(view.drawnTriangles(), 800u);
  view.show();
  settle();
  EXPECT_EQ(view.drawnTriangles(), 1800u);
}

TEST_F(SceneHand, ZoomsWithTheWheelToThePointer) {
  const float before = view.orbit().distance_m;
  const QImage first = seen();
  const QPointF at(410, 190);
  const Camera c = view.orbit().camera(picture->width(), picture->height());
  const vec3 held(inverse(c.camera_from_world) *
                  (static_cast<double>(before) * rayOf(c.intrinsics, dvec2(at.x(), at.y()))));
  wheel(at, 3);
  EXPECT_LT(view.orbit().distance_m, before);
  EXPECT_NEAR(onScreen(held).x(), at.x(), 0.1);
  EXPECT_NEAR(onScreen(held).y(), at.y(), 0.1);
  EXPECT_NE(seen(), first);
  wheel(at, -3);
  EXPECT_NEAR(view.orbit().distance_m, before, 1e-4);
}

TEST_F(SceneHand, OrbitsWithTheLeftAndPansWithTheMiddleButtonLikeTheSplatView) {
  OrbitCamera expected = view.orbit();
  const QImage first = seen();
  drag(Qt::LeftButton, {200, 200}, {260, 230});
  expected.orbit({60, 30});
  EXPECT_EQ(view.orbit().azimuth_rad, expected.azimuth_rad);
  EXPECT_EQ(view.orbit().elevation_rad, expected.elevation_rad);
  const QImage turned = seen();
  EXPECT_NE(turned, first);
  drag(Qt::MiddleButton, {200, 200}, {240, 180});
  expected.pan({40, -20}, picture->height());
  EXPECT_EQ(view.orbit().target_m, expected.target_m);
  EXPECT_NE(seen(), turned);
}

TEST_F(SceneHand, DrawsThePointsWhereItsOwnCameraSaysTheyAre) {
  auto point = std::make_shared<CaptureSet>();
  point->views = capture->views;
  point->seed_points.position_m = {kMiddle + vec3(0.4f, 0.2f, 0.3f)};
  point->seed_points.color = {u8vec3(255, 0, 255)};
  view.setCapture(point);
  const auto magenta = [&] {
    const QImage image = seen();
    QPointF sum;
    int count = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const QColor c = image.pixelColor(x, y);
        if (c.red() < 200 || c.blue() < 200 || c.green() > 60) continue;
        sum += QPointF(x + 0.5, y + 0.5);
        ++count;
      }
    }
    return count > 0 ? sum / (count * image.devicePixelRatio()) : QPointF(-1, -1);
  };
  const QPointF free = magenta(), expected = onScreen(point->seed_points.position_m[0]);
  EXPECT_NEAR(free.x(), expected.x(), 1.5);
  EXPECT_NEAR(free.y(), expected.y(), 1.5);
  point->views[2].camera.intrinsics = {300, 200, 130, 80};
  view.lookThrough(ViewIndex{2});
  const Camera through = fittedTo(point->views[2].camera, picture->width(), picture->height());
  const dvec2 at =
      project(through.intrinsics, through.camera_from_world * dvec3(point->seed_points.position_m[0]));
  const QPointF found = magenta();
  EXPECT_NEAR(found.x(), at.x, 1.5);
  EXPECT_NEAR(found.y(), at.y, 1.5);
}

TEST_F(SceneHand, LetsNoKeyReachVtk) {
  view.setCloud(ball());
  const QImage before = seen();
  const OrbitCamera orbit = view.orbit();
  for (const char letter : std::string("qwspruetcloi3")) {
    key(std::toupper(letter), Qt::NoModifier, QString(QChar(letter)));
    EXPECT_EQ(seen(), before) << letter;
  }
  EXPECT_EQ(view.orbit().target_m, orbit.target_m);
}

TEST_F(SceneHand, FramesTheSeedPointsWithoutTheStraysAndKeepsTheDirection) {
  drag(Qt::LeftButton, {200, 200}, {290, 230});
  const vec3 direction = forward();
  key(Qt::Key_F);
  EXPECT_LT(glm::distance(view.orbit().target_m, kMiddle), 0.1f);
  EXPECT_LT(view.orbit().distance_m, 4);
  EXPECT_NEAR(glm::distance(forward(), direction), 0, 1e-5);
}

TEST_F(SceneHand, FramesTheCloudIfThereIsOneAndTheCamerasIfThereIsNothingElse) {
  const vec3 elsewhere(1, 1.5f, 0.4f);
  view.setCloud(ball(elsewhere));
  view.frameSubject();
  EXPECT_LT(glm::distance(view.orbit().target_m, elsewhere), 0.05f);
  auto bare = std::make_shared<CaptureSet>(*capture);
  bare->seed_points = {};
  view.setCapture(bare);
  view.setCloud(nullptr);
  view.frameSubject();
  EXPECT_LT(glm::distance(view.orbit().target_m, kMiddle + vec3(0, 0.15f, 0)), 0.1f);
  EXPECT_GT(view.orbit().distance_m, 4);
}

TEST_F(SceneHand, ComesHomeFromAnywhere) {
  const OrbitCamera home = view.orbit();
  drag(Qt::LeftButton, {200, 200}, {290, 230});
  wheel({100, 100}, 5);
  key(Qt::Key_H);
  EXPECT_EQ(view.orbit().target_m, home.target_m);
  EXPECT_EQ(view.orbit().azimuth_rad, home.azimuth_rad);
  EXPECT_EQ(view.orbit().distance_m, home.distance_m);
}

TEST_F(SceneHand, LooksAlongTheAxesFromTheNumberPad) {
  const vec3 target = view.orbit().target_m;
  key(Qt::Key_3, Qt::KeypadModifier);
  EXPECT_NEAR(glm::distance(forward(), vec3(-1, 0, 0)), 0, 1e-5);
  key(Qt::Key_7, Qt::KeypadModifier | Qt::ControlModifier);
  EXPECT_NEAR(glm::distance(forward(), vec3(0, 1, 0)), 0, 1e-5);
  EXPECT_EQ(view.orbit().target_m, target);
  QKeyEvent shortcut(QEvent::ShortcutOverride, Qt::Key_1, Qt::KeypadModifier | Qt::ControlModifier);
  shortcut.ignore();
  QApplication::sendEvent(picture, &shortcut);
  EXPECT_TRUE(shortcut.isAccepted()) << "Ctrl+1 of the window would take it";
}

TEST_F(SceneHand, SetsTheFocusWhereItIsPressedTwice) {
  view.setCloud(ball());
  view.setPreset(ViewPreset::Front);
  view.setLayerShown(SceneLayer::Cameras, false);  // one stands in front of it
  settle();
  const vec3 wanted = kMiddle + vec3(0.1f, 0.1f, std::sqrt(0.09f - 0.02f));
  pressTwice(onScreen(wanted));
  EXPECT_LT(glm::distance(view.orbit().target_m, wanted), 0.06f);
  EXPECT_NEAR(glm::distance(forward(), vec3(0, 0, -1)), 0, 1e-5);
  EXPECT_NEAR(onScreen(view.orbit().target_m).x(), middle().x(), 1e-2);
  const vec3 kept = view.orbit().target_m;
  settle();
  pressTwice({4, 4});
  EXPECT_EQ(view.orbit().target_m, kept) << "there is nothing";
}

TEST_F(SceneHand, MarksTheCameraWhoseFrustumIsPressedAndTellsOfIt) {
  std::vector<int> picked, activated;
  QObject::connect(&view, &SceneView::cameraPicked, &view, [&](ViewIndex v) { picked.push_back(v.value); });
  QObject::connect(&view, &SceneView::cameraActivated, &view,
                   [&](ViewIndex v) { activated.push_back(v.value); });
  press(eyeOf(5));
  EXPECT_EQ(picked, std::vector<int>{5});
  EXPECT_EQ(view.markedCamera(), ViewIndex{5});
  drag(Qt::LeftButton, eyeOf(1), eyeOf(1) + QPointF(30, 0));
  EXPECT_EQ(picked, std::vector<int>{5}) << "a drag turns the camera";
  press({3, 3});
  EXPECT_EQ(picked, std::vector<int>{5}) << "nothing is there";
  EXPECT_TRUE(activated.empty());
  view.setLayerShown(SceneLayer::Cameras, false);
  press(eyeOf(2));
  EXPECT_EQ(picked, std::vector<int>{5}) << "what is hidden cannot be picked";
}

TEST_F(SceneHand, NamesTheCameraUnderThePointer) {
  mouse(QEvent::MouseMove, eyeOf(5), Qt::NoButton, Qt::NoButton);
  EXPECT_TRUE(picture->toolTip().contains("C05")) << picture->toolTip().toStdString();
  mouse(QEvent::MouseMove, {3, 3}, Qt::NoButton, Qt::NoButton);
  EXPECT_TRUE(picture->toolTip().isEmpty());
}

TEST_F(SceneHand, LooksThroughTheCameraThatIsPressedTwiceUntilTheFirstDrag) {
  std::vector<int> activated;
  QObject::connect(&view, &SceneView::cameraActivated, &view,
                   [&](ViewIndex v) { activated.push_back(v.value); });
  pressTwice(eyeOf(5));
  EXPECT_EQ(activated, std::vector<int>{5});
  ASSERT_EQ(view.lookedThrough(), ViewIndex{5});
  press({20, 200});
  EXPECT_TRUE(view.lookedThrough()) << "a press is no drag";
  drag(Qt::LeftButton, {200, 200}, {206, 200});
  EXPECT_FALSE(view.lookedThrough());
  const vec3 eye(centerOf(view.orbit().camera(10, 10)));
  EXPECT_LT(glm::distance(eye, vec3(centerOf(capture->views[5].camera))), 0.3f) << "from where it was";
}

TEST_F(SceneHand, StepsThroughTheCamerasWithTheBracketsAndLeavesWithEscape) {
  std::vector<int> picked;
  QObject::connect(&view, &SceneView::cameraPicked, &view, [&](ViewIndex v) { picked.push_back(v.value); });
  key(Qt::Key_BracketRight);
  key(Qt::Key_BracketRight);
  key(Qt::Key_BracketLeft);
  key(Qt::Key_BracketLeft);
  EXPECT_EQ(picked, (std::vector<int>{0, 1, 0, 7}));
  EXPECT_EQ(view.lookedThrough(), ViewIndex{7});
  key(Qt::Key_Escape);
  EXPECT_FALSE(view.lookedThrough());
}

TEST_F(SceneHand, ShowsWhichCameraIsMarked) {
  const QImage without = seen();
  view.markCamera(ViewIndex{3});
  const QImage third = seen();
  EXPECT_NE(third, without);
  view.markCamera(ViewIndex{4});
  EXPECT_NE(seen(), third);
  view.setLayerShown(SceneLayer::Cameras, false);
  const QImage hidden = seen();
  view.markCamera(ViewIndex{3});
  EXPECT_EQ(seen(), hidden) << "with the cameras hidden the mark is, too";
  view.setLayerShown(SceneLayer::Cameras, true);
  view.markCamera(std::nullopt);
  EXPECT_EQ(seen(), without);
  view.markCamera(ViewIndex{99});
  EXPECT_FALSE(view.markedCamera()) << "the capture has no such camera";
}

TEST_F(SceneHand, DrawsFewerTrianglesOfALargeMeshWhileItMoves) {
  view.setMesh(sheet(300));
  view.setLayerShown(SceneLayer::Mesh, true);
  settle();
  EXPECT_EQ(view.drawnTriangles(), 180000u);
  mouse(QEvent::MouseButtonPress, {200, 200}, Qt::LeftButton, Qt::LeftButton);
  mouse(QEvent::MouseMove, {230, 200}, Qt::NoButton, Qt::LeftButton);
  EXPECT_FALSE(view.settled());
  EXPECT_LT(view.drawnTriangles(), 60001u);
  EXPECT_GT(view.drawnTriangles(), 10000u) << "a stand-in that looks like it";
  mouse(QEvent::MouseButtonRelease, {230, 200}, Qt::LeftButton, Qt::NoButton);
  settle();
  EXPECT_EQ(view.drawnTriangles(), 180000u);
  view.setMesh(sheet(10));
  settle();
  wheel({200, 200}, 1);
  EXPECT_EQ(view.drawnTriangles(), 200u) << "a small one is drawn whole";
}

TEST_F(SceneHand, DrawsPlainerEllipsoidsWhileItMoves) {
  const auto cloud = ball();
  view.setCloud(cloud);
  settle();
  EXPECT_EQ(view.drawnTriangles(), 128 * cloud->size());
  wheel({200, 200}, 1);
  EXPECT_EQ(view.drawnTriangles(), 8 * cloud->size());
  settle();
  EXPECT_EQ(view.drawnTriangles(), 128 * cloud->size());
}

TEST_F(SceneHand, ShowsTheInfluenceUnderThePickedJoint) {
  const auto cloud = ball();
  view.setCloud(cloud);
  view.setPreset(ViewPreset::Front);
  std::vector<vec3> joints;
  for (int i = 0; i < 100; ++i)
    joints.push_back(kMiddle + vec3(0.05f * static_cast<float>(i % 10) - 0.22f,
                                    0.05f * static_cast<float>(i / 10) - 0.22f, 0.3f));
  view.frameSubject();
  view.setJoints({joints}, {});
  view.setLayerShown(SceneLayer::SeedPoints, false);
  view.setLayerShown(SceneLayer::Cameras, false);
  view.setInfluence(44, std::make_shared<const std::vector<float>>(cloud->size(), 1.0f));
  const QImage image = seen();
  const QPointF joint = onScreen(joints[44]) * image.devicePixelRatio();
  int yellow = 0, pixels = 0;
  for (int y = -12; y <= 12; ++y) {
    for (int x = -12; x <= 12; ++x) {
      const QColor c = image.pixelColor(joint.toPoint() + QPoint(x, y));
      yellow += c.red() > 110 && c.green() > 90 && c.blue() < 0.6 * c.red();
      ++pixels;
    }
  }
  EXPECT_GT(yellow, 0.6 * pixels) << "the skin under the joint in the colour of its share";
}

TEST_F(SceneHand, KeepsTheLegendOfInfluenceInViewWhateverTheSize) {
  const auto cloud = ball();
  view.setCloud(cloud);
  view.setJoints({{kMiddle}}, {});
  view.setInfluence(0, std::make_shared<const std::vector<float>>(cloud->size(), 0.3f));
  for (const QSize size : {QSize(300, 260), QSize(600, 640)}) {
    view.resize(size);
    const QImage image = seen();
    int full = 0;
    for (int y = image.height() / 2; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const QColor c = image.pixelColor(x, y);
        full += c.red() > 220 && c.green() > 200 && c.blue() < 120;  // the bar's end; no skin has that share
      }
    }
    EXPECT_GT(full, 10) << size.width();
  }
}

TEST_F(SceneHand, StartsEachCaptureFromHomeWithTheLayersOfTheBeginning) {
  const OrbitCamera home = view.orbit();
  view.setLayerShown(SceneLayer::Mesh, true);
  view.setLayerShown(SceneLayer::Grid, false);
  view.markCamera(ViewIndex{2});
  view.lookThrough(ViewIndex{2});
  view.setCapture(capture);
  EXPECT_TRUE(view.lookedThrough()) << "the same one goes on as it is";
  view.setCapture(ringCapture());
  for (int i = 0; i < kSceneLayerCount; ++i) {
    const auto layer = static_cast<SceneLayer>(i);
    EXPECT_EQ(view.layerShown(layer), layer != SceneLayer::Mesh) << i;
  }
  EXPECT_FALSE(view.lookedThrough());
  EXPECT_FALSE(view.markedCamera());
  EXPECT_EQ(view.orbit().azimuth_rad, home.azimuth_rad);
  EXPECT_EQ(view.orbit().distance_m, home.distance_m);
}

TEST_F(SceneHand, FitsItsButtonsAndFactsIntoANarrowWindowWithLargeText) {
  QFont large = view.font();
  large.setPixelSize(20);
  view.setFont(large);
  for (QWidget* child : view.findChildren<QWidget*>()) child->setFont(large);
  view.resize(480, 500);
  settle();
  const auto buttons = view.findChildren<QToolButton*>();
  ASSERT_EQ(buttons.size(), kSceneLayerCount);
  for (const QToolButton* one : buttons) {
    EXPECT_TRUE(view.rect().contains(one->geometry())) << one->text().toStdString();
    EXPECT_GE(one->width(), one->sizeHint().width()) << one->text().toStdString();
    EXPECT_LE(one->geometry().bottom(), picture->geometry().top());
    EXPECT_EQ(one->focusPolicy(), Qt::StrongFocus);
    for (const QToolButton* other : buttons)
      EXPECT_TRUE(one == other || !one->geometry().intersects(other->geometry()));
  }
  EXPECT_EQ(view.width(), 480);
  const auto* facts = dynamic_cast<ElidedLine*>(view.findChild<QLabel*>("quiet"));
  ASSERT_NE(facts, nullptr);
  EXPECT_TRUE(facts->text().endsWith("…"));
  EXPECT_TRUE(facts->toolTip().contains("8 cameras, 1 of them for testing"))
      << facts->toolTip().toStdString();
  EXPECT_LE(facts->fontMetrics().horizontalAdvance(facts->text()), facts->contentsRect().width());
}

TEST_F(SceneHand, GivesItsPictureWithoutTheButtons) {
  const QImage image = seen();
  EXPECT_EQ(image.size(), picture->size() * picture->devicePixelRatioF());
}

TEST(CoarserMesh, HasAtMostAsManyTrianglesAndLiesOnTheSurface) {
  const auto mesh = sheet(200);
  const Mesh coarse = coarser(*mesh, 5000);
  EXPECT_LE(coarse.triangles.size(), 5000u);
  EXPECT_GT(coarse.triangles.size(), 1000u);
  for (const vec3& v : coarse.vertices) EXPECT_NEAR(v.z, 0.05f * std::sin(20 * (v.x + 0.5f)), 0.01f);
  vec3 sum(0);
  for (const auto& [a, b, c] : coarse.triangles)
    sum +=
        0.5f * glm::cross(coarse.vertices[b] - coarse.vertices[a], coarse.vertices[c] - coarse.vertices[a]);
  EXPECT_NEAR(sum.z, 1, 0.1) << "turned the same way, without holes";
  EXPECT_EQ(coarser(*mesh, 100000).triangles, mesh->triangles);
}

TEST(CoarserMesh, EndsWithMeshesOfNoArea) {
  Mesh flat;
  flat.vertices.assign(3, vec3(1));
  flat.triangles.assign(100, {0, 1, 2});
  EXPECT_TRUE(coarser(flat, 10).triangles.empty());
}

}  // namespace
}  // namespace beam
