// SPDX-License-Identifier: Apache-2.0
#include "core/work/export_frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/splat_ply.h"
#include "core/pipeline/output_target.h"
#include "core/scene/transform.h"
#include "core/stages/project_sequence.h"
#include "core/work/last_solved.h"
#include "core/work/selection.h"

namespace beam {
namespace {

constexpr const char* kCommand = "export";

// Writes whole files. `materials` may be null.
using WriteFrame = void (*)(const std::filesystem::path& file, const GaussianCloud& cloud,
                            const Materials* materials, const FileNotes& notes,
                            std::span<const float> normal_sides);

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
                const std::filesystem::path& file, const FileNotes& notes, const Progress& progress) {
  const Materials* materials = frame.materials ? &*frame.materials : nullptr;
  const Attribute* side = attributeNamed(frame.attributes, kNormalSideName);
  const std::span<const float> sides = side ? std::span<const float>(side->values) : std::span<const float>();
  if (!frame_from_world) return format.write(file, frame.cloud, materials, notes, sides);
  const GaussianCloud cloud = transformed(frame.cloud, *frame_from_world);
  std::optional<Materials> turned;
  if (materials) turned = transformed(*materials, *frame_from_world);
  progress.check();
  format.write(file, cloud, turned ? &*turned : nullptr, notes, sides);
}

// By number where every frame of the sequence has one of its own, else by name.
std::vector<std::filesystem::path> filesOf(const std::vector<FrameLabel>& labels,
                                           const std::vector<FrameLabel>& sequence, const Format& format) {
  std::set<long long> numbers;
  for (const FrameLabel& label : sequence)
    if (label.number >= 0) numbers.insert(label.number);
  const bool numbered = numbers.size() == sequence.size();
  std::vector<std::filesystem::path> files;
  for (const FrameLabel& label : labels) {
    const std::string name = numbered ? fmt::format("{:06}", label.number) : label.name;
    files.emplace_back(fmt::format("frame.{}.{}", name, format.info.extension));
  }
  return files;
}

FileNotes notesOf(const FrameLabel& label, bool world_frame, const Similarity3& capture_from_world) {
  return {{"Software", writerOf(kCommand)},
          {"frame", label.name},
          {"axes", world_frame ? "world" : "capture"},
          {"unit", lengthUnit(world_frame ? Similarity3{} : capture_from_world)}};
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
  const WantedResults wanted{
      .frames = request.frames, .between = true, .materials_if_any = true, .strict = request.strict};
  requireOutside(request.out);
  const LastSolved last = lastSolved(request.project, wanted, progress);
  const Project& project = last.project;
  const auto sequence = sequenceOf(project, Shows::Between);
  const std::vector<FrameIndex> frames = selectSolvedFrames(request.frames, *sequence, progress);
  const Similarity3 capture_from_world = sequence->captureFromWorld();
  if (const std::string lost = roundingWarning(capture_from_world); !request.world_frame && !lost.empty())
    logWarning("{}", lost);
  std::vector<FrameLabel> labels;
  for (const FrameIndex frame : frames)
    labels.push_back(sequence->frames()[static_cast<std::size_t>(frame.value)]);
  const std::vector<std::filesystem::path> files = filesOf(labels, sequence->frames(), format);
  requireFolderTarget(request.out, files, {kCommand, request.force, inputFolders(project)});
  last.tell();
  ExportOutcome outcome;
  progress.expect(static_cast<std::int64_t>(frames.size()));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::shared_ptr<const GaussianFrame> r = solvedFrame(*sequence, frames[i]);
    progress.check();
    outcome.files.push_back(request.out / files[i]);
    writeFrame(*r, request.world_frame ? nullptr : &capture_from_world, format, outcome.files.back(),
               notesOf(labels[i], request.world_frame, capture_from_world), progress);
    progress.step();
  }
  outcome.interpolated = interpolatedOf(*sequence, frames);
  return outcome;
}

}  // namespace beam
