// SPDX-License-Identifier: Apache-2.0
// Requests of a view for a picture of a scene, answered through a scene renderer: what cannot be shown is
// replaced and named, values of the host become pixels of the screen. On a background thread, or, where the
// renderer needs one, with the view's context current.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/render/scene_renderer.h"
#include "viewers/false_color.h"
#include "viewers/view_state.h"

namespace beam {

struct SplatRequest {
  RenderScene scene;
  Camera camera;
  ChannelInfo channel = channelOf(kRelightChannel);
  float exposure_stops = 0;
  bool sky = false;
  std::optional<Limits> depth_limits;  // nothing: of the picture itself
};

struct SplatPicture {
  Image<u8vec4> pixels;      // sRGB; empty: the channel is a texture, or there is none
  RenderedPicture rendered;  // what is shown, where the scene has it, with alpha and depth
  Image<vec3> sky;           // linear, of a texture's picture; empty: the backdrop
  ChannelInfo channel = channelOf(kRgbChannel);  // what is shown: colour where relit could not be
  Limits limits;
  ChannelInfo wanted = channelOf(kRelightChannel);
  float exposure_stops = 0;
  Lack lack = Lack::None;             // of what was wanted
  std::vector<std::string> left_out;  // of the scene, a sentence each
  std::string error;                  // why there is no picture; empty: there is one
  double milliseconds = 0;            // to the first picture of the request
};

// The values of a channel that is on the host; empty where it is not.
const Planes& valuesIn(const SplatPicture& picture, std::string_view channel);

class SplatRenderer {
 public:
  explicit SplatRenderer(std::unique_ptr<SceneRenderer> renderer);
  const RendererAbilities& abilities() const { return renderer_->abilities(); }

  using OnPicture = std::function<void(SplatPicture)>;
  // Not thread-safe: one thread at a time. Throws what SceneRenderer does.
  void render(const SplatRequest& request, Progress& progress, const OnPicture& on_picture);

 private:
  std::unique_ptr<SceneRenderer> renderer_;
};

// The limits that do not hang on the picture; nothing: they are robustLimits() of its values.
std::optional<Limits> fixedLimits(const SplatRequest& request, const ChannelInfo& channel);

}  // namespace beam
