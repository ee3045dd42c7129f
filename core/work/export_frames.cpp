// SPDX-License-Identifier: Apache-2.0
#include "core/work/export_frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/splat_ply.h"
#include "core/scene/transform.h"
#include "core/stages/project_sequence.h"
#include "core/work/selection.h"

namespace beam {
namespace {

// Writes whole files. `materials` may be null.
using WriteFrame = void (*)(const std::filesystem::path& file, const GaussianCloud& cloud,
                            const Materials* materials);

struct Format {
  ExportFormat info;
  WriteFrame write;
};

const std::vector<Format>& formats() {
  static const std::vector<Format> all = {{{"ply", "ply", "one splat file a frame"}, writeSplatPly}};
  return all;
}

const Format& formatOf(const std::string& id) {
  for (const Format& f : formats())
    if (f.info.id == id) return f;
  std::vector<std::string> known;
  for (const Format& f : formats()) known.push_back(f.info.id);
  throw Error(Error::Kind::Usage,
              fmt::format("--format expects {}, found \"{}\"", fmt::join(known, ", "), id));
}

void writeFrame(const GaussianFrame& frame, const Similarity3* frame_from_world, const Format& format,
                const std::filesystem::path& file, const Progress& progress) {
  const Materials* materials = frame.materials ? &*frame.materials : nullptr;
  if (!frame_from_world) return format.write(file, frame.cloud, materials);
  const GaussianCloud cloud = transformed(frame.cloud, *frame_from_world);
  std::optional<Materials> turned;
  if (materials) turned = transformed(*materials, *frame_from_world);
  progress.check();
  format.write(file, cloud, turned ? &*turned : nullptr);
}

}  // namespace

const std::vector<ExportFormat>& exportFormats() {
  static const std::vector<ExportFormat> all = [] {
    std::vector<ExportFormat> infos;
    for (const Format& f : formats()) infos.push_back(f.info);
    return infos;
  }();
  return all;
}

ExportOutcome exportFrames(const ExportRequest& request, Progress& progress) {
  const Format& format = formatOf(request.format);
  const auto sequence = sequenceOf(request.project, Shows::Between);
  const std::vector<FrameIndex> frames = selectSolvedFrames(request.frames, *sequence, progress);
  const Similarity3 capture_from_world = sequence->captureFromWorld();
  if (const std::string lost = roundingWarning(capture_from_world); !request.world_frame && !lost.empty())
    logWarning("{}", lost);
  std::filesystem::create_directories(request.out);
  ExportOutcome outcome;
  progress.expect(static_cast<std::int64_t>(frames.size()));
  for (const FrameIndex frame : frames) {
    const FrameLabel& label = sequence->frames()[static_cast<std::size_t>(frame.value)];
    const std::shared_ptr<const GaussianFrame> r = solvedFrame(*sequence, frame);
    progress.check();
    outcome.files.push_back(
        request.out / fmt::format("frame.{:06}.{}", std::max(0LL, label.number), format.info.extension));
    writeFrame(*r, request.world_frame ? nullptr : &capture_from_world, format, outcome.files.back(),
               progress);
    progress.step();
  }
  outcome.interpolated = interpolatedOf(*sequence, frames);
  return outcome;
}

}  // namespace beam
