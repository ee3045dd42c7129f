// SPDX-License-Identifier: Apache-2.0
#include "core/work/evaluate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/method/score_views.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/scene/frame_views.h"
#include "core/stages/project_sequence.h"
#include "core/stages/render_channels.h"
#include "core/work/evaluate_over_time.h"
#include "core/work/ground_truth.h"
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

// Channels the solved frames can give and the truth can judge.
RenderRequest picturesFor(const EvaluateRequest& request, const GaussianSequence& sequence,
                          const GroundTruth& truth, const fs::path& out, const Progress& progress) {
  RenderRequest r;
  r.out = out;
  r.frames = selectSolvedFrames(request.frames, sequence, progress);
  for (const View& view : request.project.capture().views) {
    const auto& tests = truth.test_cameras;
    if (std::find(tests.begin(), tests.end(), view.name) != tests.end()) r.views.push_back(view);
  }
  if (r.views.empty()) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\" has none of the test cameras of \"{}\"", sequence.id(),
                                               truth.folder.string()));
  }
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

EvaluateOutcome scoreAgainstTruth(const EvaluateRequest& request, GroundTruth truth, ComputeDevice& device,
                                  Progress& progress) {
  align(truth, request.project.capture());
  EvaluateOutcome e;
  if (!request.pictures.empty()) {
    e.table = scorePictures(truth, request.pictures, progress, e.each);
    return e;
  }
  const ScratchFolder scratch;
  const auto sequence = sequenceOf(request.project, Shows::Solved);
  const RenderRequest pictures = picturesFor(request, *sequence, truth, scratch.path(), progress);
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
EvaluateOutcome scoreHeldOut(const EvaluateRequest& request, ComputeDevice& device, Progress& progress) {
  const CaptureSet& capture = request.project.capture();
  const auto sequence = sequenceOf(request.project, Shows::Solved);
  const std::vector<FrameIndex> frames = selectSolvedFrames(request.frames, *sequence, progress);
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
  EvaluateRequest solved = request;
  std::vector<std::string> changes;
  if (request.pictures.empty()) {
    const WantedResults wanted{.frames = request.frames, .materials_if_any = true, .strict = request.strict};
    LastSolved last = lastSolved(request.project, wanted, progress);
    last.tell();
    solved.project = std::move(last.project);
    changes = std::move(last.changes);
  }
  EvaluateOutcome outcome = truth ? scoreAgainstTruth(solved, std::move(*truth), device, progress)
                                  : scoreHeldOut(solved, device, progress);
  for (auto& row : motionTable(outcome.each)) outcome.table.push_back(std::move(row));
  outcome.setting_changes = std::move(changes);
  return outcome;
}

void keepEvaluation(const Project& project, const EvaluateOutcome& outcome) {
  if (project.readOnly()) return;
  writeFileAtomically(project.folder() / kEvaluationFile,
                      scoreJson(outcome.table, outcome.setting_changes) + "\n");
  writeFileAtomically(project.folder() / kEvaluationFramesFile,
                      scoreJson(outcome.table, outcome.each, outcome.setting_changes) + "\n");
}

}  // namespace beam
