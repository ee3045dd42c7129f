// SPDX-License-Identifier: Apache-2.0
// Requests for a picture of Gaussians, answered on a background thread's own time: the G-buffer is made anew
// only when Gaussians or camera change, shading only when light changes, the channel's picture always.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/render/deferred.h"
#include "viewers/false_color.h"
#include "viewers/view_state.h"

namespace beam {

struct SplatScene {
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<const Materials> materials;  // null: not there yet
};

struct SplatRequest {
  SplatScene scene;
  Camera camera;
  Channel channel = Channel::Lit;
  std::shared_ptr<const PreparedLight> light;  // null: none chosen
  float yaw_rad = 0;
  float exposure_stops = 0;
  bool sky = false;
  std::optional<Limits> depth_limits;  // nothing: of the picture itself
};

// What a channel that was asked for cannot be shown without.
enum class Lack { None, Light, Materials };

struct SplatPicture {
  Image<u8vec4> pixels;  // sRGB
  std::shared_ptr<const GBuffer> gbuffer;
  std::shared_ptr<const Image<vec3>> lit;  // linear x alpha; empty image: not lit
  Camera camera;
  Channel channel = Channel::Lit;  // what is shown: Radiance where Lit could not be
  Limits limits;
  Channel wanted = Channel::Lit;
  Lack lack = Lack::None;
  std::string error;  // why there is no picture; empty: there is one
  double milliseconds = 0;
};

class SplatRenderer {
 public:
  explicit SplatRenderer(std::shared_ptr<ComputeDevice> device);
  // Not thread-safe: one thread at a time.
  SplatPicture render(const SplatRequest& request);

 private:
  const GBuffer& gbufferFor(const SplatRequest& request);
  const Image<vec3>& litFor(const SplatRequest& request);

  std::shared_ptr<ComputeDevice> device_;
  GBufferRenderer renderer_;
  std::unique_ptr<ResidentScene> resident_;
  SplatScene scene_;  // of gbuffer_
  Camera camera_;
  std::shared_ptr<const GBuffer> gbuffer_;
  std::shared_ptr<const PreparedLight> lit_by_;
  float lit_yaw_rad_ = 0;
  std::shared_ptr<const Image<vec3>> lit_;
};

}  // namespace beam
