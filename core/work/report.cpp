// SPDX-License-Identifier: Apache-2.0
#include "core/work/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/count_text.h"
#include "core/io/file.h"
#include "core/pipeline/output_target.h"
#include "core/pipeline/version.h"
#include "core/stages/project_sequence.h"
#include "core/stages/relight_settings.h"
#include "core/work/evaluate_over_time.h"
#include "core/work/kept_evaluation.h"
#include "core/work/last_solved.h"
#include "core/work/report_page.h"
#include "core/work/score_words.h"
#include "core/work/selection.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

std::vector<std::pair<std::string, std::string>> factsOf(const Project& project) {
  const CaptureSet& capture = project.capture();
  const auto held_out = std::count_if(capture.views.begin(), capture.views.end(),
                                      [](const View& v) { return v.split == Split::Test; });
  const std::size_t train = capture.views.size() - static_cast<std::size_t>(held_out);
  std::vector<std::pair<std::string, std::string>> facts = {
      {"Capture", fmt::format("{}: {} and {}, {}, {}", capture.name, countText(train, "training camera"),
                              countText(held_out, "held-out camera"),
                              countText(capture.frames.size(), "frame"), project.imported().layout)},
      {"Preset", project.document().preset}};
  for (const StageInfo& stage : project.setup().stages.infos()) {
    const std::string reason = project.blockedReason(stage.id);
    if (!reason.empty()) facts.emplace_back(stage.title, reason);
  }
  return facts;
}

// Those that differ from the preset, as they are in force.
std::vector<ReportSetting> settingsOf(const Project& project) {
  const auto& differing = project.document().settings;
  std::vector<ReportSetting> settings;
  for (const Field& f : project.fields()) {
    if (differing.contains(f.info.name))
      settings.push_back({f.info.label, f.info.name, toText(f.value), f.info.unit});
  }
  return settings;
}

// First, middle, last and worst of the frames with results, in order of time.
std::vector<FrameIndex> shownFrames(const QualityHistory& history) {
  std::vector<std::size_t> chosen = worstFrames(history, 1);
  if (!history.frames.empty()) {
    const std::size_t last = history.frames.size() - 1;
    chosen.insert(chosen.end(), {0, last / 2, last});
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  std::vector<FrameIndex> frames;
  frames.reserve(chosen.size());
  for (const std::size_t f : chosen) frames.push_back(history.frames[f].frame);
  return frames;
}

// A held-out camera, a training camera, and the training camera that scores least in the worst frame.
std::vector<std::string> shownCameras(const Project& project, const QualityHistory& history) {
  std::vector<std::string> cameras;
  for (const Split split : {Split::Train, Split::Test}) {
    const auto& views = project.capture().views;
    const auto found =
        std::find_if(views.begin(), views.end(), [&](const View& v) { return v.split == split; });
    if (found != views.end()) cameras.push_back(found->name);
  }
  for (const std::size_t f : worstFrames(history, 1)) {
    const FrameQuality& q = history.frames[f];
    cameras.push_back(q.views[meanOf(q.views, false).worst].camera);
  }
  return cameras;
}

void addScore(QualityHistory& history, const std::string& frame, const std::string& name, double value) {
  const auto found = std::find_if(history.frames.begin(), history.frames.end(),
                                  [&](const FrameQuality& q) { return q.name == frame; });
  if (found != history.frames.end()) found->scores[kEvaluateCurves + name] = value;
}

// One figure a map is enough for a curve; the table has them all.
bool isDrawn(const std::string& score) {
  return !score.ends_with(".ssim") && !score.ends_with(".psnr_mask") &&
         score.find("_scaled.") == std::string::npos;
}

// What `beam evaluate` last found, and of what: of frames that were solved anew since there is no curve.
void addEvaluation(const Project& project, const GaussianSequence& sequence, bool strict, ReportPage& page) {
  std::vector<FrameIndex> frames;
  for (const FrameQuality& q : page.history.frames) frames.push_back(q.frame);
  KeptEvaluation kept = keptEvaluation(project);
  const ScoredResults shown = resultsOf(sequence, frames, plainLighting(project));
  page.evaluation_note = otherResultsText(kept, shown);
  const bool current = page.evaluation_note.empty();
  for (const auto& [frame, scores] : kept.frames) {
    if (!isOf(kept, shown, frame)) continue;
    for (const auto& [name, value] : scores)
      if (isDrawn(name)) addScore(page.history, frame, name, value);
  }
  if (current || !strict) page.evaluation = std::move(kept.table);
  if (!current && strict) page.evaluation_note += "; --strict leaves it out";
}

// Flicker along tracked Gaussians, of the results as they are now.
void addFlicker(const GaussianSequence& sequence, ComputeDevice& device, Progress& progress,
                QualityHistory& history) {
  std::vector<FrameIndex> frames;
  for (const FrameQuality& q : history.frames) frames.push_back(q.frame);
  PictureScores each;
  scoreMotion(sequence, {}, frames, nullptr, device, progress, each);
  for (const auto& [frame, cameras] : each) {
    for (const auto& [name, value] : cameras.at("")) addScore(history, frame, name, value);
  }
}

std::vector<std::string> findingsOf(const ReportPage& page) {
  const QualityHistory& history = page.history;
  std::vector<std::string> findings;
  for (const LeftOutCamera& c : history.left_out)
    findings.push_back(fmt::format("left out of the fit: {}", toText(c, history.defects)));
  if (std::string loss = toText(history.loss); !loss.empty()) findings.push_back(std::move(loss));
  for (const Defect& d : history.defects)
    findings.push_back(fmt::format("camera {} {} ({} {})", d.camera, d.text,
                                   nounText(d.frames.size(), "frame"), fmt::join(d.frames, ", ")));
  if (!page.evaluation_note.empty()) findings.push_back(page.evaluation_note);
  return findings;
}

}  // namespace

ReportOutcome report(const ReportRequest& request, ComputeDevice& device, Progress& progress) {
  requireFileTarget(request.out, {kReportCommand, request.force});
  const LastSolved last =
      lastSolved(request.project, {.materials_if_any = true, .strict = request.strict}, progress);
  const Project& project = last.project;
  const auto sequence = sequenceOf(project, Shows::Solved);
  const std::size_t solved = selectSolvedFrames("all", *sequence, progress).size();
  last.tell();
  ReportPage page{project.name(),
                  kProgramVersion,
                  project.setup().stages.infos(),
                  factsOf(project),
                  settingsOf(project),
                  sequence->frames().size(),
                  {},
                  {},
                  {},
                  {}};
  page.history = qualityHistory(project, progress);
  if (!last.changes.empty())
    page.facts.emplace_back("Of other settings",
                            fmt::format("these results are not of the settings in force; "
                                        "since they were made: {}",
                                        fmt::join(last.changes, ", ")));
  if (!last.left_out.empty()) page.history.warnings.push_back(last.leftOutText());
  if (!last.unfinished.empty()) page.history.warnings.push_back(last.unfinishedText());
  if (!last.bare.empty()) page.history.warnings.push_back(last.bareText());
  addEvaluation(project, *sequence, request.strict, page);
  {
    Progress part = progress.part(0.5, "compare frames");
    addFlicker(*sequence, device, part, page.history);
  }
  {
    Progress part = progress.part(0.5, "contact sheet");
    page.pictures = contactSheet(*sequence, project.capture(), shownFrames(page.history),
                                 shownCameras(project, page.history), device, part);
  }
  writeFileAtomically(request.out, toHtml(page));
  return {solved, page.history.frames.size(), findingsOf(page)};
}

}  // namespace beam
