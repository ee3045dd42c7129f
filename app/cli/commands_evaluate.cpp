// SPDX-License-Identifier: Apache-2.0
// beam evaluate: scores against ground truth, or of the held-out photographs.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/ground_truth.h"
#include "app/cli/selection.h"
#include "core/base/error.h"
#include "core/io/file.h"
#include "core/io/image_file.h"
#include "core/method/evaluate.h"
#include "core/pipeline/frame_result.h"
#include "core/stages/render_channels.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

struct EvaluateFlags {
  std::string project, truth, pictures, json, frames = "all";
  DeviceChoice device;
};

// A folder beside nothing of the user's, gone when it goes out of scope.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (fs::temp_directory_path() / "beam-evaluate-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw Error(Error::Kind::Storage, "cannot make a temporary folder");
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Channels the solved frames can give and the truth can judge.
RenderRequest requestFor(const Project& project, const GroundTruth& truth, const std::string& frames,
                         const fs::path& out) {
  RenderRequest r;
  r.out = out;
  r.frames = selectSolvedFrames(frames, project);
  for (std::size_t v = 0; v < project.capture().views.size(); ++v) {
    const std::string& name = project.capture().views[v].name;
    if (std::find(truth.test_cameras.begin(), truth.test_cameras.end(), name) != truth.test_cameras.end()) {
      r.views.push_back({static_cast<std::int32_t>(v)});
    }
  }
  if (r.views.empty()) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\" has none of the test cameras of \"{}\"",
                                               project.folder().string(), truth.folder.string()));
  }
  bool materials = true, meshes = true;
  for (const FrameIndex f : r.frames) {
    const auto result = loadFrameResult(project, f);
    materials &= result && result->materials;
    meshes &= project.state("surface.mesh", f) == StepState::Done;
  }
  r.channels = {"rgb", "normal", "depth"};
  if (meshes) r.channels.emplace_back("mesh");
  if (!materials) return r;
  for (const char* c : {"base_color", "ao", "roughness"}) r.channels.emplace_back(c);
  for (const std::string& e : truth.environments)
    r.environments.push_back(truth.folder / "gt/environments" / (e + ".exr"));
  if (!r.environments.empty()) r.channels.emplace_back("relight");
  return r;
}

ScoreTable scoreAgainstTruth(const EvaluateFlags& flags, const Project& project, CommandContext& context) {
  const GroundTruth truth = openGroundTruth(flags.truth);
  Progress progress(context.stop, context.console.listener());
  if (!flags.pictures.empty()) return scorePictures(truth, flags.pictures, progress);
  const ScratchFolder scratch;
  const auto device = makeDevice(flags.device);
  {
    Progress part = progress.part(0.6, "render");
    renderChannels(project, requestFor(project, truth, flags.frames, scratch.path()), *device, part);
  }
  Progress part = progress.part(0.4, "score");
  return scorePictures(truth, scratch.path(), part);
}

Planes planesOf(const Image<u8vec3>& image) {
  Planes p(image.width, image.height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) p.plane(c)[i] = image.pixels[i][c] / 255.0f;
  }
  return p;
}

// Held-out photographs against the same files that render writes.
ScoreTable scoreHeldOut(const EvaluateFlags& flags, const Project& project, CommandContext& context) {
  const CaptureSet& capture = project.capture();
  const ScratchFolder scratch;
  RenderRequest r;
  r.out = scratch.path();
  r.channels = {"rgb"};
  r.frames = selectSolvedFrames(flags.frames, project);
  for (std::size_t v = 0; v < capture.views.size(); ++v) {
    const ViewIndex view{static_cast<std::int32_t>(v)};
    if (capture.views[v].split == Split::Test && capture.source->has(view, r.frames.front()))
      r.views.push_back(view);
  }
  if (r.views.empty()) {
    throw Error(Error::Kind::Data,
                "no held-out photographs: name a data set with --ground-truth, or process the capture "
                "with --hold-out");
  }
  const auto device = makeDevice(flags.device);
  Progress progress(context.stop, context.console.listener());
  renderChannels(project, r, *device, progress);
  Scores mean;
  double n = 0;
  for (const ViewIndex view : r.views) {
    for (const FrameIndex frame : r.frames) {
      if (!capture.source->has(view, frame)) continue;
      const Image<u8vec3> photo = capture.source->photo(view, frame);
      Image<std::uint8_t> mask = capture.source->mask(view, frame);
      if (mask.empty()) mask = Image<std::uint8_t>(photo.width, photo.height, 255);
      const fs::path file =
          scratch.path() / "rgb" / capture.views[view.value].name / (capture.frames[frame.value] + ".png");
      const PictureScore s = scorePicture(planesOf(readPhoto(file)), planesOf(photo), mask);
      mean["psnr"] += s.psnr, mean["ssim"] += s.ssim, mean["psnr_mask"] += s.psnr_mask;
      ++n;
    }
  }
  for (auto& [key, value] : mean) value /= n;
  mean["pictures"] = n;
  return {{"rgb_held_out", mean}};
}

int runEvaluate(const EvaluateFlags& flags, CommandContext& context) {
  const Project project = Project::open(flags.project, context.services.pipeline);
  const ScoreTable table = flags.truth.empty() ? scoreHeldOut(flags, project, context)
                                               : scoreAgainstTruth(flags, project, context);
  context.console.endProgress();
  context.console.print(scoreText(table));
  const std::string json = scoreJson(table);
  if (!flags.json.empty()) writeFileAtomically(flags.json, json + "\n");
  if (!project.readOnly()) writeFileAtomically(project.folder() / "evaluation.json", json + "\n");
  return 0;
}

}  // namespace

void addEvaluateCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<EvaluateFlags>();
  CLI::App* command =
      app.add_subcommand("evaluate", "Score a project against ground truth, or its held-out photographs");
  command->add_option("PROJECT", flags->project, "Project folder")->required();
  command->add_option("--ground-truth", flags->truth, "Data set folder with dataset.json and gt/");
  command->add_option("--pictures", flags->pictures,
                      "Score the pictures that render wrote here instead of new ones");
  command->add_option("--frames", flags->frames, "Frames: 0-7, 1,5, 1-9x2 or all that are solved");
  command->add_option("--json", flags->json, "Also write the scores to this file");
  addDeviceFlags(*command, flags->device);
  command->callback(
      [flags, &context] { context.action = [flags, &context] { return runEvaluate(*flags, context); }; });
}

}  // namespace beam
