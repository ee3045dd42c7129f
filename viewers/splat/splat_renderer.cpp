// SPDX-License-Identifier: Apache-2.0
#include "viewers/splat/splat_renderer.h"

#include <chrono>

#include "core/base/parallel.h"
#include "viewers/splat/channel_picture.h"

namespace beam {
namespace {

bool same(const Camera& a, const Camera& b) {
  const Intrinsics &i = a.intrinsics, &j = b.intrinsics;
  return a.width == b.width && a.height == b.height && i.fx == j.fx && i.fy == j.fy && i.cx == j.cx &&
         i.cy == j.cy && a.camera_from_world.rotation == b.camera_from_world.rotation &&
         a.camera_from_world.translation_m == b.camera_from_world.translation_m;
}

Image<vec3> skyOf(const Camera& camera, const PreparedLight& light, float yaw_rad) {
  Image<vec3> sky(camera.width, camera.height, vec3(0), Encoding::Linear);
  const dquat world_from_camera = glm::conjugate(camera.camera_from_world.rotation);
  parallelFor(camera.height, 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const dvec3 ray = glm::normalize(rayOf(camera.intrinsics, {x + 0.5, y + 0.5}));
        sky(x, y) = light.background(vec3(world_from_camera * ray), yaw_rad);
      }
    }
  });
  return sky;
}

Lack lackOf(const SplatRequest& request) {
  switch (request.channel) {
    case Channel::Lit:
      return !request.scene.materials ? Lack::Materials : !request.light ? Lack::Light : Lack::None;
    case Channel::BaseColor:
    case Channel::AmbientOcclusion:
    case Channel::Roughness:
      return request.scene.materials ? Lack::None : Lack::Materials;
    default:
      return Lack::None;
  }
}

}  // namespace

SplatRenderer::SplatRenderer(std::shared_ptr<ComputeDevice> device)
    : device_(std::move(device)),
      renderer_(*device_, 2),  // of the moving and of the resting picture
      resident_(device_->newResidentScene()) {}

const GBuffer& SplatRenderer::gbufferFor(const SplatRequest& r) {
  const bool kept = gbuffer_ && scene_.cloud == r.scene.cloud && scene_.materials == r.scene.materials &&
                    same(camera_, r.camera);
  if (!kept) {
    resident_->load({{.cloud = r.scene.cloud, .materials = r.scene.materials, .attributes = nullptr}});
    gbuffer_ = std::make_shared<GBuffer>(renderer_.render(*resident_, r.camera));
    lit_ = nullptr;
    scene_ = r.scene;
    camera_ = r.camera;
  }
  return *gbuffer_;
}

const Image<vec3>& SplatRenderer::litFor(const SplatRequest& r) {
  if (!lit_ || lit_by_ != r.light || lit_yaw_rad_ != r.yaw_rad) {
    lit_by_ = r.light;
    lit_yaw_rad_ = r.yaw_rad;
    lit_ = std::make_shared<Image<vec3>>(shade(*gbuffer_, r.camera, *r.light, {.yaw_rad = r.yaw_rad}));
  }
  return *lit_;
}

SplatPicture SplatRenderer::render(const SplatRequest& r) {
  const auto start = std::chrono::steady_clock::now();
  SplatPicture picture;
  picture.camera = r.camera;
  picture.wanted = r.channel;
  picture.lack = lackOf(r);
  const bool dark = r.channel == Channel::Lit && picture.lack != Lack::None;
  picture.channel = dark ? Channel::Radiance : r.channel;
  const GBuffer& gbuffer = gbufferFor(r);
  static const auto none = std::make_shared<const Image<vec3>>();
  const Image<vec3>& lit = picture.channel == Channel::Lit ? litFor(r) : *none;
  if (picture.channel == Channel::Depth)
    picture.limits = r.depth_limits ? *r.depth_limits : robustLimits(gbuffer.depth_m.pixels);
  const Image<vec3> sky = r.sky && r.light ? skyOf(r.camera, *r.light, r.yaw_rad) : Image<vec3>();
  picture.pixels = channelPicture(
      gbuffer, lit, sky,
      {.channel = picture.channel, .exposure_stops = r.exposure_stops, .limits = picture.limits});
  picture.gbuffer = gbuffer_;
  picture.lit = picture.channel == Channel::Lit ? lit_ : none;
  picture.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return picture;
}

}  // namespace beam
