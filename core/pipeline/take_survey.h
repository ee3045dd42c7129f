// SPDX-License-Identifier: Apache-2.0
// What is there of a take: the state of every stage in every frame and the scores as curves, in one pass over
// the project's folder. For timelines; a single frame is asked of Project.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/pipeline/project.h"

namespace beam {

// A finished result that a frame can be looked at from (StepShown), with whatever settings it was made.
struct Leftover {
  StepId step;
  Digest key;
  Digest surface;  // of the result that it lies on, StepShown::surface; zero: none
  bool operator==(const Leftover&) const = default;
};
using Leftovers = std::vector<Leftover>;  // of a frame, the newest first

enum class CellState {
  Empty,
  Running,  // some process holds a lease of it
  Done,
  Stale,  // there is a result, made with other settings or inputs
  Failed,
  Blocked,       // needs something the project does not have
  Interpolated,  // nothing of its own: lies between two of a take with a stride that are done
  NotNeeded,     // none of its steps is for this frame of its take
};

struct SurveyLane {
  std::string stage, title;
  std::string blocked_reason;      // empty: it can run
  std::vector<CellState> cells;    // by frame: of the first step that is not done, else Done
  std::vector<std::string> notes;  // by frame: why it failed; empty: it did not
};

struct SurveyCurve {
  std::string name;            // "surface.fit.gaussians", "surface.fit.seconds"
  std::vector<double> values;  // by frame; NaN: none
};

struct TakeSurvey {
  std::vector<std::string> frames;
  std::vector<SurveyLane> lanes;    // in pipeline order
  std::vector<SurveyCurve> curves;  // of results with the settings in force, by step and name
  // By frame: what it can be shown from, whatever the settings; no leads of takes in force.
  std::vector<Leftovers> leftovers;
  // By frame: changes when what is to be shown of it may change, by a result of its own, of those that it
  // lies between, or by what is left over while it lacks the last there is to show (StepShown::last) of the
  // settings in force; zero: there is nothing.
  std::vector<Digest> stamps;

  const SurveyCurve* curve(std::string_view name) const;  // null: there is none
};

// Keeps what cannot change between passes: keys of unchanged settings and records of immutable results. One
// thread at a time.
class TakeSurveyor {
 public:
  // Of a project without its capture: every cell is Stale or Empty, curves are those of the newest results.
  TakeSurvey survey(const Project& project);
  // Pictures of the capture may have changed on disk: the next pass asks for every key again.
  void forgetKeys() { known_for_.clear(); }

 private:
  struct Record {
    StepId step;
    std::string frame;
    std::map<std::string, double> scores;
    bool whole = false;  // every file was there with its size
    bool lead = false;   // made for a take that does not own the frame
    bool shown = false;  // see Leftover
    Digest surface;      // see Leftover
    std::int64_t published_ns = 0;
  };
  struct Pass;
  using Keys = std::vector<std::optional<Digest>>;  // none: the step is not for the frame
  const Keys& keysOf(const Project& project, const StepId& step, bool per_frame);
  void readRecords(const Project& project, Pass& pass);
  void keepLeadKeys(const Project& project);
  void keepEarlierKeys(const Project& project);
  void markEarlier(const Pass& pass, TakeSurvey& survey) const;
  void surveyStep(const StepId& id, const StepInfo& step, Pass& pass, TakeSurvey& survey);
  void surveyStages(Pass& pass, TakeSurvey& survey);
  void surveyRecords(Pass& pass, TakeSurvey& survey) const;
  void listLeftovers(const Pass& pass, TakeSurvey& survey) const;

  // A frame between two members of a take that does not own them, or not any more.
  struct EarlierPair {
    std::size_t frame;
    std::vector<std::vector<Digest>> keys;  // by stage, of both members
  };
  std::vector<EarlierPair> earlier_;  // by frame, of the newest take first

  std::string known_for_;        // project and settings that keys_ belong to
  std::map<StepId, Keys> keys_;  // by step; one a frame, or a single one
  std::set<Digest> leads_;       // keys of frames as members of takes that do not own them
  std::map<Digest, Record> records_;
};

}  // namespace beam
