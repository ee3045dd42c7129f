// SPDX-License-Identifier: Apache-2.0
// Two renderers that the program does not have walk through the splat view: one refines its pictures on the
// host, one answers with textures of the view's context. What holds for them holds for a renderer to come.
#include <gtest/gtest.h>

#include <QApplication>
#include <QMouseEvent>

#include <condition_variable>
#include <mutex>

#include "core/base/error.h"
#include "core/math/color.h"
#include "core/scene/environment.h"
#include "tests/support/three_balls.h"
#include "tests/support/wait_for.h"
#include "viewers/splat/splat_view.h"

namespace beam::testing {
namespace {

constexpr QRectF kLeft(0.1, 0.4, 0.3, 0.2), kRight(0.8, 0.4, 0.15, 0.2);

// Whatever the scene: something is in the left half of every picture, covering three quarters.
vec3 valueOf(const std::string& channel) {
  if (channel == kNormalChannel) return glm::normalize(vec3(0.2f, 0.3f, 0.9f));
  if (channel == kDepthChannel) return vec3(2.5f);
  if (channel == kOcclusionChannel) return vec3(0.7f);
  if (channel == kRoughnessChannel) return vec3(0.35f);
  return {0.6f, 0.3f, 0.1f};
}
float alphaOf(int x, int width) { return x < width / 2 ? 0.75f : 0; }

Planes planesOf(const ChannelInfo& channel, const Camera& camera, float brightness) {
  Planes p(camera.width, camera.height, componentsOf(channel));
  for (std::size_t i = 0; i < p.values.size(); ++i) {
    const int x = static_cast<int>(i % p.planeSize()) % camera.width;
    const int component = static_cast<int>(i / p.planeSize());
    const float alpha = alphaOf(x, camera.width);
    const float value = channel.id == kAlphaChannel ? 1.0f : brightness * valueOf(channel.id)[component];
    p.values[i] = channel.times_alpha ? value * alpha : alpha > channel.least_alpha ? value : 0;
  }
  return p;
}

RendererAbilities fakeAbilities(const char* id) {
  RendererAbilities a;
  a.id = id;
  a.title = id;
  for (const ChannelInfo& c : shownChannels()) a.channels.push_back(c.id);
  a.channels.emplace_back(kAlphaChannel);
  a.lights = {{"environment", true}};
  return a;
}

// What a test and the renderer of a view have in common.
struct Stage {
  std::mutex mutex;
  std::condition_variable changed;
  int allowed = 0;  // pictures of a draw that may be given
  int given = 0, cancelled = 0, made = 0;

  void allow(int pictures) {
    const std::lock_guard lock(mutex);
    allowed = pictures;
    changed.notify_all();
  }
  int count(int Stage::*what) {
    const std::lock_guard lock(mutex);
    return this->*what;
  }
};

// Three pictures a draw, each brighter; from the second on it waits until the test allows it or it is
// stopped.
class RefiningRenderer final : public SceneRenderer {
 public:
  explicit RefiningRenderer(std::shared_ptr<Stage> stage) : stage_(std::move(stage)) {
    abilities_.refines = true;
  }
  const RendererAbilities& abilities() const override { return abilities_; }

 private:
  void doLoad(const RenderScene&, const Progress&) override {}
  void doDraw(const Camera& camera, std::span<const ChannelInfo> channels, Progress& progress,
              const OnPicture& on_picture) override {
    for (int i = 1; i <= 3; ++i) {
      if (i > 1) waitFor(i, progress);
      RenderedPicture picture;
      picture.camera = camera;
      picture.samples = i;
      picture.final = i == 3;
      for (const ChannelInfo& c : channels)
        picture.channels.push_back(
            {c.id, std::make_shared<const Planes>(planesOf(c, camera, static_cast<float>(i) / 3)), 0});
      on_picture(std::move(picture));
      const std::lock_guard lock(stage_->mutex);
      ++stage_->given;
    }
  }
  void waitFor(int picture, Progress& progress) {
    std::unique_lock lock(stage_->mutex);
    while (stage_->allowed < picture && !progress.stopRequested())
      stage_->changed.wait_for(lock, std::chrono::milliseconds(5));
    if (!progress.stopRequested()) return;
    ++stage_->cancelled;
    throw Cancelled();
  }

  RendererAbilities abilities_ = fakeAbilities("refining");
  std::shared_ptr<Stage> stage_;
};

class TextureRenderer final : public SceneRenderer {
 public:
  explicit TextureRenderer(std::shared_ptr<Stage> stage) : stage_(std::move(stage)) {
    abilities_.needs_context = true;
    ++stage_->made;
  }
  ~TextureRenderer() override { release(); }
  const RendererAbilities& abilities() const override { return abilities_; }

