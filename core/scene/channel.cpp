// SPDX-License-Identifier: Apache-2.0
#include "core/scene/channel.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/scene/gbuffer.h"

namespace beam {
namespace {

std::vector<ChannelInfo> table() {
  using enum Quantity;
  using enum ChannelNeeds;
  return {
      {.id = kRgbChannel,
       .title = "Colour",
       .legend = "as photographed, sRGB",
       .key = 2,
       .quantity = Color,
       .encoding = Encoding::Srgb,
       .file = FileForm::Png},
      {.id = kRelightChannel,
       .title = "Relit",
       .legend = "in the chosen light, sRGB",
       .key = 1,
       .quantity = Color,
       .encoding = Encoding::Linear,
       .needs = MaterialsAndLight,
       .file = FileForm::Png},
      {.id = kBaseColorChannel,
       .title = "Base colour",
       .legend = "reflectance, sRGB",
       .key = 3,
       .quantity = Color,
       .encoding = Encoding::Linear,
       .needs = Materials,
       .attribute = kBaseColorName},
      {.id = kOcclusionChannel,
       .title = "Ambient occlusion",
       .legend = "0 to 1, grey",
       .key = 4,
       .needs = Materials,
       .attribute = kOcclusionName},
      {.id = kRoughnessChannel,
       .title = "Roughness",
       .legend = "0 to 1",
       .key = 5,
       .needs = Materials,
       .attribute = kRoughnessName,
       .false_color = true},
      {.id = kNormalChannel,
       .title = "Normal",
       .legend = "world, x y z as r g b, −1 to 1",
       .key = 6,
       .quantity = Direction,
       .times_alpha = false,
       .least_alpha = kVisibleAlpha},
      {.id = kDepthChannel,
       .title = "Depth",
       .legend = "metres along the optical axis",
       .key = 7,
       .quantity = Length,
       .unit = "m",
       .file = FileForm::FloatExr,
       .times_alpha = false,
       .least_alpha = kDepthAlpha,
       .false_color = true},
      {.id = kAlphaChannel, .title = "Alpha", .legend = "0 to 1, grey", .file = FileForm::Png},
      {.id = kDirectChannel,
       .title = "Direct light",
       .legend = "that comes straight from the light",
       .quantity = Color,
       .encoding = Encoding::Linear,
       .needs = MaterialsAndLight},
      {.id = kIndirectChannel,
       .title = "Indirect light",
       .legend = "that comes from other surfaces",
       .quantity = Color,
       .encoding = Encoding::Linear,
       .needs = MaterialsAndLight},
      {.id = kVarianceChannel,
       .title = "Variance",
       .legend = "of the luminance of relit light",
       .unit = "radiance squared",
       .needs = MaterialsAndLight,
       .file = FileForm::FloatExr},
      {.id = kMeshChannel,
       .title = "Mesh",
       .legend = "triangles",
       .unit = "m",
       .needs = ChannelNeeds::Mesh,
       .file = FileForm::Ply,
       .times_alpha = false},
  };
}

template <class Has>
bool allOf(const RenderScene& scene, Has&& has) {
  return std::all_of(scene.instances.begin(), scene.instances.end(), has);
}

bool hasAttribute(const RenderInstance& instance, const std::string& name) {
  return instance.attributes && std::any_of(instance.attributes->begin(), instance.attributes->end(),
                                            [&](const Attribute& a) { return a.info.name == name; });
}

}  // namespace

const std::vector<ChannelInfo>& channels() {
  static const std::vector<ChannelInfo> all = table();
  return all;
}

std::vector<std::string> channelIds() {
  std::vector<std::string> ids;
  for (const ChannelInfo& c : channels()) ids.push_back(c.id);
  return ids;
}

const std::vector<ChannelInfo>& shownChannels() {
  static const std::vector<ChannelInfo> shown = [] {
    std::vector<ChannelInfo> keyed;
    std::copy_if(channels().begin(), channels().end(), std::back_inserter(keyed),
                 [](const ChannelInfo& c) { return c.key > 0; });
    std::sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    return keyed;
  }();
  return shown;
}

const ChannelInfo* findChannel(std::string_view id) {
  const auto& all = channels();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ChannelInfo& c) { return c.id == id; });
  return found == all.end() ? nullptr : &*found;
}

const ChannelInfo& channelOf(std::string_view id) {
  if (const ChannelInfo* channel = findChannel(id)) return *channel;
  throw Error(Error::Kind::Usage,
              fmt::format("unknown channel \"{}\": expected some of {}", id, fmt::join(channelIds(), ", ")));
}

std::string_view extensionOf(FileForm form) {
  switch (form) {
    case FileForm::Png:
      return "png";
    case FileForm::HalfExr:
    case FileForm::FloatExr:
      return "exr";
    case FileForm::Ply:
      return "ply";
  }
  return {};
}

std::vector<std::string> layerNames(const ChannelInfo& channel, std::string_view layer) {
  if (channel.needs == ChannelNeeds::Mesh) throw Error(Error::Kind::Bug, "a mesh is no layer of a picture");
  std::string prefix = fmt::format("{}.", layer);
  std::replace(prefix.begin(), prefix.end() - 1, '.', '_');
  if (channel.id == kRgbChannel) prefix.clear();
  std::string_view components = channel.id == kAlphaChannel ? kCoverageName : "Y";
  if (channel.quantity == Quantity::Color) components = "RGB";
  if (channel.quantity == Quantity::Direction) components = "XYZ";
  if (channel.quantity == Quantity::Length) components = "Z";
  std::vector<std::string> names;
  for (const char c : components) names.push_back(prefix + c);
  return names;
}

// Nothing has nothing; meshes and the ground have materials.
Lack lackOf(const ChannelInfo& channel, const RenderScene& scene) {
  const bool gaussians = !scene.instances.empty();
  if (needsMaterials(channel)) {
    const auto has = [](const RenderInstance& i) { return i.materials != nullptr; };
    if (!(gaussians || hasMeshes(scene)) || !allOf(scene, has)) return Lack::Materials;
  } else if (!channel.attribute.empty()) {
    const auto has = [&](const RenderInstance& i) { return hasAttribute(i, channel.attribute); };
    if (!gaussians || !allOf(scene, has)) return Lack::Attribute;
  }
  return channel.needs == ChannelNeeds::MaterialsAndLight && !isLit(scene) ? Lack::Light : Lack::None;
}

}  // namespace beam
