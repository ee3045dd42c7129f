// SPDX-License-Identifier: Apache-2.0
// How the splat view comes to its pictures: wishes go to a background thread, or wait for the context that
// the renderer needs; the newest alone counts.
#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "viewers/splat/channel_painter.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

constexpr double kNewest = 0.3;  // weight of the newest time in their mean

}  // namespace

// A draw that gave a picture and refines it ends when there is a newer wish; one that has given none is
// waited for, else nothing would be seen while wishes come fast.
struct SplatView::Drawing {
  std::stop_source stop;
  std::atomic<bool> gave = false;
};

void SplatView::newContext() {
  channel_painter_ = std::make_unique<ChannelPainter>();
  if (!renderer_->abilities().needs_context) return;
  renderer_ = std::make_shared<SplatRenderer>(new_renderer_());
  if (hasScene()) request(1);
}

void SplatView::leaveContext() {
  ++newest_ticket_;
  if (drawing_) drawing_->stop.request_stop();
  if (context() == nullptr) return;
  makeCurrent();
  channel_painter_ = nullptr;
  if (renderer_->abilities().needs_context) renderer_ = nullptr;
  doneCurrent();
}

void SplatView::request(int divisor) {
  if (!hasScene() || width() < 8 || height() < 8) return;
  if (divisor == 1) rest_timer_.stop();
  const double ratio = devicePixelRatioF();
  const int w = std::max(8, static_cast<int>(width() * ratio) / divisor);
  const int h = std::max(8, static_cast<int>(height() * ratio) / divisor);
  RenderScene scene = scene_;
  scene.lighting.environment.rotation_deg = glm::degrees(static_cast<double>(state_.yaw_rad));
  const Wish wish{.request = {.scene = std::move(scene),
                              .camera = cameraFor(w, h),
                              .channel = state_.channel,
                              .exposure_stops = state_.exposure_stops,
                              .sky = state_.sky,
                              .depth_limits = state_.depth_limits},
                  .divisor = divisor,
                  .ticket = ++newest_ticket_,
                  .caption = caption_};
  if (drawing_ && drawing_->gave) drawing_->stop.request_stop();
  drawing_ = std::make_shared<Drawing>();
  if (renderer_->abilities().needs_context) {
    waiting_ = wish;
    return update();
  }
  worker_.submit([this, wish, drawing = drawing_, renderer = renderer_] {
    answer(wish, *renderer, *drawing, [this, wish](SplatPicture picture) {
      auto held = std::make_shared<SplatPicture>(std::move(picture));
      QMetaObject::invokeMethod(
          this, [this, held, wish] { take(std::move(*held), wish); }, Qt::QueuedConnection);
    });
  });
}

void SplatView::answer(const Wish& wish, SplatRenderer& renderer, Drawing& drawing,
                       const SplatRenderer::OnPicture& on_picture) {
  try {
    Progress progress(drawing.stop.get_token());
    renderer.render(wish.request, progress, [&](SplatPicture picture) {
      on_picture(std::move(picture));
      drawing.gave = true;
      if (newest_ticket_ != wish.ticket) drawing.stop.request_stop();
    });
  } catch (const Cancelled&) {         // a newer wish has taken its place
  } catch (const std::exception& e) {  // the border of this thread: the view says it instead of a picture
    SplatPicture picture;
    picture.channel = picture.wanted = wish.request.channel;
    picture.error = e.what();
    on_picture(std::move(picture));
  }
}

bool SplatView::paintUnder(const QRectF& target_px, const QSizeF& framebuffer) {
  if (const auto wish = std::exchange(waiting_, std::nullopt)) {
    answer(*wish, *renderer_, *drawing_, [&](SplatPicture picture) { take(std::move(picture), *wish); });
    auto& gl = currentGl();
    gl.glBindFramebuffer(GL_FRAMEBUFFER, defaultFramebufferObject());
    gl.glViewport(0, 0, static_cast<int>(framebuffer.width()), static_cast<int>(framebuffer.height()));
  }
  const std::uint32_t texture = shownTexture();
  if (texture == 0) return false;
  channel_painter_->draw(texture, shown_.channel, shown_.sky,
                         {.exposure_stops = shown_.exposure_stops, .limits = shown_.limits}, target_px,
                         framebuffer);
  return true;
}

void SplatView::take(SplatPicture picture, const Wish& wish) {
  if (!hasScene()) return;
  shown_ = std::move(picture);
  shown_ticket_ = wish.ticket;
  shown_caption_ = wish.caption;
  shown_divisor_ = wish.divisor;
  read_back_.clear();
  if (shownTexture() != 0 && !fixedLimits(wish.request, shown_.channel))
    shown_.limits = robustLimits(hostValues(shown_.channel.id).values);
  if (wish.divisor == 2 && passing_ == 2 && shown_.milliseconds > 0)
    half_milliseconds_ = std::lerp(halfPictureMilliseconds(), shown_.milliseconds, kNewest);
  if (wish.divisor == 1 && shown_.milliseconds > 0) full_milliseconds_ = shown_.milliseconds;
  setPicture(0, shown_.pixels.empty() ? nullptr : std::make_shared<Image<u8vec4>>(std::move(shown_.pixels)));
  if (pointer_ && (shownTexture() == 0 || settled())) reportHover(*pointer_);  // reading back takes a moment
  Q_EMIT pictureShown();
}

std::uint32_t SplatView::shownTexture() const {
  const RenderedChannel* shown = channelIn(shown_.rendered, shown_.channel.id);
  return shown && !shown->values ? shown->texture : 0;
}

// Alpha comes with every texture.
const Planes& SplatView::hostValues(std::string_view channel) {
  const RenderedChannel* found = channelIn(shown_.rendered, channel);
  if (!found && channel == kAlphaChannel) found = channelIn(shown_.rendered, shown_.channel.id);
  if (!found || found->values) return valuesIn(shown_, channel);
  if (!read_back_.contains(found->id)) {
    makeCurrent();
    Planes alpha;
    const int components = found->id == shown_.channel.id ? componentsOf(shown_.channel) : 1;
    read_back_[found->id] = readTexture(found->texture, components, alpha);
    read_back_.try_emplace(kAlphaChannel, std::move(alpha));
  }
  return read_back_.find(channel)->second;
}

bool SplatView::settled() const {
  return !hasScene() || (shown_ticket_ == newest_ticket_ && shown_divisor_ == 1 && shown_.rendered.final);
}

}  // namespace beam
