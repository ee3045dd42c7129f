// SPDX-License-Identifier: Apache-2.0
// Pictures of solved frames as files, laid out as other tools expect them:
// OUT/<channel>/<camera>/<frame>.<ext>, or all channels of a camera and frame as layers of
// OUT/layers/<camera>/<frame>.exr; meshes as OUT/mesh/<frame>.ply. Used by `beam render`, by the evaluation
// and by the studio.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/render/scene_renderer.h"
#include "core/scene/capture.h"
#include "core/scene/gaussian_sequence.h"
#include "core/scene/lighting.h"

namespace beam {

struct RenderRequest {
  std::vector<std::string> channels;  // ids of scene/channel.h
  std::vector<View> views;
  std::vector<FrameIndex> frames;
  std::vector<std::filesystem::path> environments;  // for "relight": a folder relight_<stem> each
  Lighting lighting = {};                           // that their light comes in
  bool world_frame = false;  // normals and meshes in world axes instead of the capture's
  bool layers = false;       // one file a camera and frame (picture_files.h); a mesh stays its own file
  // What is there, whole, and was made by `written_by` from what it would be made from now is left as it is.
  bool skip_existing = false;
  std::filesystem::path out;
  // What files say wrote them (io/written_by.h), beside camera, frame, channel, unit, axes, colour state and
  // what they were made from (picture_source.h); empty: they say nothing.
  std::string written_by = {};
};

// Throws Error{Data} where the scene of a frame called `name` has no materials or attribute that the channel
// needs. Light is another matter.
void requireWhatIsNeeded(const ChannelInfo& channel, const RenderScene& scene, const std::string& name);

// Every file that renderChannels would write, relative to `out`; of frames without a mesh that one too.
std::vector<std::filesystem::path> channelFiles(const GaussianSequence& sequence,
                                                const RenderRequest& request);

struct RenderedFiles {
  std::size_t written = 0, kept = 0;  // kept: skip_existing found them
};

// Throws Error{Usage} for an unknown channel, one that the renderer does not draw, relight without a
// panorama, two of one name or two layers of one name; Error{Data} for layers
// that are more than a file is read with. Writes nothing.
void requireDrawable(const RenderRequest& request, const RendererAbilities& abilities);

// Throws Error{Usage} where a folder that this would write relit pictures into holds others, not among
// `files`, that another panorama of the same file name lights, or in another way: one folder would hold two
// lights. Of what notes say.
void requireOneLight(const RenderRequest& request, const RendererAbilities& abilities,
                     std::span<const std::filesystem::path> files);

// Throws what requireDrawable does, and Error{Data} when a frame is not solved as far as a channel needs. The
// renderer draws no textures.
RenderedFiles renderChannels(const GaussianSequence& sequence, const RenderRequest& request,
                             SceneRenderer& renderer, Progress& progress);

}  // namespace beam
