// SPDX-License-Identifier: Apache-2.0
// Job: the body of a run, on the job's thread. Only the runner makes one.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/base/slot.h"
#include "core/pipeline/frame_store.h"
#include "core/pipeline/job_event.h"
#include "core/pipeline/project.h"
#include "core/pipeline/run_plan.h"
#include "core/pipeline/session_log.h"
#include "core/pipeline/stop_wishes.h"
#include "core/pipeline/time_left.h"

namespace beam {

class Job {
 public:
  using Tell = std::function<void(JobEvent)>;
  // `project` gets the takes that the run is about.
  Job(Project& project, ComputeDevice& device, std::stop_token stop, const StopWishes& wishes, Tell tell,
      Slot<JobPreview>& preview);
  ~Job();

  // Never throws: what went wrong is in the answer.
  JobFinished run(const RunRequest& request);

 private:
  enum class Ended {
    Computed,
    Reused,
    Busy,  // another process computes it, or what it builds on in the frame before
    Lost   // the frame before has not got it, and this run has not tried to make it
  };
  using Clock = std::chrono::steady_clock;
  struct AtRest {};  // thrown between steps when a wish to stop after something is fulfilled

  void runAll(const RunRequest& request);
  void runProjectSteps(const RunPlan& plan);
  void runFrames(const RunPlan& plan);
  // Busy: come back later.
  Ended runFrame(const RunPlan& plan, const Turn& turn);
  Ended runStep(const StepId& step, std::optional<Turn> turn);
  // Whether a step can begin now; another answer when what it reads of the frame before is not there.
  Ended afterPrevious(const StepInfo& step, const KeyIngredients& ingredients, const Turn& turn);
  void splitTakeAt(const RunPlan& plan, const Turn& turn);
  void tidyTakes();
  // The turn of the frame before in the same take, the planned one where there is; none for the first.
  std::optional<Turn> turnBefore(const Turn& turn) const;
  // Gives the turn back to a frame that was done; false: it failed, or had it back already.
  bool takeUpAgain(const RunPlan& plan, const Turn& turn);
  Take takeOf(const Turn& turn) const { return project_.takeOf(turn.of); }
  bool awaitsFrameBefore(const Turn& turn) const;
  std::vector<StepId> stepsOf(const RunPlan& plan, const Turn& turn) const;
  StepKind kindOf(const StepId& step, std::optional<Turn> turn) const;
  // Into the sums of what is to do, and out of them again when it will not be computed.
  void expect(const StepId& step, std::optional<Turn> turn);
  void drop(const StepId& step, std::optional<Turn> turn);
  void compute(const StepRef& ref, const KeyIngredients& ingredients, const Digest& key);
  void build(const StepRef& ref, const std::filesystem::path& folder, ResultRecord& record);
  std::filesystem::path resultOf(const StepId& step, const Digest& key, const StepRef& reader) const;
  void checkInputs(const StepRef& ref, const KeyIngredients& before) const;
  // Computes once more without pictures held in memory when there is too little of it.
  void computeWithin(const StepRef& ref, const KeyIngredients& ingredients, const Digest& key);
  FrameStore* picturesFor(FrameIndex frame);
  Take takeAtWork() const { return turn_ ? takeOf(*turn_) : Take{}; }
  void failFrame(const StepRef& ref, const std::string& message);
  void acknowledge(const StepRef& ref, const Digest& key, bool reused, double seconds);
  void reportProgress(const StepRef& ref, const ProgressReport& report);
  void waitALittle();
  void restAfter(bool fulfilled) const;
  std::string restNote() const;
  // " in surface.fit, frame 000002": of the step at work.
  std::string placeText() const;
  std::string memoryText() const;
  std::string storageText(const Error& e) const;

  StepRef refTo(const StepId& step, std::optional<Turn> turn) const;
  double secondsSince(Clock::time_point start) const;

  Project& project_;
  ComputeDevice& device_;
  std::stop_token stop_;
  const StopWishes& wishes_;
  Tell tell_;
  Slot<JobPreview>& preview_;
  JobFinished finished_;
  Clock::time_point started_ = Clock::now(), step_started_ = started_;
  double weight_total_ = 0, weight_done_ = 0, weight_now_ = 0;
  TimeLeft left_;
  bool records_read_ = false;
  std::set<std::pair<StepId, std::optional<Turn>>> acknowledged_;
  std::set<std::pair<std::string, std::optional<Turn>>> stages_told_;
  std::set<Turn> planned_, pending_;   // all turns of this run; those that it has not finished
  std::set<Turn> failed_, again_;      // what failed in it; what had its turn again
  std::map<Turn, Digest> waits_for_;   // the result of the frame before that each busy one lacked
  std::vector<StepId> picture_steps_;  // of a frame
  std::unique_ptr<FrameStore> pictures_;
  std::optional<FrameIndex> pictures_of_;
  std::optional<Turn> turn_, next_;  // the one at work, none: a step of the project; the one after it
  StepRef now_;                      // the step at work, for messages
  std::optional<StepRef> last_;      // that this run computed
  // What another process computes: met since the last wait, and told.
  std::optional<JobWaiting> met_, waits_told_;
  std::unique_ptr<SessionLog> log_;
  int sink_ = 0;
  std::mutex warnings_mutex_;
  std::vector<std::string> warnings_;  // of the step at work
};

}  // namespace beam
