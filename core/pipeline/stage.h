// SPDX-License-Identifier: Apache-2.0
// A stage as the user sees it, cut into steps: the step is the unit of work, of keys, of results and of
// resuming. Derive from StageOf<Options> to add one.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/fields.h"
#include "core/base/progress.h"
#include "core/pipeline/step_id.h"
#include "core/pipeline/takes.h"
#include "core/scene/capture.h"
#include "core/scene/gaussian_cloud.h"

namespace beam {

class Checkpoint;
class ComputeDevice;
class FrameStore;

// What of the user's files a step reads itself; it enters the key of the step.
enum class Reads {
  Calibration,  // cameras, split and seed points of the capture
  Pictures,     // photographs and masks of the frame's training views
  HeldOut,      // photographs and masks of the frame's held-out views; for scores, never for fitting
  Environment,  // the panorama
};

// Which frames of a take a per-frame step is for.
enum class Frames {
  Every,
  FirstOfTake,
  InTakes,  // every frame of takes of two and more
};

// What a later frame of a take (not its first) reads besides: results of the same frame, and of the frame
// before. Its key has the parameters of the group "later", too.
struct Later {
  std::vector<StepId> inputs = {}, previous = {};  // `previous` may stand anywhere
  bool empty() const { return inputs.empty() && previous.empty(); }
};

// What the time of a step is about in proportion to, for guesses from other captures and settings.
struct StepWork {
  bool photographs = false;      // their number
  bool pixels = false;           // those of one photograph
  std::string downscale = "";    // setting: photographs are so many times smaller a side
  std::string times = "";        // setting: so many times over (iterations, samples)
  std::string later_times = "";  // the same in later frames
};

// Settings that make a step take less memory, for those who are short of it.
struct StepMemory {
  std::vector<std::string> raise = {}, lower = {};  // full names
};

// What can be seen of a result, told to those who show a project and do not know its steps.
struct StepShown {
  bool frame = false;   // a frame can be looked at from it, whatever the settings it was made with
  StepId surface = {};  // the step whose result it lies on, its own for that step; empty: none
  bool last = false;    // with it a frame has all there is to show: what is older is of no interest
  // Files that a project without its capture is looked at by: its cameras, the panorama in force.
  std::string cameras_file = "", panorama_file = "";
};

struct StepInfo {
  std::string id;            // StepId::name(): "fit". Never renamed
  std::string title;         // "Fit appearance"
  std::string source = "";   // "BEAM 3.1, eq. 9"
  int version = 1;           // raise when equal inputs would now give another result
  int unmasked_version = 0;  // raise instead when that is so of captures without masks alone
  bool per_frame = true;
  std::vector<Reads> reads = {};
  // The steps whose results it reads; all stand earlier. One that is not for the frame is left out.
  std::vector<StepId> inputs = {};
  double weight = 1;  // usual share of time, for the remaining time of a run
  Frames frames = Frames::Every;
  Later later = {};
  StepWork work = {};
  StepMemory memory = {};
  StepShown shown = {};
};

// Whether the step is for this frame of the take.
bool applies(const StepInfo& step, const Take& take, FrameIndex frame);
// Everything it reads in any frame: inputs, later ones, those of the frame before.
std::vector<StepId> readsOf(const StepInfo& step);

// Full names of the settings that say how a run over all frames is cut into takes; "": there is none.
struct TakeSettings {
  std::string segment_frames = "";  // most frames a take claims; 0: as many as it can
  std::string overlap = "";         // frames of lead
};

struct StageInfo {
  std::string id;  // "surface"
  std::string title, summary;
  std::vector<StepInfo> steps;  // in order
  TakeSettings takes = {};
};

// What a step is given to work with, and where it leaves its files.
struct StepContext {
  const CaptureSet& capture;
  FrameIndex frame;                                     // of a per-frame step
  std::optional<std::filesystem::path> environment;     // the panorama's file
  std::filesystem::path folder;                         // write every file of the result here
  std::map<StepId, std::filesystem::path> inputs;       // folders of their results, verified
  std::function<FieldValue(std::string_view)> setting;  // in force, by full name; of stages in `inputs` only
  ComputeDevice& device;
  Progress& progress;
  std::function<void(std::shared_ptr<const GaussianCloud>)> preview;
  std::map<std::string, double> scores = {};  // figures for the record: counts, losses
  // Of a later frame: folders of the results of the frame before, verified.
  std::map<StepId, std::filesystem::path> previous = {};
  bool is_later = false;
  FrameStore* frames = nullptr;      // pictures already decoded; null: whoever wants some loads them
  Checkpoint* checkpoint = nullptr;  // of this result; null: nothing is kept before it is whole

  const std::filesystem::path& input(const StepId& step) const { return inputs.at(step); }
  // Whether the step builds on the frame before; never for the first of a take.
  bool later() const { return is_later; }
  // Null: there is none, because the step is not for that frame, or this one is no later frame.
  const std::filesystem::path* previousResult(const StepId& step) const {
    const auto found = previous.find(step);
    return found == previous.end() ? nullptr : &found->second;
  }
};

class Stage {
 public:
  virtual ~Stage() = default;
  virtual const StageInfo& info() const = 0;
  // Reads or writes the parameters, whoever the reader is. Names carry no stage id: "refine.normal_weight".
  virtual void parameters(Fields& fields) = 0;
  // `step`: an id of info().steps.
  virtual void run(std::string_view step, StepContext& context) const = 0;
};

// Its parameters with the values they have.
std::vector<Field> fieldsOf(Stage& stage);

template <class Options>
class StageOf : public Stage {
 public:
  void parameters(Fields& fields) final { describe(fields, options_); }

 protected:
  Options options_;
};

}  // namespace beam
