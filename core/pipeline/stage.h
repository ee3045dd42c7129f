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
#include "core/scene/capture.h"
#include "core/scene/gaussian_cloud.h"

namespace beam {

class ComputeDevice;

// What of the user's files a step reads itself; it enters the key of the step.
enum class Reads {
  Calibration,  // cameras, split and seed points of the capture
  Pictures,     // photographs and masks of the frame's training views
  HeldOut,      // photographs and masks of the frame's held-out views; for scores, never for fitting
  Environment,  // the panorama
};

struct StepInfo {
  std::string id;           // inside its stage: "fit"; the full id is "surface.fit". Never renamed
  std::string title;        // "Fit appearance"
  std::string source = "";  // "BEAM 3.1, eq. 9"
  int version = 1;          // raise when equal inputs would now give another result
  bool per_frame = true;
  std::vector<Reads> reads = {};
  std::vector<std::string> inputs = {};  // full ids of the steps whose results it reads; all stand earlier
  double weight = 1;                     // usual share of time, for the remaining time of a run
};

struct StageInfo {
  std::string id;  // "surface"
  std::string title, summary;
  std::vector<StepInfo> steps;  // in order
};

// What a step is given to work with, and where it leaves its files.
struct StepContext {
  const CaptureSet& capture;
  FrameIndex frame;                                     // of a per-frame step
  std::optional<std::filesystem::path> environment;     // the panorama's file
  std::filesystem::path folder;                         // write every file of the result here
  std::map<std::string, std::filesystem::path> inputs;  // full step id -> folder of its result, verified
  std::function<FieldValue(std::string_view)> setting;  // in force, by full name; of stages in `inputs` only
  ComputeDevice& device;
  Progress& progress;
  std::function<void(std::shared_ptr<const GaussianCloud>)> preview;
  std::map<std::string, double> scores;  // figures for the record: counts, losses

  const std::filesystem::path& input(const std::string& step) const { return inputs.at(step); }
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

template <class Options>
class StageOf : public Stage {
 public:
  void parameters(Fields& fields) final { describe(fields, options_); }

 protected:
  Options options_;
};

}  // namespace beam
