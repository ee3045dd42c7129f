// SPDX-License-Identifier: Apache-2.0
#include "core/stages/picture_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/io/exr_header.h"
#include "core/io/image_file.h"
#include "core/math/color.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLinearColor = "scene-linear Rec.709";

Image<u8vec3> bytesOf(const Planes& color, bool encode) {
  Image<u8vec3> out(color.width, color.height, u8vec3(0), Encoding::Srgb);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const float c = std::clamp(color.plane(k)[i], 0.0f, 1.0f);
      out.pixels[i][k] = byteOf(encode ? srgbFromLinear(c) : c);
    }
  }
  return out;
}

Image<std::uint8_t> bytesOf(const Planes& shares) {
  Image<std::uint8_t> out(shares.width, shares.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) out.pixels[i] = byteOf(shares.values[i]);
  return out;
}

// Values of world axes and metres as the frame of the files has them. A turn leaves lengths as they are.
Planes inFrame(const ChannelInfo& channel, const Planes& values, const Similarity3& frame_from_world) {
  Planes out = values;
  if (channel.quantity == Quantity::Direction) {
    for (std::size_t i = 0; i < out.planeSize(); ++i) {
      const dvec3 v =
          frame_from_world.rotation * dvec3(values.plane(0)[i], values.plane(1)[i], values.plane(2)[i]);
      for (int c = 0; c < 3; ++c) out.plane(c)[i] = static_cast<float>(v[c]);
    }
  } else if (channel.quantity == Quantity::Length && frame_from_world.scale != 1) {
    for (float& v : out.values) v = static_cast<float>(frame_from_world.scale * v);
  }
  return out;
}

// As a layer has them.
Planes linear(const ChannelInfo& channel, Planes values) {
  if (channel.encoding == Encoding::Srgb)
    for (float& v : values.values) v = linearFromSrgb(v);
  return values;
}

ExrPrecision precisionOf(const ChannelInfo& channel) {
  return channel.file == FileForm::FloatExr ? ExrPrecision::Float : ExrPrecision::Half;
}

bool isCoverage(const DrawnChannel& drawn) { return drawn.channel.id == kAlphaChannel; }

// The channels of the file without their values, in order of `drawn`; A of the colour, if any, is the last.
std::vector<ExrChannel> channelsOf(std::span<const DrawnChannel> drawn) {
  std::vector<ExrChannel> channels;
  for (const DrawnChannel& d : drawn) {
    if (d.name.empty()) continue;
    for (std::string& name : layerNames(d.channel, d.name))
      channels.push_back({std::move(name), precisionOf(d.channel), nullptr});
  }
  const bool color = std::any_of(drawn.begin(), drawn.end(),
                                 [](const DrawnChannel& d) { return d.channel.id == kRgbChannel; });
  if (color && std::any_of(drawn.begin(), drawn.end(), isCoverage))
    channels.push_back({kCoverageName, ExrPrecision::Half, nullptr});
  return channels;
}

// What holds for the file as a whole or for some of its layers.
void addLayerNotes(std::span<const DrawnChannel> drawn, FileNotes& notes) {
  std::vector<std::string> layers, times_alpha;
  bool color = false, decoded = false;
  for (const DrawnChannel& d : drawn) {
    if (d.name.empty()) continue;
    layers.push_back(d.name);
    if (d.channel.times_alpha) times_alpha.push_back(d.name);
    color |= d.channel.quantity == Quantity::Color;
    decoded |= d.channel.encoding == Encoding::Srgb;
  }
  notes.emplace_back("layers", fmt::format("{}", fmt::join(layers, ", ")));
  notes.emplace_back("color_state", color ? kLinearColor : "data");
  if (decoded) notes.emplace_back("rgb_encoding", "decoded from sRGB to linear light");
  if (!times_alpha.empty()) {
    notes.emplace_back("alpha",
                       fmt::format("value x alpha, composited on black: {}", fmt::join(times_alpha, ", ")));
  }
}

}  // namespace

std::string colorStateOf(const ChannelInfo& channel) {
  if (channel.quantity != Quantity::Color) return "data";
  return channel.file == FileForm::Png ? "sRGB" : kLinearColor;
}

void writePicture(const fs::path& file, const DrawnChannel& drawn, const Similarity3& frame_from_world,
                  const FileNotes& notes) {
  const ChannelInfo& channel = drawn.channel;
  const Planes& values = *drawn.values;
  const bool three = componentsOf(channel) == 3;
  if (channel.file == FileForm::Png) {
    if (three)
      writePng(file, bytesOf(values, channel.encoding == Encoding::Linear), notes);
    else
      writePng(file, bytesOf(values), notes);
    return;
  }
  writeExr(file, inFrame(channel, values, frame_from_world),
           three ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"},
           precisionOf(channel), notes);
}

void writeLayers(const fs::path& file, std::span<const DrawnChannel> drawn,
                 const Similarity3& frame_from_world, FileNotes notes, const Progress& progress) {
  if (drawn.empty()) throw Error(Error::Kind::Bug, "a file of layers without a layer");
  std::vector<Planes> planes;
  for (const DrawnChannel& d : drawn) {
    progress.check();
    planes.push_back(linear(d.channel, inFrame(d.channel, *d.values, frame_from_world)));
  }
  std::vector<ExrChannel> channels = channelsOf(drawn);
  std::size_t next = 0;
  for (std::size_t d = 0; d < drawn.size(); ++d) {
    const int components = drawn[d].name.empty() ? 0 : componentsOf(drawn[d].channel);
    for (int c = 0; c < components; ++c) channels[next++].values = planes[d].plane(c);
  }
  if (next < channels.size()) {
    const auto coverage = std::find_if(drawn.begin(), drawn.end(), isCoverage);
    channels.back().values = planes[static_cast<std::size_t>(coverage - drawn.begin())].plane(0);
  }
  if (!notes.empty()) addLayerNotes(drawn, notes);
  writeExr(file, planes[0].width, planes[0].height, channels, notes, &progress);
}

void requireLayers(const fs::path& file, std::span<const DrawnChannel> drawn, int width, int height) {
  const std::vector<ExrChannel> channels = channelsOf(drawn);
  std::set<std::string> names;
  std::size_t pixel_bytes = 0;
  for (const ExrChannel& c : channels) {
    pixel_bytes += c.precision == ExrPrecision::Half ? 2 : 4;
    if (names.insert(c.name).second) continue;
    throw Error(Error::Kind::Usage,
                fmt::format("two layers of \"{}\" would have the channel {}: name each channel once and give "
                            "panoramas of different names",
                            file.string(), c.name));
  }
  requireExrSize(width, height, channels.size(), pixel_bytes, file);
}

}  // namespace beam
