// SPDX-License-Identifier: Apache-2.0
// beam render and beam export: pictures and splats of what a project has solved.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/selection.h"
#include "core/base/error.h"
#include "core/io/splat_ply.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/scene/transform.h"
#include "core/stages/project_sequence.h"
#include "core/stages/render_channels.h"

namespace beam {
namespace {

struct RenderFlags {
  std::string project, cameras = "test", frames = "all", environment, frame_of = "capture", out;
  std::vector<std::string> channels = {"rgb"};
  DeviceChoice device;
};

bool wantsWorld(const std::string& frame_of) {
  if (frame_of == "world") return true;
  if (frame_of == "capture") return false;
  throw Error(Error::Kind::Usage, fmt::format("--frame-of expects capture or world, found \"{}\"", frame_of));
}

// Names those of the frames that are interpolated.
void tellInterpolated(const GaussianSequence& sequence, const std::vector<FrameIndex>& frames,
                      Console& console) {
  std::vector<std::string> names;
  for (const FrameIndex f : frames) {
    if (sequence.content(f).interpolated) names.push_back(nameOf(sequence, f));
  }
  if (!names.empty())
    console.print(fmt::format("interpolated, not solved: frames {}", fmt::join(names, ", ")));
}

int runRender(const RenderFlags& flags, CommandContext& context) {
  const Project project = Project::open(flags.project, context.services.pipeline);
  const auto sequence = sequenceOf(project, Shows::Between);
  RenderRequest request;
  request.channels = flags.channels;
  request.views = selectViews(flags.cameras, project.capture());
  request.frames = selectSolvedFrames(flags.frames, *sequence);
  request.world_frame = wantsWorld(flags.frame_of);
  request.out = flags.out;
  if (!flags.environment.empty()) request.environments.emplace_back(flags.environment);
  std::shared_ptr<ComputeDevice> device = makeDevice(flags.device);
  Progress progress(context.stop, context.console.listener());
  renderChannels(*sequence, request, *newCpuSceneRenderer(std::move(device)), progress);
  context.console.endProgress();
  context.console.print(fmt::format("wrote {} of {} camera{} and {} frame{} to \"{}\"",
                                    fmt::join(flags.channels, ", "), request.views.size(),
                                    request.views.size() == 1 ? "" : "s", request.frames.size(),
                                    request.frames.size() == 1 ? "" : "s", flags.out));
  tellInterpolated(*sequence, request.frames, context.console);
  return 0;
}

struct ExportFlags {
  std::string project, format = "ply", out, frames = "all", frame_of = "capture";
};

int runExport(const ExportFlags& flags, CommandContext& context) {
  if (flags.format != "ply") {
    throw Error(Error::Kind::Usage, fmt::format("--format expects ply, found \"{}\"", flags.format));
  }
  const Project project = Project::open(flags.project, context.services.pipeline);
  const auto sequence = sequenceOf(project, Shows::Between);
  const std::vector<FrameIndex> frames = selectSolvedFrames(flags.frames, *sequence);
  const bool world = wantsWorld(flags.frame_of);
  const Similarity3 capture_from_world = sequence->captureFromWorld();
  std::filesystem::create_directories(flags.out);
  Progress progress(context.stop, context.console.listener());
  progress.expect(static_cast<std::int64_t>(frames.size()));
  for (const FrameIndex frame : frames) {
    const FrameLabel& label = sequence->frames()[static_cast<std::size_t>(frame.value)];
    const std::shared_ptr<const GaussianFrame> r = sequence->load(frame);
    if (!r)
      throw Error(Error::Kind::Data, fmt::format("frame {} is not solved yet: run it first", label.name));
    const GaussianCloud cloud = world ? r->cloud : transformed(r->cloud, capture_from_world);
    std::optional<Materials> materials = r->materials;
    if (materials && !world) materials = transformed(*materials, capture_from_world);
    const long long number = std::max(0LL, label.number);
    writeSplatPly(std::filesystem::path(flags.out) / fmt::format("frame.{:06}.ply", number), cloud,
                  materials ? &*materials : nullptr);
    progress.step();
  }
  context.console.endProgress();
  context.console.print(
      fmt::format("wrote {} frame{} to \"{}\"", frames.size(), frames.size() == 1 ? "" : "s", flags.out));
  tellInterpolated(*sequence, frames, context.console);
  return 0;
}

}  // namespace

void addRenderCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<RenderFlags>();
  CLI::App* command =
      app.add_subcommand("render", "Write pictures of solved frames: colour, materials, geometry, relit");
  command->add_option("PROJECT", flags->project, "Project folder")->required();
  command->add_option("--channels", flags->channels, fmt::format("Some of {}", fmt::join(channelIds(), ", ")))
      ->delimiter(',');
  command->add_option("--cameras", flags->cameras, "test, train, all or camera names");
  command->add_option("--frames", flags->frames,
                      "Frames: 0-7, 1,5, 1-9x2 or all that are solved or between those of a scout run");
  command->add_option("--environment", flags->environment, "Panorama for the channel relight");
  command->add_option("--frame-of", flags->frame_of, "Axes of normals and meshes: capture or world");
  command->add_option("--out", flags->out, "Folder for the pictures")->required();
  addDeviceFlags(*command, flags->device);
  command->callback(
      [flags, &context] { context.action = [flags, &context] { return runRender(*flags, context); }; });
}

void addExportCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<ExportFlags>();
  CLI::App* command = app.add_subcommand("export", "Write solved frames for other programs");
  command->add_option("PROJECT", flags->project, "Project folder")->required();
  command->add_option("--format", flags->format, "ply: one splat file a frame");
  command->add_option("--out", flags->out, "Folder for the files")->required();
  command->add_option("--frames", flags->frames,
                      "Frames: 0-7, 1,5, 1-9x2 or all that are solved or between those of a scout run");
  command->add_option("--frame-of", flags->frame_of, "Axes: capture or world");
  command->callback(
      [flags, &context] { context.action = [flags, &context] { return runExport(*flags, context); }; });
}

}  // namespace beam
