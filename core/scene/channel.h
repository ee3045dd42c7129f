// SPDX-License-Identifier: Apache-2.0
// What a picture of a scene can show: one table for renderers, files and windows. Whoever draws, writes or
// shows a channel reads its row and asks for no id that the row could answer for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"
#include "core/scene/render_scene.h"

namespace beam {

enum class Quantity {
  Color,      // three values; the encoding says which
  Direction,  // three values, turned into the axes of the file
  Length,     // one value in metres, scaled into the unit of the file
  Scalar,     // one value; from 0 to 1 where it has no unit
};

enum class ChannelNeeds { Gaussians, Materials, MaterialsAndLight, Mesh };

enum class FileForm { Png, HalfExr, FloatExr, Ply };

struct ChannelInfo {
  std::string id;      // as typed and as folders are named
  std::string title;   // as shown
  std::string legend;  // of a picture on the screen: unit and limits, or what the colours mean
  int key = 0;  // 1 to 9: its key in the window, which lists channels in this order; 0: not shown there
  Quantity quantity = Quantity::Scalar;
  Encoding encoding = Encoding::Data;
  std::string unit = {};  // of values in world axes
  ChannelNeeds needs = ChannelNeeds::Gaussians;
  std::string attribute = {};  // of the Gaussians, blended; empty: the renderer's own work
  FileForm file = FileForm::HalfExr;
  // What a pixel holds: the value times alpha (composited on black, never divided by alpha), or the surface's
  // own value. Either is 0 where alpha is below `least_alpha`.
  bool times_alpha = true;
  float least_alpha = 0;
  bool false_color = false;  // on the screen

  bool operator==(const ChannelInfo&) const = default;
};

inline constexpr const char* kRelightChannel = "relight";
inline constexpr const char* kRgbChannel = "rgb";
inline constexpr const char* kBaseColorChannel = "base_color";
inline constexpr const char* kOcclusionChannel = "ao";
inline constexpr const char* kRoughnessChannel = "roughness";
inline constexpr const char* kNormalChannel = "normal";
inline constexpr const char* kDepthChannel = "depth";
inline constexpr const char* kAlphaChannel = "alpha";
// Of the reference: light past no other surface and past one or more, which add up to relight; and the
// variance of relight's luminance, before it is denoised.
inline constexpr const char* kDirectChannel = "direct";
inline constexpr const char* kIndirectChannel = "indirect";
inline constexpr const char* kVarianceChannel = "variance";
inline constexpr const char* kMeshChannel = "mesh";

// The table, in the order in which channels are listed.
const std::vector<ChannelInfo>& channels();
std::vector<std::string> channelIds();
// Those with a key, by their keys.
const std::vector<ChannelInfo>& shownChannels();

const ChannelInfo* findChannel(std::string_view id);  // null: none of that name
const ChannelInfo& channelOf(std::string_view id);    // throws Error{Usage} that names those there are

inline int componentsOf(const ChannelInfo& c) {
  return c.quantity == Quantity::Color || c.quantity == Quantity::Direction ? 3 : 1;
}
// A scalar that lies in [0, 1]; another one has the limits that a picture gives it.
inline bool isShare(const ChannelInfo& c) { return c.quantity == Quantity::Scalar && c.unit.empty(); }
inline bool needsMaterials(const ChannelInfo& c) {
  return c.needs == ChannelNeeds::Materials || c.needs == ChannelNeeds::MaterialsAndLight;
}
std::string_view extensionOf(FileForm form);  // "png"

// A channel as a layer of one OpenEXR file that holds several: "LAYER.COMPONENT" as compositing programs read
// it, with R G B, X Y Z, Z of a length, A of coverage, Y of another single value. Colour as photographed has
// no layer name: it is what a program shows first. Dots of `layer` become '_', for they part layers. The mesh
// is none: Error{Bug}.
std::vector<std::string> layerNames(const ChannelInfo& channel, std::string_view layer);
inline constexpr const char* kCoverageName =
    "A";  // of the colour as photographed: the value of kAlphaChannel

// What a scene does not have and the channel needs.
enum class Lack { None, Materials, Light, Attribute };
Lack lackOf(const ChannelInfo& channel, const RenderScene& scene);

}  // namespace beam
