// SPDX-License-Identifier: Apache-2.0
#include "core/render/scene_renderer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/base/error.h"
#include "core/render/shadow_map.h"
#include "core/scene/light_source.h"
#include "core/scene/thin_axis.h"

namespace beam {
namespace {

const LightAbility* abilityOf(const RendererAbilities& abilities, std::string_view kind) {
  const auto found = std::find_if(abilities.lights.begin(), abilities.lights.end(),
                                  [&](const LightAbility& a) { return a.kind == kind; });
  return found == abilities.lights.end() ? nullptr : &*found;
}

std::string nameOf(const Light& light) { return light.title.empty() ? light.id : light.title; }

constexpr std::ptrdiff_t kNearest = 16;

// Whether most of the dense Gaussians next to it turn their outer sides away from it; false where sides are
// unknown.
bool isInside(const RenderInstance& instance, vec3 world_m) {
  const Attribute* side = attributeNamed(*instance.attributes, kNormalSideName);
  const GaussianCloud& cloud = *instance.cloud;
  if (!side) return false;
  const auto x_m = vec3(inverse(instance.world_from_cloud) * dvec3(world_m));
  std::vector<std::pair<float, std::size_t>> nearest;  // squared distances
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const vec3 d = cloud.position_m[i] - x_m;
    if (cloud.opacity[i] >= kCastingAlpha) nearest.emplace_back(glm::dot(d, d), i);
  }
  if (std::ssize(nearest) < kNearest) return false;
  const auto end = nearest.begin() + kNearest;
  std::nth_element(nearest.begin(), end - 1, nearest.end());
  const auto away = std::count_if(nearest.begin(), end, [&](const auto& n) {
    return side->values[n.second] * glm::dot(thinAxis(cloud, n.second), x_m - cloud.position_m[n.second]) < 0;
  });
  return away > kNearest / 2;
}

std::vector<std::string> lightsInside(const RenderScene& scene) {
  std::vector<std::string> sentences;
  for (const Light& light : scene.lighting.lights) {
    const std::vector<LightSource> sources = light.enabled ? sourcesOf(light) : std::vector<LightSource>();
    const bool inside = std::any_of(sources.begin(), sources.end(), [&](const LightSource& s) {
      return !s.far && std::any_of(scene.instances.begin(), scene.instances.end(),
                                   [&](const RenderInstance& i) { return isInside(i, s.position_m); });
    });
    if (inside) sentences.push_back(fmt::format("light \"{}\" is inside the subject", nameOf(light)));
  }
  return sentences;
}

void addLights(const Lighting& lighting, const RendererAbilities& abilities,
               std::vector<std::string>& sentences) {
  for (const Light& light : lighting.lights) {
    if (!light.enabled) continue;
    const LightAbility* ability = abilityOf(abilities, kindOf(light));
    if (!ability) {
      sentences.push_back(fmt::format("light \"{}\" ({}) is not drawn by the renderer {}", nameOf(light),
                                      kindOf(light), abilities.id));
    } else if (castsShadows(light) && !ability->shadows) {
      sentences.push_back(fmt::format("light \"{}\" ({}) casts no shadows in the renderer {}", nameOf(light),
                                      kindOf(light), abilities.id));
    }
  }
}

}  // namespace

bool draws(const RendererAbilities& abilities, const ChannelInfo& channel) {
  const auto& ids = abilities.channels;
  return (abilities.attributes && !channel.attribute.empty()) ||
         std::find(ids.begin(), ids.end(), channel.id) != ids.end();
}

const RenderedChannel* channelIn(const RenderedPicture& picture, std::string_view id) {
  const auto found = std::find_if(picture.channels.begin(), picture.channels.end(),
                                  [&](const RenderedChannel& c) { return c.id == id; });
  return found == picture.channels.end() ? nullptr : &*found;
}

bool lacksVisibility(const RenderScene& scene, const RendererAbilities& abilities) {
  const EnvironmentLight& light = scene.lighting.environment;
  if (!light.enabled || (abilities.occlusion && light.shadows == kOcclusionAlone)) return false;
  return std::any_of(scene.instances.begin(), scene.instances.end(), [](const RenderInstance& i) {
    return i.materials && !attributeNamed(*i.attributes, kVisibilityName);
  });
}

std::vector<std::string> leftOut(const RenderScene& scene, const RendererAbilities& abilities) {
  std::vector<std::string> sentences = scene.missing;
  if (scene.environment && scene.lighting.environment.enabled && !abilityOf(abilities, "environment"))
    sentences.push_back(fmt::format("light from all around is not drawn by the renderer {}", abilities.id));
  addLights(scene.lighting, abilities, sentences);
  if (!scene.meshes.empty() && !abilities.meshes)
    sentences.push_back(fmt::format("meshes are not drawn by the renderer {}", abilities.id));
  if (scene.ground.enabled && !abilities.ground)
    sentences.push_back(fmt::format("the ground is not drawn by the renderer {}", abilities.id));
  return sentences;
}

std::vector<std::string> SceneRenderer::load(const RenderScene& scene, const Progress& progress) {
  loaded_ = false;
  doLoad(scene, progress);
  if (scene.instances != scene_.instances || scene.lighting.lights != scene_.lighting.lights)
    inside_ = lightsInside(scene);
  scene_ = scene;
  loaded_ = true;
  std::vector<std::string> sentences = leftOut(scene, abilities());
  sentences.insert(sentences.end(), inside_.begin(), inside_.end());
  return sentences;
}

void SceneRenderer::draw(const Camera& camera, std::span<const ChannelInfo> channels, Progress& progress,
                         const OnPicture& on_picture) {
  if (!loaded_) throw Error(Error::Kind::Bug, "scene renderer: draw before load");
  for (const ChannelInfo& channel : channels) {
    if (!draws(abilities(), channel)) {
      throw Error(Error::Kind::Usage,
                  fmt::format("the renderer {} does not draw {}: it draws {}", abilities().id, channel.id,
                              fmt::join(abilities().channels, ", ")));
    }
    if (lackOf(channel, scene_) != Lack::None) {
      throw Error(Error::Kind::Bug, fmt::format("scene renderer: the scene lacks what {} needs", channel.id));
    }
  }
  progress.check();
  doDraw(camera, channels, progress, on_picture);
}

}  // namespace beam