 private:
  void doLoad(const RenderScene&, const Progress&) override { currentGl(); }
  void doDraw(const Camera& camera, std::span<const ChannelInfo> channels, Progress&,
              const OnPicture& on_picture) override {
    release();
    RenderedPicture picture;
    picture.camera = camera;
    for (const ChannelInfo& c : channels) {
      textures_.push_back(upload(planesOf(c, camera, 1), camera.width));
      picture.channels.push_back({c.id, nullptr, textures_.back()});
    }
    on_picture(std::move(picture));
    ++stage_->given;
  }
  static GLuint upload(const Planes& p, int width) {
    std::vector<vec4> pixels(p.planeSize());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      for (int c = 0; c < 3; ++c) pixels[i][c] = p.plane(std::min(c, p.channels - 1))[i];
      pixels[i].w = alphaOf(static_cast<int>(i) % width, width);
    }
    auto& gl = currentGl();
    GLuint texture = 0;
    gl.glGenTextures(1, &texture);
    gl.glBindTexture(GL_TEXTURE_2D, texture);
    gl.glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, p.width, p.height, 0, GL_RGBA, GL_FLOAT, pixels.data());
    return texture;
  }
  void release() {
    if (!textures_.empty())
      currentGl().glDeleteTextures(static_cast<int>(textures_.size()), textures_.data());
    textures_.clear();
  }

  RendererAbilities abilities_ = fakeAbilities("texture");
  std::shared_ptr<Stage> stage_;
  std::vector<GLuint> textures_;
};

template <class Renderer>
SceneRendererFactory factory(std::shared_ptr<Stage> stage) {
  return [stage] { return std::make_unique<Renderer>(stage); };
}

std::shared_ptr<const Environment> greySky() {
  return std::make_shared<const Environment>(makeEnvironment(Image<vec3>(16, 8, vec3(0.4f, 0.5f, 0.6f))));
}

void showBalls(SplatView& view) {
  view.resize(400, 300);
  view.show();
  const auto cloud = threeBalls();
  view.setScene(sceneOf(cloud, plainMaterials(cloud->size())), "frame 0");
  view.setLight(greySky(), "grey");
}

TEST(RefiningRenderer, IsShownPictureByPicture) {
  const auto stage = std::make_shared<Stage>();
  SplatView view(factory<RefiningRenderer>(stage));
  showBalls(view);
  ASSERT_TRUE(waitFor([&] { return view.upToDate(); }));
  EXPECT_FALSE(view.settled()) << "better ones are to come";
  const float first = meanColor(view.picture(), kLeft).x;
  stage->allow(3);
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  EXPECT_GT(meanColor(view.picture(), kLeft).x, first + 30);
}

TEST(RefiningRenderer, GivesWayToANewerWishOnceItGaveAPicture) {
  const auto stage = std::make_shared<Stage>();
  SplatView view(factory<RefiningRenderer>(stage));
  showBalls(view);
  ASSERT_TRUE(waitFor([&] { return view.upToDate() && stage->count(&Stage::given) > 0; }));
  const int before = stage->count(&Stage::cancelled);
  view.setChannel(channelOf(kNormalChannel));
  ASSERT_TRUE(waitFor([&] { return stage->count(&Stage::cancelled) > before; }));
  ASSERT_TRUE(waitFor([&] { return view.upToDate(); }));
  EXPECT_TRUE(view.words().foot.isEmpty()) << "to be overtaken is no error";
  stage->allow(3);
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
}

TEST(RefiningRenderer, DoesNotHoldUpAViewThatGoes) {
  const auto stage = std::make_shared<Stage>();
  {
    SplatView view(factory<RefiningRenderer>(stage));
    showBalls(view);
    ASSERT_TRUE(waitFor([&] { return stage->count(&Stage::given) > 0; }));
  }
  EXPECT_GT(stage->count(&Stage::cancelled), 0);
}

// The two ways to the screen, values of the host and textures, must show the same.
TEST(TextureRenderer, ShowsWhatValuesOfTheHostWouldShow) {
  const auto open = std::make_shared<Stage>(), stage = std::make_shared<Stage>();
  open->allow(3);
  SplatView host(factory<RefiningRenderer>(open)), texture(factory<TextureRenderer>(stage));
  for (SplatView* view : {&host, &texture}) {
    showBalls(*view);
    view->setExposure(0.5f);
  }
  for (const bool sky : {false, true}) {
    for (const ChannelInfo& channel : shownChannels()) {
      std::vector<QImage> pictures;
      for (SplatView* view : {&host, &texture}) {
        view->setSky(sky);
        view->setChannel(channel);
        ASSERT_TRUE(waitFor([&] { return view->settled(); })) << channel.id;
        pictures.push_back(view->picture());
      }
      for (const QRectF& part : {kLeft, kRight}) {
        const vec3 a = meanColor(pictures[0], part), b = meanColor(pictures[1], part);
        EXPECT_LT(glm::distance(a, b), 2.5f) << channel.id << (sky ? " with sky" : "");
      }
    }
  }
}

