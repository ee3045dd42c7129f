// SPDX-License-Identifier: Apache-2.0
#include "core/work/render_frames.h"

#include "core/io/written_by.h"
#include "core/pipeline/output_target.h"
#include "core/scene/channel.h"
#include "core/stages/project_sequence.h"
#include "core/stages/relight_settings.h"
#include "core/stages/render_channels.h"
#include "core/work/last_solved.h"
#include "core/work/selection.h"

namespace beam {
namespace {

constexpr const char* kCommand = "render";

WantedResults wantedOf(const RenderFramesRequest& request) {
  WantedResults wanted{.frames = request.frames, .between = true, .strict = request.strict};
  for (const std::string& id : request.channels) {
    const ChannelInfo& channel = channelOf(id);
    wanted.materials |= needsMaterials(channel);
    wanted.mesh |= channel.needs == ChannelNeeds::Mesh;
  }
  return wanted;
}

}  // namespace

RenderFramesOutcome renderFrames(const RenderFramesRequest& request, SceneRenderer& renderer,
                                 Progress& progress) {
  requireOutside(request.out);
  const LastSolved last = lastSolved(request.project, wantedOf(request), progress);
  const Project& project = last.project;
  const auto sequence = sequenceOf(project, Shows::Between);
  RenderRequest pictures;
  pictures.channels = request.channels;
  pictures.views = selectViews(request.cameras, project.capture(), request.size);
  pictures.frames = selectSolvedFrames(request.frames, *sequence, progress);
  pictures.environments = request.environments;
  pictures.lighting = plainLighting(request.project);
  pictures.world_frame = request.world_frame;
  pictures.layers = request.layers;
  pictures.skip_existing = request.skip_existing;
  pictures.out = request.out;
  pictures.written_by = writerOf(kCommand);
  requireDrawable(pictures, renderer.abilities());
  const std::vector<std::filesystem::path> files = channelFiles(*sequence, pictures);
  requireFolderTarget(request.out, files, {kCommand, request.force, inputFolders(project)});
  if (!request.force) requireOneLight(pictures, renderer.abilities(), files);
  last.tell();
  const RenderedFiles done = renderChannels(*sequence, pictures, renderer, progress);
  return {pictures.views.size(), pictures.frames.size(), interpolatedOf(*sequence, pictures.frames),
          done.written, done.kept};
}

}  // namespace beam
