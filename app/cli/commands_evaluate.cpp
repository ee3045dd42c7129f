// SPDX-License-Identifier: Apache-2.0
// beam evaluate: scores against ground truth, or of the held-out photographs.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/evaluate_over_time.h"
#include "app/cli/ground_truth.h"
#include "app/cli/selection.h"
#include "core/base/error.h"
#include "core/io/file.h"
#include "core/method/score_views.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/scene/frame_views.h"
#include "core/stages/project_sequence.h"
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
RenderRequest requestFor(const GaussianSequence& sequence, const CaptureSet& capture,
                         const GroundTruth& truth, const std::string& frames, const fs::path& out) {
  RenderRequest r;
  r.out = out;
  r.frames = selectSolvedFrames(frames, sequence);
  for (const View& view : capture.views) {
    const auto& tests = truth.test_cameras;
    if (std::find(tests.begin(), tests.end(), view.name) != tests.end()) r.views.push_back(view);
  }
  if (r.views.empty()) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\" has none of the test cameras of \"{}\"", sequence.id(),
                                               truth.folder.string()));
  }
  bool materials = true, meshes = true;
  for (const FrameIndex f : r.frames) {
    const FrameContent content = sequence.content(f);
    materials &= content.materials;
    meshes &= content.mesh;
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

// What a way of scoring found: the means, and every picture's and frame's own.
struct Evaluated {
  ScoreTable table;
  PictureScores each;
};

Evaluated scoreAgainstTruth(const EvaluateFlags& flags, const Project& project, CommandContext& context) {
  GroundTruth truth = openGroundTruth(flags.truth);
  truth.unit_m = inverse(project.capture().capture_from_world).scale;
  Progress progress(context.stop, context.console.listener());
  Evaluated e;
  if (!flags.pictures.empty()) {
    e.table = scorePictures(truth, flags.pictures, progress, e.each);
    return e;
  }
  const ScratchFolder scratch;
  const std::shared_ptr<ComputeDevice> device = makeDevice(flags.device);
  const auto sequence = sequenceOf(project, Shows::Solved);
  const RenderRequest request = requestFor(*sequence, project.capture(), truth, flags.frames, scratch.path());
  {
    Progress part = progress.part(0.5, "render");
    renderChannels(*sequence, request, *newCpuSceneRenderer(device), part);
  }
  {
    Progress part = progress.part(0.3, "score");
    e.table = scorePictures(truth, scratch.path(), part, e.each);
  }
  Progress part = progress.part(0.2, "compare frames");
  scoreMotion(*sequence, request.views, request.frames, &truth, *device, part, e.each);
  return e;
}

void addMean(const std::string& row, const std::vector<PictureScore>& scores, ScoreTable& table) {
  if (scores.empty()) return;
  Scores mean;
  for (const PictureScore& s : scores)
    mean["psnr"] += s.psnr, mean["ssim"] += s.ssim, mean["psnr_mask"] += s.psnr_mask;
  for (auto& [key, value] : mean) value /= static_cast<double>(scores.size());
  mean["pictures"] = static_cast<double>(scores.size());
  table.emplace_back(row, mean);
}

// Held-out photographs at their full size, whichever cameras have one of the frame.
Evaluated scoreHeldOut(const EvaluateFlags& flags, const Project& project, CommandContext& context) {
  const CaptureSet& capture = project.capture();
  const auto sequence = sequenceOf(project, Shows::Solved);
  const std::vector<FrameIndex> frames = selectSolvedFrames(flags.frames, *sequence);
  const auto device = makeDevice(flags.device);
  Progress progress(context.stop, context.console.listener());
  Evaluated e;
  std::vector<PictureScore> all;
  for (const FrameIndex frame : frames) {
    Progress part = progress.part(0.8 / static_cast<double>(frames.size()), "score");
    const std::shared_ptr<const GaussianFrame> result = sequence->load(frame);
    if (!result) {
      throw Error(Error::Kind::Data,
                  fmt::format("frame {} is not solved yet: run it first", nameOf(*sequence, frame)));
    }
    for (const ViewScore& v : scoreViews(loadFrameViews(capture, frame, Split::Test, 1, part), true,
                                         result->cloud, *device, part)) {
      Scores& own = e.each[nameOf(*sequence, frame)][v.camera];
      own["rgb.psnr"] = v.score.psnr;
      own["rgb.ssim"] = v.score.ssim;
      own["rgb.psnr_mask"] = v.score.psnr_mask;
      all.push_back(v.score);
    }
  }
  if (all.empty()) {
    throw Error(Error::Kind::Data,
                "no held-out photographs: name a data set with --ground-truth, or process the capture "
                "with --hold-out");
  }
  addMean("rgb_held_out", all, e.table);
  Progress part = progress.part(0.2, "compare frames");
  scoreMotion(*sequence, {}, frames, nullptr, *device, part, e.each);
  return e;
}

int runEvaluate(const EvaluateFlags& flags, CommandContext& context) {
  const Project project = Project::open(flags.project, context.services.pipeline);
  Evaluated e = flags.truth.empty() ? scoreHeldOut(flags, project, context)
                                    : scoreAgainstTruth(flags, project, context);
  for (auto& row : motionTable(e.each)) e.table.push_back(std::move(row));
  context.console.endProgress();
  context.console.print(scoreText(e.table));
  const std::string frames = scoreJson(e.table, e.each) + "\n";
  if (!flags.json.empty()) writeFileAtomically(flags.json, frames);
  if (project.readOnly()) return 0;
  writeFileAtomically(project.folder() / "evaluation.json", scoreJson(e.table) + "\n");
  writeFileAtomically(project.folder() / kEvaluationFramesFile, frames);
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
  command->add_option("--json", flags->json,
                      "Also write the scores to this file, with every frame's and camera's own");
  addDeviceFlags(*command, flags->device);
  command->callback(
      [flags, &context] { context.action = [flags, &context] { return runEvaluate(*flags, context); }; });
}

}  // namespace beam