// Else its words come out as noise.
TEST(TextureRenderer, HoldsTheLimitsOfDepthForDepthAlone) {
  const auto open = std::make_shared<Stage>(), stage = std::make_shared<Stage>();
  open->allow(3);
  SplatView host(factory<RefiningRenderer>(open)), texture(factory<TextureRenderer>(stage));
  std::vector<QImage> pictures;
  for (SplatView* view : {&host, &texture}) {
    showBalls(*view);
    view->setChannel(channelOf(kDepthChannel));
    ASSERT_TRUE(waitFor([&] { return view->settled(); }));
    view->lockDepth(true);
    ASSERT_TRUE(view->state().depth_limits);
    view->setChannel(channelOf(kRoughnessChannel));
    ASSERT_TRUE(waitFor([&] { return view->settled(); }));
    pictures.push_back(view->picture());
  }
  EXPECT_LT(glm::distance(meanColor(pictures[0], kLeft), meanColor(pictures[1], kLeft)), 2.5f);
}

TEST(TextureRenderer, LeavesUploadsToQPainterAsTheyAre) {
  const auto stage = std::make_shared<Stage>();
  SplatView view(factory<TextureRenderer>(stage));
  showBalls(view);
  for (const ChannelInfo& channel : shownChannels()) {
    view.setChannel(channel);
    ASSERT_TRUE(waitFor([&] { return view.settled(); }));
    view.picture();
    view.makeCurrent();
    GLint alignment = 0;
    currentGl().glGetIntegerv(GL_UNPACK_ALIGNMENT, &alignment);
    view.doneCurrent();
    EXPECT_EQ(alignment, 4) << channel.id;
  }
}

TEST(TextureRenderer, AnswersThePointerAndTheFocus) {
  const auto stage = std::make_shared<Stage>();
  SplatView view(factory<TextureRenderer>(stage));
  showBalls(view);
  view.setChannel(channelOf(kOcclusionChannel));
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  QString said;
  QObject::connect(&view, &SplatView::hovered, &view, [&](const QString& words) { said = words; });
  QMouseEvent move(QEvent::MouseMove, QPointF(60, 150), Qt::NoButton, Qt::NoButton, Qt::NoModifier);
  QApplication::sendEvent(&view, &move);
  EXPECT_TRUE(said.contains("Ambient occlusion 0.700")) << said.toStdString();
  EXPECT_TRUE(said.contains("alpha 0.75")) << said.toStdString();
  const vec3 before = view.state().orbit.target_m;
  view.focusAt(QPointF(390, 150));
  EXPECT_EQ(view.state().orbit.target_m, before) << "nothing is there";
  view.focusAt(QPointF(60, 150));
  const dvec3 target(view.state().orbit.target_m);
  EXPECT_NE(view.state().orbit.target_m, before);
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  EXPECT_GT(glm::distance(target, dvec3(before)), 0.1);
}

TEST(TextureRenderer, DrawsOnlyWhatIsAskedForAndOnceEach) {
  const auto stage = std::make_shared<Stage>();
  SplatView view(factory<TextureRenderer>(stage));
  showBalls(view);
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  const int drawn = stage->given;
  for (int i = 0; i < 3; ++i) view.picture();  // painted again, nothing new
  QApplication::processEvents();
  EXPECT_EQ(stage->given, drawn);
  view.setYaw(0.4f);
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  EXPECT_GT(stage->given, drawn);
}

TEST(AnyRenderer, IsNamedWithWhatItDoesNotDraw) {
  class Poor final : public SceneRenderer {
   public:
    Poor() { abilities_.id = "poor", abilities_.channels = {kRgbChannel}; }
    const RendererAbilities& abilities() const override { return abilities_; }

   private:
    void doLoad(const RenderScene&, const Progress&) override {}
    void doDraw(const Camera& camera, std::span<const ChannelInfo> channels, Progress&,
                const OnPicture& on_picture) override {
      RenderedPicture picture;
      picture.camera = camera;
      for (const ChannelInfo& c : channels)
        picture.channels.push_back({c.id, std::make_shared<const Planes>(planesOf(c, camera, 1)), 0});
      on_picture(std::move(picture));
    }
    RendererAbilities abilities_;
  };
  SplatView view([] { return std::make_unique<Poor>(); });
  showBalls(view);
  view.setLight(nullptr, {});
  view.setChannel(channelOf(kRgbChannel));
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  view.picture();
  EXPECT_TRUE(view.words().foot.isEmpty());
  view.setLight(greySky(), "grey");
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  view.picture();
  EXPECT_FALSE(view.words().foot.isEmpty()) << "it knows no panorama";
  view.setLight(nullptr, {});
  view.setChannel(channelOf(kNormalChannel));
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  view.picture();
  EXPECT_FALSE(view.words().foot.isEmpty()) << "it draws no normals";
  view.setChannel(channelOf(kRgbChannel));
  ASSERT_TRUE(waitFor([&] { return view.settled(); }));
  EXPECT_GT(meanColor(view.picture(), kLeft).x, 100);
}

}  // namespace
}  // namespace beam::testing
