// SPDX-License-Identifier: Apache-2.0
#include "core/work/evaluate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/file.h"
#include "core/method/score_views.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/scene/frame_list.h"
#include "core/scene/frame_views.h"
#include "core/stages/picture_files.h"
#include "core/stages/project_sequence.h"
#include "core/stages/relight_settings.h"
#include "core/stages/render_channels.h"
#include "core/work/evaluate_over_time.h"
#include "core/work/ground_truth.h"
#include "core/work/kept_evaluation.h"
#include "core/work/last_solved.h"
#include "core/work/selection.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

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

std::vector<View> testViews(const Project& project, const GroundTruth& truth) {
  std::vector<View> views;
  for (const View& view : project.capture().views) {
    const auto& tests = truth.test_cameras;
    if (std::find(tests.begin(), tests.end(), view.name) != tests.end()) views.push_back(view);
  }
  if (views.empty()) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\" has none of the test cameras of \"{}\"",
                                               project.folder().string(), truth.folder.string()));
  }
  return views;
}

// Channels the solved frames can give and the truth can judge.
RenderRequest picturesFor(const GaussianSequence& sequence, const GroundTruth& truth,
                          std::vector<FrameIndex> frames, std::vector<View> views, const fs::path& out,
                          const Progress& progress) {
  RenderRequest r;
  r.out = out;
  r.frames = std::move(frames);
  r.views = std::move(views);
  bool materials = true, meshes = true;
  for (const FrameIndex f : r.frames) {
    progress.check();
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

// `render --layers` wrote one file a camera and frame, which no other program's evaluator reads either.
void requireNoLayers(const GroundTruth& truth, const fs::path& pictures) {
  if (!fs::is_directory(pictures / kLayersFolder)) return;
  const std::string found =
      fmt::format("\"{}\" holds channels as layers of one EXR file ({}/), which evaluate does not read",
                  pictures.string(), kLayersFolder);
  constexpr const char* kAdvice = "to score them, write a folder a channel with beam render without --layers";
  if (!hasPictures(truth, pictures)) throw Error(Error::Kind::Data, fmt::format("{}; {}", found, kAdvice));
  logWarning("{}: they are left out; {}", found, kAdvice);
}

EvaluateOutcome scoreForeignPictures(const EvaluateRequest& request, GroundTruth truth, Progress& progress) {
  align(truth, request.project.capture());
  if (!isAllFrames(request.frames)) {
    const CaptureSet& capture = request.project.capture();
    std::vector<std::string> names;
    for (const FrameIndex f : parseFrameList(request.frames, capture.frames))
      names.push_back(capture.frames[static_cast<std::size_t>(f.value)]);
    keepFrames(truth, names);
  }
  requireNoLayers(truth, request.pictures);
  EvaluateOutcome e;
  e.table = scorePictures(truth, request.pictures, progress, e.each);
  return e;
}

EvaluateOutcome scoreAgainstTruth(const EvaluateRequest& request, const LastSolved& last, GroundTruth truth,
                                  ComputeDevice& device, Progress& progress) {
  align(truth, last.project.capture());
  const auto sequence = sequenceOf(last.project, Shows::Solved);
  std::vector<FrameIndex> frames = selectSolvedFrames(request.frames, *sequence, progress);
  std::vector<std::string> names;
  for (const FrameIndex f : frames) names.push_back(nameOf(*sequence, f));
  keepFrames(truth, names);
  std::vector<View> views = testViews(last.project, truth);
  requireFits(truth, views);
  last.tell();
  const ScratchFolder scratch;
  RenderRequest pictures =
      picturesFor(*sequence, truth, std::move(frames), std::move(views), scratch.path(), progress);
  pictures.lighting = plainLighting(request.project);
  EvaluateOutcome e;
  {
    Progress part = progress.part(0.5, "render");
    renderChannels(*sequence, pictures, *newCpuSceneRenderer(device), part);
  }
  {
    Progress part = progress.part(0.3, "score");
    e.table = scorePictures(truth, scratch.path(), part, e.each);
  }
  Progress part = progress.part(0.2, "compare frames");
  scoreMotion(*sequence, pictures.views, pictures.frames, &truth, device, part, e.each);
  e.origin.results = resultsOf(*sequence, pictures.frames, pictures.lighting);
  return e;
}

void addMean(const std::string& row, const std::vector<PictureScore>& scores, ScoreTable& table) {
  if (scores.empty()) return;
  Scores mean;
  put(meanOf(scores), "", mean);
  mean["pictures"] = static_cast<double>(scores.size());
  table.emplace_back(row, mean);
}

// Held-out photographs at their full size, whichever cameras have one of the frame.
EvaluateOutcome scoreHeldOut(const EvaluateRequest& request, const LastSolved& last, ComputeDevice& device,
                             Progress& progress) {
  const CaptureSet& capture = last.project.capture();
  const auto sequence = sequenceOf(last.project, Shows::Solved);
  const std::vector<FrameIndex> frames = selectSolvedFrames(request.frames, *sequence, progress);
  last.tell();
  EvaluateOutcome e;
  std::vector<PictureScore> all;
  for (const FrameIndex frame : frames) {
    Progress part = progress.part(0.8 / static_cast<double>(frames.size()), "score");
    const std::shared_ptr<const GaussianFrame> result = solvedFrame(*sequence, frame);
    for (const ViewScore& v : scoreViews(loadFrameViews(capture, frame, Split::Test, 1, part), true,
                                         result->cloud, device, part)) {
      put(v.score, "rgb.", e.each[nameOf(*sequence, frame)][v.camera]);
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
  scoreMotion(*sequence, {}, frames, nullptr, device, part, e.each);
  e.origin.results = resultsOf(*sequence, frames, plainLighting(request.project));
  return e;
}

}  // namespace

bool hasHeldOutPhotographs(const CaptureSet& capture) {
  for (std::size_t v = 0; v < capture.views.size(); ++v) {
    if (capture.views[v].split != Split::Test) continue;
    for (std::size_t f = 0; f < capture.frames.size(); ++f) {
      if (capture.source->has({static_cast<std::int32_t>(v)}, {static_cast<std::int32_t>(f)})) return true;
    }
  }
  return false;
}

EvaluateOutcome evaluate(const EvaluateRequest& request, ComputeDevice& device, Progress& progress) {
  // Opened first: what cannot be scored is refused before anything is told.
  std::optional<GroundTruth> truth;
  if (!request.ground_truth.empty()) truth = openGroundTruth(request.ground_truth);
  if (!truth && !request.pictures.empty()) {
    throw Error(Error::Kind::Usage,
                "--pictures needs the data set that they are scored against: give --ground-truth FOLDER");
  }
  if (!request.pictures.empty()) return scoreForeignPictures(request, std::move(*truth), progress);
  const LastSolved last =
      lastSolved(request.project,
                 {.frames = request.frames, .materials_if_any = true, .strict = request.strict}, progress);
  EvaluateOutcome outcome = truth ? scoreAgainstTruth(request, last, std::move(*truth), device, progress)
                                  : scoreHeldOut(request, last, device, progress);
  for (auto& row : motionTable(outcome.each)) outcome.table.push_back(std::move(row));
  outcome.origin.setting_changes = last.changes;
  return outcome;
}

void keepEvaluation(const Project& project, const EvaluateOutcome& outcome) {
  if (outcome.origin.results.empty() || project.readOnly()) return;
  writeFileAtomically(project.folder() / kEvaluationFile, scoreJson(outcome.table, outcome.origin) + "\n");
  writeFileAtomically(project.folder() / kEvaluationFramesFile,
                      scoreJson(outcome.table, outcome.each, outcome.origin) + "\n");
}

}  // namespace beam
