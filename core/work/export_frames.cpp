// SPDX-License-Identifier: Apache-2.0
#include "core/work/export_frames.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/io/splat_ply.h"
#include "core/scene/transform.h"
#include "core/stages/project_sequence.h"
#include "core/work/selection.h"

namespace beam {
namespace {

void writeFrame(const GaussianFrame& frame, const Similarity3* frame_from_world,
                const std::filesystem::path& file, const Progress& progress) {
  const Materials* materials = frame.materials ? &*frame.materials : nullptr;
  if (!frame_from_world) return writeSplatPly(file, frame.cloud, materials);
  const GaussianCloud cloud = transformed(frame.cloud, *frame_from_world);
  std::optional<Materials> turned;
  if (materials) turned = transformed(*materials, *frame_from_world);
  progress.check();
  writeSplatPly(file, cloud, turned ? &*turned : nullptr);
}

}  // namespace

ExportOutcome exportFrames(const ExportRequest& request, Progress& progress) {
  const auto sequence = sequenceOf(request.project, Shows::Between);
  const std::vector<FrameIndex> frames = selectSolvedFrames(request.frames, *sequence, progress);
  const Similarity3 capture_from_world = sequence->captureFromWorld();
  std::filesystem::create_directories(request.out);
  ExportOutcome outcome;
  progress.expect(static_cast<std::int64_t>(frames.size()));
  for (const FrameIndex frame : frames) {
    const FrameLabel& label = sequence->frames()[static_cast<std::size_t>(frame.value)];
    const std::shared_ptr<const GaussianFrame> r = sequence->load(frame);
    if (!r)
      throw Error(Error::Kind::Data, fmt::format("frame {} is not solved yet: run it first", label.name));
    progress.check();
    outcome.files.push_back(request.out / fmt::format("frame.{:06}.ply", std::max(0LL, label.number)));
    writeFrame(*r, request.world_frame ? nullptr : &capture_from_world, outcome.files.back(), progress);
    progress.step();
  }
  outcome.interpolated = interpolatedOf(*sequence, frames);
  return outcome;
}

}  // namespace beam
