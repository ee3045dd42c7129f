// SPDX-License-Identifier: Apache-2.0
// Drawn channels as files: one each in the form that the table of channels says, or all of a camera and frame
// as layers of one OpenEXR file.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/io/written_by.h"
#include "core/math/similarity3.h"
#include "core/scene/channel.h"

namespace beam {

struct DrawnChannel {
  ChannelInfo channel;
  std::string name;  // of its folder or layer: the channel's id, or relight_<stem of the panorama>
  std::shared_ptr<const Planes> values;  // as renderers give them: in world axes and metres
};

// OUT/layers/<camera>/<frame>.exr.
inline constexpr const char* kLayersFolder = "layers";

// "sRGB", "scene-linear Rec.709" or "data": of the channel's own file.
std::string colorStateOf(const ChannelInfo& channel);

// Directions in the axes and lengths in the unit of `frame_from_world`; PNG is sRGB-encoded, 8 bits. Throws
// Error{Storage}.
void writePicture(const std::filesystem::path& file, const DrawnChannel& drawn,
                  const Similarity3& frame_from_world, const FileNotes& notes);

// All of one size, none twice and no mesh, named as layerNames says. Everything is linear: colour as
// photographed is decoded from sRGB, relit pictures and base colour are as they are, not clamped to [0, 1]
// where PNG is. Half precision, depth in float. Where colour as photographed and alpha are there, alpha is
// also its A; an alpha without a name is nothing but that. Notes say the colour state and which layers are
// value x alpha. Throws Error{Storage}, Error{Data} for more than an EXR file is read with.
void writeLayers(const std::filesystem::path& file, std::span<const DrawnChannel> drawn,
                 const Similarity3& frame_from_world, FileNotes notes, const Progress& progress = Progress());

// Throws what writeLayers throws for the size, of what will be drawn (without values), and Error{Usage} where
// two layers would have one name. Takes no memory.
void requireLayers(const std::filesystem::path& file, std::span<const DrawnChannel> drawn, int width,
                   int height);

}  // namespace beam
