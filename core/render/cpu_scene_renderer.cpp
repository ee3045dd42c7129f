// SPDX-License-Identifier: Apache-2.0
#include "core/render/cpu_scene_renderer.h"

#include <algorithm>
#include <atomic>
#include <map>

#include "core/base/error.h"
#include "core/render/deferred.h"

namespace beam {
namespace {

using Draw = void (RasterView::*)(Planes&) const;

// The channels that come out of the rasterised view as they are.
const std::map<std::string, Draw>& drawnChannels() {
  static const std::map<std::string, Draw> all = {
      {kRgbChannel, &RasterView::radiance},        {kAlphaChannel, &RasterView::alpha},
      {kDepthChannel, &RasterView::depth},         {kNormalChannel, &RasterView::normal},
      {kBaseColorChannel, &RasterView::baseColor}, {kOcclusionChannel, &RasterView::occlusion},
      {kRoughnessChannel, &RasterView::roughness}};
  return all;
}

// Memory of pictures that nobody looks at any more: fresh pages cost more than what is written into them.
class PlanesPool {
 public:
  std::shared_ptr<Planes> take() {
    const auto idle =
        std::find_if(all_.begin(), all_.end(), [](const auto& p) { return p.use_count() == 1; });
    if (idle != all_.end()) {
      std::atomic_thread_fence(std::memory_order_acquire);  // after the last reader let go
      std::rotate(idle, idle + 1, all_.end());
    } else {
      if (all_.size() >= kMost) all_.erase(all_.begin());
      all_.push_back(std::make_shared<Planes>());
    }
    return all_.back();
  }

 private:
  static constexpr std::size_t kMost = 8;
  std::vector<std::shared_ptr<Planes>> all_;  // the newest last
};

class CpuSceneRenderer final : public SceneRenderer {
 public:
  CpuSceneRenderer(std::shared_ptr<ComputeDevice> device, std::shared_ptr<PreparedLights> lights,
                   std::size_t kept_sizes)
      : device_(std::move(device)),
        lights_(lights ? std::move(lights) : std::make_shared<PreparedLights>()),
        renderer_(*device_, kept_sizes),
        resident_(device_->newResidentScene()),
        lamps_(*device_),
        panorama_lamps_(*device_) {
    abilities_.id = "cpu";
    abilities_.title = device_->info().title;
    for (const ChannelInfo& c : channels())
      if (c.id == kRelightChannel || drawnChannels().contains(c.id)) abilities_.channels.push_back(c.id);
    abilities_.attributes = true;
    abilities_.lights = {{"environment", true}};
    for (const std::string& kind : lightKinds()) abilities_.lights.push_back({kind, true});
    abilities_.occlusion = true;
    abilities_.without_visibility = "ambient occlusion alone keeps the panorama's light off";
  }

  const RendererAbilities& abilities() const override { return abilities_; }

 private:
  void doLoad(const RenderScene& scene, const Progress& progress) override {
    if (scene.instances != instances_ || !instances_loaded_) {
      instances_loaded_ = false;
      view_ = nullptr;
      resident_->load(scene.instances);
      lamps_.forget();
      panorama_lamps_.forget();
      instances_ = scene.instances;
      instances_loaded_ = true;
    }
    lighting_ = scene.lighting;
    const auto panorama = lighting_.environment.enabled ? scene.environment : nullptr;
    const PanoramaLamps apart =
        transfers() && resident_->has(kVisibilityName) ? PanoramaLamps::Apart : PanoramaLamps::Within;
    if (panorama == panorama_ && apart == apart_) return;
    light_ = panorama ? lights_->of(panorama, progress, apart) : nullptr;
    panorama_ = panorama;
    apart_ = apart;
  }

  void doDraw(const Camera& camera, std::span<const ChannelInfo> channels, Progress& progress,
              const OnPicture& on_picture) override {
    if (!instances_.empty()) rasterize(camera, channels);
    progress.check();
    RenderedPicture picture;
    picture.camera = camera;
    for (const ChannelInfo& channel : channels) {
      picture.channels.push_back(
          {channel.id, instances_.empty() ? nothing(camera, channel) : valuesOf(channel, progress), 0});
      progress.check();
    }
    on_picture(std::move(picture));
  }

  // Of a scene of meshes alone.
  static std::shared_ptr<const Planes> nothing(const Camera& camera, const ChannelInfo& channel) {
    return std::make_shared<const Planes>(camera.width, camera.height, componentsOf(channel));
  }

