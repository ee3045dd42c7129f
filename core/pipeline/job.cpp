// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <new>
#include <thread>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "core/io/file.h"
#include "core/pipeline/checkpoint_files.h"
#include "core/pipeline/disk_use.h"
#include "core/pipeline/lock_reach.h"
#include "core/pipeline/pending_reason.h"
#include "core/pipeline/version.h"
#include "core/render/device.h"

namespace beam {
namespace {

bool readsPictures(const StepInfo& step) {
  return std::find(step.reads.begin(), step.reads.end(), Reads::Pictures) != step.reads.end();
}

// A bad frame does not stop the others; a full disk or memory would stop them too.
bool spoilsOneFrameOnly(Error::Kind kind) { return kind == Error::Kind::Data || kind == Error::Kind::Bug; }

}  // namespace

Job::Job(Project& project, ComputeDevice& device, std::stop_token stop, const StopWishes& wishes, Tell tell,
         Slot<JobPreview>& preview)
    : project_(project),
      device_(device),
      stop_(std::move(stop)),
      wishes_(wishes),
      tell_(std::move(tell)),
      preview_(preview) {
  sink_ = addLogSink([this](const LogRecord& record) {
    if (record.level != LogLevel::Warning) return;
    {
      std::lock_guard lock(warnings_mutex_);
      warnings_.push_back(record.text);
    }
    tell_(JobWarning{record.text});
  });
}

Job::~Job() { removeLogSink(sink_); }

JobFinished Job::run(const RunRequest& request) {
  const auto fail = [&](Error::Kind kind, std::string message) {
    finished_.outcome = JobOutcome::Failed;
    finished_.kind = kind;
    finished_.message = std::move(message);
  };
  try {
    runAll(request);
    finished_.outcome = finished_.failed.empty() ? JobOutcome::Done : JobOutcome::DoneWithFailures;
  } catch (const Cancelled&) {
    finished_.outcome = JobOutcome::Cancelled;
  } catch (const AtRest&) {
    finished_.outcome = JobOutcome::Cancelled;
    finished_.at_rest = true;
    finished_.notes.push_back(restNote());
  } catch (const Error& e) {
    fail(e.kind(), e.kind() == Error::Kind::OutOfMemory ? memoryText()
                   : e.kind() == Error::Kind::Storage   ? storageText(e)
                                                        : e.what());
  } catch (const std::filesystem::filesystem_error& e) {
    const Error storage = storageError(e);
    fail(storage.kind(), storageText(storage));
  } catch (const std::bad_alloc&) {
    fail(Error::Kind::OutOfMemory, memoryText());
  } catch (const std::exception& e) {
    fail(Error::Kind::Bug,
         fmt::format("a bug of BEAM Studio{}: {}; what is finished is kept; please report it with the newest "
                     "file of \"{}\"",
                     placeText(), e.what(), (project_.folder() / "logs").string()));
  }
  finished_.seconds = secondsSince(started_);
  return finished_;
}

std::string Job::placeText() const {
  if (now_.step.empty()) return " in the preparation";
  return fmt::format(" in {}{}", now_.step.text(), now_.frame ? ", frame " + now_.frame_name : std::string());
}

std::string Job::storageText(const Error& e) const {
  return fmt::format(
      "{}; what is finished is kept, and the same command goes on once the disk can be written", e.what());
}

// Memory may be short for this, too.
std::string Job::memoryText() const try {
  std::vector<std::string> ways;
  if (!now_.step.empty()) {
    const StepMemory& memory = project_.setup().stages.step(now_.step).memory;
    const auto add = [&](const char* verb, const std::vector<std::string>& settings) {
      for (const std::string& name : settings)
        ways.push_back(fmt::format("{} {} (now {})", verb, name, toText(project_.value(name))));
    };
    add("raise", memory.raise);
    add("lower", memory.lower);
  }
  return fmt::format("out of memory{}: {} are free; close other programs{}", placeText(),
                     sizeText(availableMemoryBytes()),
                     ways.empty() ? std::string() : fmt::format(", or {}", fmt::join(ways, " or ")));
} catch (const std::exception&) {
  return "out of memory; close other programs";
}

void Job::runAll(const RunRequest& request) {
  makeRunPlan(project_, request);  // what cannot be run changes no takes
  project_.forgetKeys();
  if (!project_.readOnly()) {
    requireSharedLocks(project_.folder());
    Progress progress(stop_);
    project_.store().removeStale(progress);
  }
  arrangeTakes(project_, request);
  const RunPlan plan = makeRunPlan(project_, request);
  finished_.notes = plan.notes;
  finished_.frames = static_cast<int>(
      std::count_if(plan.turns.begin(), plan.turns.end(), [](const Turn& turn) { return !turn.lead(); }));
  left_.know(request.times);
  for (const StepId& step : plan.project_steps) expect(step, std::nullopt);
  for (const Turn& turn : plan.turns) {
    for (const StepId& step : stepsOf(plan, turn)) expect(step, turn);
  }
  runProjectSteps(plan);
  runFrames(plan);
  tidyTakes();
}

// What is solved is solved, whatever keeps this from being done now: the next run does it.
void Job::tidyTakes() {
  now_ = {};
  try {
    Progress progress(stop_);
    project_.dropOutdoneTakes(progress);
  } catch (const Cancelled&) {
  } catch (const std::exception& e) {
    logDebug("earlier takes stay: {}", e.what());
  }
}

void Job::runProjectSteps(const RunPlan& plan) {
  for (const StepId& step : plan.project_steps) {
    restAfter(wishes_.after_frame && last_);  // there is no frame yet: it is as good as one
    while (runStep(step, std::nullopt) == Ended::Busy) waitALittle();
  }
}

void Job::runFrames(const RunPlan& plan) {
  std::deque<Turn> todo(plan.turns.begin(), plan.turns.end());
  planned_.insert(plan.turns.begin(), plan.turns.end());
  pending_ = planned_;
  for (const StepId& step : plan.frame_steps) {
    if (readsPictures(project_.setup().stages.step(step))) picture_steps_.push_back(step);
  }
  std::size_t busy_in_a_row = 0;
  while (!todo.empty()) {
    const Turn turn = todo.front();
    todo.pop_front();
    next_ = todo.empty() ? std::nullopt : std::optional(todo.front());
    restAfter(wishes_.after_frame);
    const Ended ended = runFrame(plan, turn);
    if (ended == Ended::Lost) {
      todo.push_front(turn);
      todo.push_front(*turnBefore(turn));
      continue;
    }
    if (ended != Ended::Busy) {
      pending_.erase(turn);
      busy_in_a_row = 0;
      continue;
    }
    // Somebody else is at this frame: take the others first, and wait only when all are taken.
    todo.push_back(turn);
    if (++busy_in_a_row < todo.size()) continue;
    waitALittle();
    busy_in_a_row = 0;
  }
}

Job::Ended Job::runFrame(const RunPlan& plan, const Turn& turn) {
  if (const auto lacked = waits_for_.find(turn); lacked != waits_for_.end()) {
    if (awaitsFrameBefore(turn) && !project_.store().has(lacked->second)) return Ended::Busy;
    waits_for_.erase(lacked);
  }
  bool failed = false;
  for (const StepId& step : stepsOf(plan, turn)) {
    if (failed) {
      drop(step, turn);
      continue;
    }
    Ended ended = Ended::Computed;
    try {
      ended = runStep(step, turn);
    } catch (const Error& e) {
      if (!spoilsOneFrameOnly(e.kind())) throw;
      failFrame(refTo(step, turn), e.what());
      failed_.insert(turn);
      drop(step, turn);
      failed = true;
    }
    if (ended == Ended::Busy) return ended;
    if (ended != Ended::Lost) continue;
    // What ails project.json here is no fault of the frame.
    if (takeUpAgain(plan, *turnBefore(turn))) return ended;
    splitTakeAt(plan, turn);
    return runFrame(plan, turn);
  }
  return Ended::Computed;
}

Job::Ended Job::runStep(const StepId& step, std::optional<Turn> turn) {
  if (stop_.stop_requested()) throw Cancelled();
  if (acknowledged_.contains({step, turn})) return Ended::Reused;
  restAfter(wishes_.after_step);
  const StepInfo& info = project_.setup().stages.step(step);
  turn_ = turn;
  now_ = refTo(step, turn);
  if (const std::string stage(step.stage()); stages_told_.emplace(stage, turn).second) {
    tell_(StageStarted{stage, now_.frame, now_.frame_name});
  }
  const KeyIngredients ingredients =
      project_.ingredients(step, takeAtWork(), turn ? turn->frame : FrameIndex{});
  const Digest key = keyOf(ingredients);
  weight_now_ = info.weight;
  const auto reuse = [&] {
    drop(step, turn);
    acknowledge(now_, key, true, 0);
    return Ended::Reused;
  };
  if (project_.store().verified(key)) return reuse();
  if (const Ended ready = afterPrevious(info, ingredients, turn.value_or(Turn{})); ready != Ended::Computed)
    return ready;
  if (project_.readOnly()) {
    throw Error(
        Error::Kind::Storage,
        fmt::format("\"{}\" is read-only: {} cannot be computed because its result could not be kept; make "
                    "the folder writable or copy it",
                    project_.folder().string(), step.text()));
  }
  const std::optional<FileLock> lease = project_.store().tryLease(key);
  if (!lease) {
    if (!met_) met_ = JobWaiting{now_, project_.store().leaseHolder(key)};
    return Ended::Busy;
  }
  if (project_.store().verified(key)) return reuse();  // published between the look and the lease
  computeWithin(now_, ingredients, key);
  return Ended::Computed;
}

std::optional<Turn> Job::turnBefore(const Turn& turn) const {
  const Take take = takeOf(turn);
  const std::optional<FrameIndex> before = take.before(turn.frame);
  if (!before) return std::nullopt;
  const Turn lead{*before, turn.of}, own{*before, *before};
  const bool owned = project_.takeOf(*before) == take;
  return owned && planned_.contains(own) && !planned_.contains(lead) ? own : lead;
}

// Whether this run is still to solve the frame before in the same take.
bool Job::awaitsFrameBefore(const Turn& turn) const {
  const std::optional<Turn> before = turnBefore(turn);
  return before && pending_.contains(*before);
}

bool Job::takeUpAgain(const RunPlan& plan, const Turn& turn) {
  if (failed_.contains(turn) || !again_.insert(turn).second) return false;
  for (const StepId& step : stepsOf(plan, turn)) {
    acknowledged_.erase({step, turn});
    expect(step, turn);
  }
  pending_.insert(turn);
  return true;
}

std::vector<StepId> Job::stepsOf(const RunPlan& plan, const Turn& turn) const {
  std::vector<StepId> steps = turn.lead() ? plan.lead_steps : plan.frame_steps;
  const Take take = takeOf(turn);
  std::erase_if(
      steps, [&](const StepId& id) { return !applies(project_.setup().stages.step(id), take, turn.frame); });
  return steps;
}

Job::Ended Job::afterPrevious(const StepInfo& step, const KeyIngredients& ingredients, const Turn& turn) {
  for (const StepId& previous : step.later.previous) {
    const auto key = ingredients.previous.find(previous);
    if (key == ingredients.previous.end() || project_.store().verified(key->second)) continue;
    if (!awaitsFrameBefore(turn)) return Ended::Lost;
    waits_for_[turn] = key->second;
    return Ended::Busy;
  }
  return Ended::Computed;
}

// A frame whose predecessor failed goes on as the first of a take of its own.
void Job::splitTakeAt(const RunPlan& plan, const Turn& turn) {
  const Take take = takeOf(turn);
  const FrameIndex before = *take.before(turn.frame);
  logWarning("frame {} begins a new take: frame {}, on which it would build, has no result",
             refTo({}, turn).frame_name, refTo({}, Turn{before, before}).frame_name);
  for (const StepId& step : stepsOf(plan, turn)) {
    if (acknowledged_.contains({step, turn})) {
      weight_total_ -= project_.setup().stages.step(step).weight;
    } else {
      drop(step, turn);
    }
  }
  project_.splitTake(take, turn.frame);
  for (const StepId& step : stepsOf(plan, turn)) expect(step, turn);
  for (const StepId& step : plan.frame_steps) {
    if (acknowledged_.erase({step, turn}) > 0)
      weight_total_ += project_.setup().stages.step(step).weight;  // to be done once more
  }
}

StepKind Job::kindOf(const StepId& step, std::optional<Turn> turn) const {
  const bool later =
      turn && takeOf(*turn).before(turn->frame) && !project_.setup().stages.step(step).later.empty();
  return {step, later, settingsDigest(project_.parametersOf(step, later))};
}

void Job::expect(const StepId& step, std::optional<Turn> turn) {
  const StepKind kind = kindOf(step, turn);
  const StepSize size = sizeOf(project_, step, kind.later);
  weight_total_ += size.weight;
  left_.expect(kind, size);
}

void Job::drop(const StepId& step, std::optional<Turn> turn) {
  weight_total_ -= project_.setup().stages.step(step).weight;
  left_.drop(kindOf(step, turn));
}

void Job::computeWithin(const StepRef& ref, const KeyIngredients& ingredients, const Digest& key) {
  try {
    return compute(ref, ingredients, key);
  } catch (const std::bad_alloc&) {
    if (!pictures_ || !pictures_->giveUp()) throw;
  }
  logDebug("{}: memory is short; once more, without decoded pictures kept for later", ref.step.text());
  compute(ref, ingredients, key);
}

FrameStore* Job::picturesFor(FrameIndex frame) {
  if (!pictures_) pictures_ = std::make_unique<FrameStore>(project_.capture());
  if (pictures_of_ == frame) return pictures_.get();
  pictures_of_ = frame;
  pictures_->expect(std::nullopt);
  try {
    if (next_ && project_.lacksAny(picture_steps_, takeOf(*next_), next_->frame))
      pictures_->expect(next_->frame);
  } catch (const Error& e) {
    logDebug("no pictures are decoded ahead: {}", e.what());  // said again when it is the frame's turn
  }
  return pictures_.get();
}

void Job::compute(const StepRef& ref, const KeyIngredients& ingredients, const Digest& key) {
  if (!log_) log_ = std::make_unique<SessionLog>(project_.folder());
  if (!std::exchange(records_read_, true)) left_.know(readStepTimes(project_));
  step_started_ = Clock::now();
  {
    std::lock_guard lock(warnings_mutex_);
    warnings_.clear();
  }
  ResultRecord record;
  record.ingredients = ingredients;
  record.frame = ref.frame_name;
  record.lead = ref.lead;
  project_.store().publish(key, std::move(record), [&](const std::filesystem::path& folder, ResultRecord& r) {
    build(ref, folder, r);
    checkInputs(ref, ingredients);
  });
  project_.store().clearFailure(key);
  project_.store().clearCheckpoint(key);
  returnFreeMemory();
  const double seconds = secondsSince(step_started_);
  logInfo("{}{} done in {:.1f} s", ref.step.text(), ref.frame ? ", frame " + ref.frame_name : std::string(),
          seconds);
  weight_done_ += weight_now_;
  left_.finish(kindOf(ref.step, turn_), seconds);
  last_ = ref;
  met_.reset();
  waits_told_.reset();
  acknowledge(ref, key, false, seconds);
}

void Job::build(const StepRef& ref, const std::filesystem::path& folder, ResultRecord& record) {
  const StepInfo& info = project_.setup().stages.step(ref.step);
  const FrameIndex frame = ref.frame.value_or(FrameIndex{});
  Progress progress(stop_, [&](const ProgressReport& report) { reportProgress(ref, report); });
  reportProgress(ref, {0, info.title, 0, 0});
  StepContext context{
      project_.capture(),
      frame,
      project_.environmentFile(),
      folder,
      {},
      [this](std::string_view name) { return project_.value(name); },
      device_,
      progress,
      [this, ref](std::shared_ptr<const GaussianCloud> cloud) {
        preview_.publish(std::make_shared<const JobPreview>(JobPreview{ref, std::move(cloud)}));
      },
  };
  for (const auto& [step, key] : record.ingredients.upstream) context.inputs[step] = resultOf(step, key, ref);
  for (const auto& [step, key] : record.ingredients.previous)
    context.previous[step] = resultOf(step, key, ref);
  if (ref.frame && readsPictures(info)) context.frames = picturesFor(frame);
  context.is_later = record.ingredients.later;
  CheckpointFiles checkpoint(project_.store().checkpointOf(record.key));
  context.checkpoint = &checkpoint;
  project_.makeStage(ref.step.stage())->run(info.id, context);
  record.program_version = kProgramVersion;
  record.device = device_.info().title;
  record.threads = threadCount();
  record.seconds = secondsSince(step_started_);
  record.work = project_.workOf(ref.step, record.ingredients.later);
  record.peak_memory_bytes = peakMemoryBytes();
  record.scores = context.scores;
  record.pictures = picturesRead(project_, info, frame);
  std::lock_guard lock(warnings_mutex_);
  record.warnings = warnings_;
}

std::filesystem::path Job::resultOf(const StepId& step, const Digest& key, const StepRef& reader) const {
  if (std::optional<std::filesystem::path> found = project_.store().verified(key)) return *found;
  throw Error(Error::Kind::Data,
              fmt::format("the result of {} that {} needs is gone; run again to compute it anew", step.text(),
                          reader.step.text()));
}

// A result made while its input changed would sit under a key that promises something else.
void Job::checkInputs(const StepRef& ref, const KeyIngredients& before) const {
  const FrameIndex frame = ref.frame.value_or(FrameIndex{});
  if (project_.ingredients(ref.step, takeAtWork(), frame).inputs == before.inputs) return;
  throw Error(Error::Kind::Data,
              fmt::format("input files of {} changed while it ran; its result is not kept, run again",
                          ref.step.text()));
}

void Job::failFrame(const StepRef& ref, const std::string& message) {
  const std::string told = fmt::format("frame {}: {} gave up: {}", ref.frame_name, ref.step.text(), message);
  try {
    project_.store().noteFailure(project_.key(ref.step, takeAtWork(), *ref.frame),
                                 {ref.step, ref.frame_name, message});
  } catch (const Error& e) {
    logWarning("the failure of frame {} could not be noted: {}", ref.frame_name, e.what());
  }
  logDebug("{}", told);
  const StepFailed failed{ref, message};
  tell_(failed);
  // Nobody asked for a lead: what it was to lead begins anew.
  if (!ref.lead) finished_.failed.push_back(failed);
}

void Job::acknowledge(const StepRef& ref, const Digest& key, bool reused, double seconds) {
  acknowledged_.emplace(ref.step, turn_);
  ++(reused ? finished_.reused : finished_.computed);
  tell_(StepFinished{ref, key, reused, seconds});
}

void Job::reportProgress(const StepRef& ref, const ProgressReport& report) {
  StepProgress event{ref, report};
  const double worked = weight_done_ + weight_now_ * report.fraction;
  event.job_fraction = weight_total_ > 0 ? worked / weight_total_ : 0;
  event.seconds_elapsed = secondsSince(started_);
  const double in_step = secondsSince(step_started_);
  if (const auto left = left_.left(kindOf(ref.step, turn_), report, in_step)) {
    event.seconds_left = left->likely;
    event.seconds_left_low = left->low;
    event.seconds_left_high = left->high;
  }
  event.rate = left_.rate();
  tell_(std::move(event));
}

void Job::waitALittle() {
  if (stop_.stop_requested()) throw Cancelled();
  restAfter(wishes_.any());
  const auto same = [](const JobWaiting& a, const JobWaiting& b) {
    return a.ref.step == b.ref.step && a.ref.frame == b.ref.frame && a.holder == b.holder;
  };
  if (met_ && !(waits_told_ && same(*met_, *waits_told_))) {
    tell_(*met_);
    waits_told_ = met_;
  }
  met_.reset();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

void Job::restAfter(bool fulfilled) const {
  if (fulfilled) throw AtRest();
}

std::string Job::restNote() const {
  if (!last_) return "stopped before the first step, as asked";
  const std::string& title = project_.setup().stages.step(last_->step).title;
  return fmt::format("stopped after \"{}\"{}, as asked; the next run goes on from there", title,
                     last_->frame ? " of frame " + last_->frame_name : std::string());
}

StepRef Job::refTo(const StepId& step, std::optional<Turn> turn) const {
  if (!turn) return {step, std::nullopt, {}};
  const auto index = static_cast<std::size_t>(turn->frame.value);
  return {step, turn->frame, project_.capture().frames[index], turn->lead()};
}

double Job::secondsSince(Clock::time_point start) const {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace beam
