// SPDX-License-Identifier: Apache-2.0
// beam render and beam export: pictures and splats of what a project has solved.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <variant>

#include "app/cli/commands.h"
#include "app/cli/picture_size.h"
#include "app/cli/run_flags.h"
#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/base/word_list.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/render/reference_scene_renderer.h"
#include "core/scene/channel.h"
#include "core/work/export_frames.h"
#include "core/work/render_frames.h"
#include "core/work/render_look.h"
#include "core/work/selection.h"

namespace beam {
namespace {

constexpr const char* kSolvedFramesHelp =
    "Frames such as 0-7, or all that are solved or between those of a scout run; see beam help frames";

struct RenderFlags {
  std::string project, channels = "rgb", cameras, frames = "all", environment;
  std::string frame_of = "capture", out;
  std::vector<std::string> set;
  std::string renderer = "cpu", size, look, camera_path;
  double duration_s = 0, rate = 0;
  int samples = ReferenceOptions{}.samples;
  bool no_denoise = false, tells_samples = false, tells_duration = false, tells_rate = false;
  bool names_cameras = false, names_channels = false, layers = false, skip_existing = false, force = false,
       strict = false;
  DeviceChoice device;
};

bool wantsWorld(const std::string& frame_of) {
  if (frame_of == "world") return true;
  if (frame_of == "capture") return false;
  throw Error(Error::Kind::Usage, fmt::format("--frame-of expects capture or world, found \"{}\"", frame_of));
}

void tellInterpolated(const std::vector<std::string>& names, Console& console) {
  if (!names.empty())
    console.print(fmt::format("interpolated, not solved: frames {}", fmt::join(names, ", ")));
}

// With commas, blanks around them, each once; the last time the flag is typed holds.
std::vector<std::string> channelsIn(const std::string& list) {
  std::vector<std::string> ids = splitAtCommas(list);
  if (ids.empty()) {
    throw Error(Error::Kind::Usage,
                fmt::format("--channels is empty; expected some of {}", fmt::join(channelIds(), ", ")));
  }
  std::vector<std::string> once;
  for (std::string& id : ids)
    if (std::find(once.begin(), once.end(), id) == once.end()) once.push_back(std::move(id));
  return once;
}

// A panorama that nothing is lit by was meant for something: said before the work.
void requireUse(const std::string& environment, const std::vector<std::string>& channels) {
  const bool lit = std::any_of(channels.begin(), channels.end(), [](const std::string& id) {
    return channelOf(id).needs == ChannelNeeds::MaterialsAndLight;
  });
  if (environment.empty() || lit) return;
  throw Error(
      Error::Kind::Usage,
      fmt::format("--environment lights the channel {0} and its parts, and --channels are {1}: add {0} to "
                  "them, or leave --environment out",
                  kRelightChannel, fmt::join(channels, ", ")));
}

std::unique_ptr<SceneRenderer> rendererOf(const RenderFlags& flags, const Project& project,
                                          std::shared_ptr<ComputeDevice> device) {
  if (flags.renderer == rendererNames()[0]) {
    if (flags.no_denoise || flags.tells_samples)
      throw Error(Error::Kind::Usage, "--spp and --no-denoise are of --renderer reference alone");
    return newCpuSceneRenderer(std::move(device));
  }
  const auto offset_m = std::get<double>(project.value("materials.offset_m"));
  return newReferenceSceneRenderer(
      std::move(device),
      {.samples = flags.samples, .denoise = !flags.no_denoise, .offset_m = static_cast<float>(offset_m)});
}

std::string writtenText(const RenderFramesOutcome& outcome, const RenderFlags& flags) {
  if (outcome.kept > 0 && outcome.written == 0)
    return fmt::format("nothing to draw: {} in \"{}\", as this command writes them",
                       countText(outcome.kept, "file is there", "files are there"), flags.out);
  return fmt::format("wrote {} of {} and {} to \"{}\"{}", fmt::join(channelsIn(flags.channels), ", "),
                     countText(outcome.cameras, "camera"), countText(outcome.frames, "frame"), flags.out,
                     outcome.kept == 0 ? std::string()
                                       : fmt::format("; {} there already",
                                                     countText(outcome.kept, "file was", "files were")));
}

// What says how pictures are lit or what they show, where the look does.
void refuseBesideLook(const RenderFlags& flags) {
  const std::pair<const char*, bool> typed[] = {{"--channels", flags.names_channels},
                                                {"--environment", !flags.environment.empty()},
                                                {"--set", !flags.set.empty()},
                                                {"--layers", flags.layers},
                                                {"--frame-of", wantsWorld(flags.frame_of)},
                                                {"--skip-existing", flags.skip_existing}};
  for (const auto& [flag, is_typed] : typed) {
    if (is_typed)
      throw Error(Error::Kind::Usage,
                  fmt::format("{} does not go with --look, which says itself what is drawn and how", flag));
  }
}

std::string writtenText(const RenderLookOutcome& outcome, const RenderFlags& flags) {
  if (outcome.cameras > 0)
    return fmt::format("wrote {} of {} and {} to \"{}\"", outcome.folder,
                       countText(outcome.cameras, "camera"), countText(outcome.frames, "frame"), flags.out);
  return fmt::format("wrote {} of {}{} to \"{}\"", countText(outcome.pictures, "picture"), outcome.folder,
                     outcome.film.empty() ? "" : fmt::format(" and the film {}", outcome.film), flags.out);
}

int runLook(const RenderFlags& flags, const Project& project, CommandContext& context) {
  refuseBesideLook(flags);
  RenderLookRequest request{.project = project,
                            .look = chosenLook(project, flags.look),
                            .cameras = flags.names_cameras ? flags.cameras : usualCameras(project.capture()),
                            .frames = flags.frames,
                            .camera_path = flags.camera_path,
                            .out = flags.out,
                            .force = flags.force,
                            .strict = flags.strict};
  if (!flags.size.empty()) request.size = parsePictureSize(flags.size);
  if (flags.tells_duration) request.timing.duration_s = flags.duration_s;
  if (flags.tells_rate) request.timing.rate = flags.rate;
  const std::unique_ptr<SceneRenderer> renderer = rendererOf(flags, project, makeDevice(flags.device));
  Progress progress(context.stop, context.console.listener());
  const RenderLookOutcome outcome = renderLook(request, *renderer, progress);
  context.console.endProgress();
  context.console.print(writtenText(outcome, flags));
  tellInterpolated(outcome.interpolated, context.console);
  return 0;
}

int runRender(const RenderFlags& flags, CommandContext& context) {
  Project project = Project::open(flags.project, context.services.pipeline);
  if (!flags.look.empty()) return runLook(flags, project, context);
  if (!flags.camera_path.empty() || flags.tells_duration || flags.tells_rate)
    throw Error(Error::Kind::Usage,
                "--camera-path, --duration and --rate are of a look: add --look NAME|FILE");
  for (const std::string& assignment : flags.set) setForPictures(project, assignment);
  RenderFramesRequest request{
      .project = project,
      .channels = channelsIn(flags.channels),
      .cameras = flags.names_cameras ? flags.cameras : usualCameras(project.capture()),
      .frames = flags.frames,
      .environments = {},
      .world_frame = wantsWorld(flags.frame_of),
      .layers = flags.layers,
      .skip_existing = flags.skip_existing,
      .out = flags.out,
      .force = flags.force,
      .strict = flags.strict};
  requireUse(flags.environment, request.channels);
  if (!flags.size.empty()) request.size = parsePictureSize(flags.size);
  if (!flags.environment.empty()) request.environments.emplace_back(flags.environment);
  context.interrupted = flags.skip_existing ? "interrupted; the same command goes on"
                                            : "interrupted; the same command with --skip-existing goes on";
  const std::unique_ptr<SceneRenderer> renderer = rendererOf(flags, project, makeDevice(flags.device));
  Progress progress(context.stop, context.console.listener());
  const RenderFramesOutcome outcome = renderFrames(request, *renderer, progress);
  context.console.endProgress();
  context.console.print(writtenText(outcome, flags));
  tellInterpolated(outcome.interpolated, context.console);
  return 0;
}

struct ExportFlags {
  std::string project, format = "ply", out, frames = "all", frame_of = "capture";
  bool force = false, strict = false;
};

int runExport(const ExportFlags& flags, CommandContext& context) {
  const ExportRequest request{Project::open(flags.project, context.services.pipeline),
                              flags.frames,
                              wantsWorld(flags.frame_of),
                              flags.out,
                              flags.format,
                              flags.force,
                              flags.strict};
  Progress progress(context.stop, context.console.listener());
  const ExportOutcome outcome = exportFrames(request, progress);
  context.console.endProgress();
  context.console.print(
      fmt::format("wrote {} to \"{}\"", countText(outcome.files.size(), "frame"), flags.out));
  tellInterpolated(outcome.interpolated, context.console);
  return 0;
}

std::string formatHelp() {
  std::vector<std::string> lines;
  for (const ExportFormat& f : exportFormats()) lines.push_back(fmt::format("{}: {}", f.id, f.help));
  return fmt::format("{}", fmt::join(lines, "; "));
}

}  // namespace

const std::vector<std::string>& rendererNames() {
  static const std::vector<std::string> kNames = {"cpu", "reference"};
  return kNames;
}

void addRenderCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<RenderFlags>();
  CLI::App* command =
      app.add_subcommand("render", "Write pictures of solved frames: colour, materials, geometry, relit");
  command->add_option("PROJECT", flags->project, "Project folder")->required();
  command->add_option("--channels", flags->channels, "What the pictures show; see beam help files")
      ->type_name("NAME");
  command
      ->add_option("--cameras", flags->cameras, "test, train, all, names or patterns; see beam help frames")
      ->default_str("test, or all where none is held out")
      ->type_name("LIST");
  command->add_option("--frames", flags->frames, kSolvedFramesHelp)->type_name("LIST");
  command
      ->add_option("--environment", flags->environment,
                   "Panorama (.exr, .hdr) for the channel relight, which --channels must name; see "
                   "beam help environment")
      ->type_name("FILE");
  command
      ->add_option(
          "--frame-of", flags->frame_of,
          "Axes and unit of normals, depth and meshes: the capture's, or the world's (+Y up, metres)")
      ->type_name("NAME");
  command
      ->add_option("--look", flags->look,
                   "Lit and shown as a look says, in place of channels: the name of one of the project, or a "
                   "file; see beam help looks")
      ->type_name("NAME|FILE");
  command
      ->add_option("--camera-path", flags->camera_path,
                   "A camera that moves, of a look: once around the subject (turntable) from the first of "
                   "--cameras, or a file's keys; pictures and a film; see beam help looks")
      ->default_str("the look's own")
      ->type_name("turntable|none|FILE");
  CLI::Option* duration =
      command->add_option("--duration", flags->duration_s, "Seconds of a camera that moves")
          ->default_str("that of its keys; of a turntable 10")
          ->type_name("S");
  CLI::Option* rate = command->add_option("--rate", flags->rate, "Pictures a second of a camera that moves")
                          ->default_str("the take's, of one frame 30")
                          ->type_name("N");
  command
      ->add_option("--renderer", flags->renderer,
                   "cpu: in real time; reference: light followed path by path, which that is judged by, with "
                   "the channels direct, indirect and variance")
      ->type_name("NAME");
  command
      ->add_option("--size", flags->size,
                   fmt::format("Size of the pictures, {}; they show all that a camera sees, and more beside "
                               "it where the shape is another",
                               kPictureSizeHelp))
      ->default_str("that of each camera")
      ->type_name("WxH");
  command->add_option("--spp", flags->samples, "Paths a pixel of the reference")
      ->type_name("N")
      ->check(CLI::Range(1, kMostSamples));
  command->add_flag("--no-denoise", flags->no_denoise, "The reference as its paths found it");
  command
      ->add_option("--set", flags->set,
                   "For these pictures alone: how light falls, e.g. --set relight.environment_shadows=ao")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--layers", flags->layers,
                    "All channels of a camera and frame as layers of one linear EXR file, "
                    "OUT/layers/CAMERA/FRAME.exr, which holds the channels of this call alone; a mesh "
                    "stays a file");
  command->add_flag("--skip-existing", flags->skip_existing,
                    "Leave files that this command wrote from the same content as they are");
  command->add_option("--out", flags->out, "Folder for the pictures")->required()->type_name("FOLDER");
  addStrictFlag(*command, flags->strict);
  addForceFlag(*command, flags->force);
  addDeviceFlags(*command, flags->device);
  command->callback([flags, &context, duration, rate, cameras = command->get_option("--cameras"),
                     samples = command->get_option("--spp"), channels = command->get_option("--channels")] {
    flags->names_channels = channels->count() > 0;
    flags->names_cameras = cameras->count() > 0;
    flags->tells_samples = samples->count() > 0;
    flags->tells_duration = duration->count() > 0;
    flags->tells_rate = rate->count() > 0;
    context.action = [flags, &context] { return runRender(*flags, context); };
  });
}

void addExportCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<ExportFlags>();
  CLI::App* command = app.add_subcommand("export", "Write solved frames for other programs");
  command->add_option("PROJECT", flags->project, "Project folder")->required();
  command->add_option("--format", flags->format, formatHelp())->type_name("NAME");
  command->add_option("--out", flags->out, "Folder for the files")->required()->type_name("FOLDER");
  command->add_option("--frames", flags->frames, kSolvedFramesHelp)->type_name("LIST");
  command
      ->add_option("--frame-of", flags->frame_of,
                   "Axes and unit: the capture's, or the world's (+Y up, metres)")
      ->type_name("NAME");
  addStrictFlag(*command, flags->strict);
  addForceFlag(*command, flags->force);
  command->callback(
      [flags, &context] { context.action = [flags, &context] { return runExport(*flags, context); }; });
}

}  // namespace beam