  // Of the camera that was drawn last nothing is drawn again.
  void rasterize(const Camera& camera, std::span<const ChannelInfo> channels) {
    std::vector<std::string> further;
    for (const ChannelInfo& c : channels)
      if (!c.attribute.empty() && !drawnChannels().contains(c.id)) further.push_back(c.attribute);
    const bool lit = std::any_of(channels.begin(), channels.end(),
                                 [](const ChannelInfo& c) { return c.id == kRelightChannel; });
    const bool same = view_ && camera_ == camera && further == further_;
    const bool visibility = resident_->has(kVisibilityName) &&
                            ((lit && light_ && transfers()) || (same && view_->hasVisibility()));
    if (same && (!visibility || view_->hasVisibility())) return;
    view_ = nullptr;
    lit_ = nullptr;
    view_ = &renderer_.draw(*resident_, camera, further, visibility);
    camera_ = camera;
    further_ = std::move(further);
  }

  bool transfers() const { return lighting_.environment.shadows != kOcclusionAlone; }

  std::shared_ptr<const Planes> valuesOf(const ChannelInfo& channel, const Progress& progress) {
    if (channel.id == kRelightChannel) return lit(progress);
    auto values = pool_.take();
    const auto drawn = drawnChannels().find(channel.id);
    if (drawn != drawnChannels().end())
      (view_->*drawn->second)(*values);
    else
      view_->attribute(channel.attribute, *values);
    return values;
  }

  // Past lamps that were turned, what the panorama gives stays.
  std::shared_ptr<const Planes> lit(const Progress& progress) {
    std::shared_ptr<const Planes> by_panorama = light_ ? litByPanorama(progress) : nullptr;
    std::shared_ptr<Planes> values;
    const auto begin = [&] {
      values = pool_.take();
      if (by_panorama)
        *values = *by_panorama;
      else
        view_->unlit(*values);
    };
    lamps_.forEach(lampsOf(lighting_), *resident_, progress, [&](const std::vector<ShadedLamp>& lamps) {
      if (!values) begin();
      view_->addLamps(lamps, *values);
    });
    if (!values && by_panorama) return by_panorama;
    if (!values) begin();
    return values;
  }

  std::shared_ptr<const Planes> litByPanorama(const Progress& progress) {
    const EnvironmentLight& environment = lighting_.environment;
    if (lit_ && lit_by_ == light_ && lit_as_ == environment) return lit_;
    lit_ = nullptr;
    std::vector<Lamp> sources;
    for (const LightSource& lamp : LightTurn(*light_, yawOf(environment)).toWorld(light_->lamps))
      sources.push_back({lamp});
    std::vector<ShadedLamp> lamps;
    panorama_lamps_.forEach(sources, *resident_, progress, [&](const std::vector<ShadedLamp>& some) {
      lamps.insert(lamps.end(), some.begin(), some.end());
    });
    auto values = pool_.take();
    view_->relit(*light_,
                 {.yaw_rad = yawOf(environment),
                  .exposure = static_cast<float>(environment.gain),
                  .transfer = transfers()},
                 lamps, *values);
    lit_by_ = light_;
    lit_as_ = environment;
    return lit_ = values;
  }

  std::shared_ptr<ComputeDevice> device_;
  std::shared_ptr<PreparedLights> lights_;
  RendererAbilities abilities_;
  GBufferRenderer renderer_;
  std::unique_ptr<ResidentScene> resident_;
  std::vector<RenderInstance> instances_;
  bool instances_loaded_ = false;
  ShadedLamps lamps_, panorama_lamps_;
  Lighting lighting_;
  std::shared_ptr<const Environment> panorama_;
  PanoramaLamps apart_ = PanoramaLamps::Within;
  std::shared_ptr<const PreparedLight> light_;  // of panorama_ and apart_
  const RasterView* view_ = nullptr;            // of camera_ and further_; null: none yet
  Camera camera_;
  std::vector<std::string> further_;
  std::shared_ptr<const Planes> lit_;  // of view_, lit_by_ and lit_as_; null: none yet
  std::shared_ptr<const PreparedLight> lit_by_;
  EnvironmentLight lit_as_;
  PlanesPool pool_;
};

}  // namespace

std::unique_ptr<SceneRenderer> newCpuSceneRenderer(std::shared_ptr<ComputeDevice> device,
                                                   std::shared_ptr<PreparedLights> lights,
                                                   std::size_t kept_sizes) {
  return std::make_unique<CpuSceneRenderer>(std::move(device), std::move(lights), kept_sizes);
}

std::unique_ptr<SceneRenderer> newCpuSceneRenderer(ComputeDevice& device) {
  return newCpuSceneRenderer(std::shared_ptr<ComputeDevice>(std::shared_ptr<void>(), &device));
}

SceneRendererFactory cpuSceneRenderers(std::shared_ptr<ComputeDevice> device, std::size_t kept_sizes) {
  return [device = std::move(device), lights = std::make_shared<PreparedLights>(), kept_sizes] {
    return newCpuSceneRenderer(device, lights, kept_sizes);
  };
}

}  // namespace beam
