// SPDX-License-Identifier: Apache-2.0
#include "core/work/render_frames.h"

#include "core/io/written_by.h"
#include "core/pipeline/output_target.h"
#include "core/stages/project_sequence.h"
#include "core/stages/render_channels.h"
#include "core/work/selection.h"

namespace beam {
namespace {

constexpr const char* kCommand = "render";

}  // namespace

RenderFramesOutcome renderFrames(const RenderFramesRequest& request, SceneRenderer& renderer,
                                 Progress& progress) {
  const auto sequence = sequenceOf(request.project, Shows::Between);
  RenderRequest pictures;
  pictures.channels = request.channels;
  pictures.views = selectViews(request.cameras, request.project.capture());
  pictures.frames = selectSolvedFrames(request.frames, *sequence, progress);
  pictures.environments = request.environments;
  pictures.world_frame = request.world_frame;
  pictures.out = request.out;
  pictures.written_by = writerOf(kCommand);
  requireFolderTarget(request.out, channelFiles(*sequence, pictures), {kCommand, request.force});
  renderChannels(*sequence, pictures, renderer, progress);
  return {pictures.views.size(), pictures.frames.size(), interpolatedOf(*sequence, pictures.frames)};
}

}  // namespace beam
