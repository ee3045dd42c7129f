// SPDX-License-Identifier: Apache-2.0
// SceneRenderer: a scene, a camera and the names of channels in, pictures out. The one door through which
// windows and the command line draw; what is behind it may compute on the CPU, in OpenGL, or path by path.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/scene/camera.h"
#include "core/scene/channel.h"
#include "core/scene/render_scene.h"

namespace beam {

struct LightAbility {
  std::string kind;      // "environment", or one of lightKinds()
  bool shadows = false;  // it casts some
};

// What a renderer can do; fixed for its life.
struct RendererAbilities {
  std::string id;     // as typed: "cpu"
  std::string title;  // as shown
  std::vector<std::string> channels;
  bool attributes = false;  // also any channel that is an attribute of the Gaussians
  std::vector<LightAbility> lights;
  bool meshes = false, ground = false;
  // An OpenGL context must be current, the same one in load, draw and at its end.
  bool needs_context = false;
  bool occlusion = false;               // EnvironmentLight::shadows may tell it to shade by ambient occlusion
  std::string without_visibility = {};  // what of light is worse where it was not baked, in words
  std::string settings = {};  // what else its pictures depend on, in words; the same give the same pictures
  bool refines = false;       // a draw gives picture after picture, each better than the one before
};
bool draws(const RendererAbilities& abilities, const ChannelInfo& channel);

// A channel of a picture: values as its row of the table says, in world axes and metres, on the host or in a
// texture of the context that was current: R G B are the values (R of a lone one), A is alpha, in any format
// that a shader reads as numbers; the first row is the top of the picture. A texture is valid until the next
// load or draw and belongs to the renderer.
struct RenderedChannel {
  std::string id;
  std::shared_ptr<const Planes> values;  // null: it is a texture
  std::uint32_t texture = 0;
};

struct RenderedPicture {
  Camera camera;
  std::vector<RenderedChannel> channels;  // in the order in which they were asked for
  int samples = 1;                        // of a pixel so far
  bool final = true;                      // none follows of this draw
};
const RenderedChannel* channelIn(const RenderedPicture& picture, std::string_view id);  // null: not in it

// One thread at a time. What a renderer refuses is an Error{Usage}, a mistake of its caller an Error{Bug}.
class SceneRenderer {
 public:
  using OnPicture = std::function<void(RenderedPicture)>;

  virtual ~SceneRenderer() = default;
  virtual const RendererAbilities& abilities() const = 0;

  // What is drawn from now on; costs what is new in it. Returns what of it will not be seen, or not as it is
  // meant, a sentence each.
  // Throws Cancelled when the progress is stopped, and must be called again then.
  std::vector<std::string> load(const RenderScene& scene, const Progress& progress = Progress{});

  // Calls `onPicture` once, or more often where it refines, the last time with `final`. Throws Error{Usage}
  // for a channel that it does not draw, Error{Bug} for one that the scene lacks what it needs (lackOf) or
  // before a load, Cancelled when the progress is stopped.
  void draw(const Camera& camera, std::span<const ChannelInfo> channels, Progress& progress,
            const OnPicture& on_picture);

 private:
  virtual void doLoad(const RenderScene& scene, const Progress& progress) = 0;
  virtual void doDraw(const Camera& camera, std::span<const ChannelInfo> channels, Progress& progress,
                      const OnPicture& on_picture) = 0;

  RenderScene scene_;
  std::vector<std::string> inside_;  // of its lights, a sentence each
  bool loaded_ = false;
};

using SceneRendererFactory = std::function<std::unique_ptr<SceneRenderer>()>;

// Whether the panorama's light was to come past the visibility of Gaussians and there are some without
// (RendererAbilities::without_visibility).
bool lacksVisibility(const RenderScene& scene, const RendererAbilities& abilities);

// What of the scene a renderer of these abilities leaves out, and what the scene itself misses.
std::vector<std::string> leftOut(const RenderScene& scene, const RendererAbilities& abilities);

}  // namespace beam
