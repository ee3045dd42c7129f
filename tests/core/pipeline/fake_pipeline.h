// SPDX-License-Identifier: Apache-2.0
// A pipeline without a method: four stages that write small texts made from what they read, over a capture
// that lives in memory. Fast enough to be killed and started again hundreds of times.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/pipeline/project.h"
#include "core/pipeline/runner.h"
#include "core/render/device.h"
#include "tests/support/step_literal.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {

// Every picture is one colour, which a test may change.
class FakeFrames final : public FrameSource {
 public:
  std::map<std::pair<int, int>, int> changed;  // (view, frame) -> other colour
  std::function<void()> fault;                 // when a picture is read
  bool has(ViewIndex, FrameIndex) const override { return true; }
  Image<u8vec3> photo(ViewIndex view, FrameIndex frame) const override {
    if (fault) fault();
    const auto found = changed.find({view.value, frame.value});
    const int value = found == changed.end() ? view.value * 16 + frame.value : found->second;
    return Image<u8vec3>(4, 4, u8vec3(static_cast<std::uint8_t>(value)));
  }
  Image<std::uint8_t> mask(ViewIndex, FrameIndex) const override { return {}; }
};

class FakeDevice final : public ComputeDevice {
 public:
  DeviceInfo info() const override { return {"fake", "Fake device"}; }
  std::unique_ptr<Rasterizer> newRasterizer(const RasterDesc&) override { return nullptr; }
  std::unique_ptr<ResidentScene> newResidentScene() override { return nullptr; }
  std::unique_ptr<Tracer> newTracer(const TracerDesc&, const GaussianCloud&) override { return nullptr; }
  std::unique_ptr<ShadowDrawer> newShadowDrawer() override { return nullptr; }
  std::unique_ptr<TrainingOps> newTrainingOps() override { return nullptr; }
};

struct FakeOptions {
  int iterations = 10;
  double normal_weight = 0.03;
  int batch = 64;
  std::string solver = "plain";
  double reach = 1;
  bool refines = false, follows = false;  // whether the stage has a step for the group
};
inline void describe(Fields& f, FakeOptions& o) {
  f.field({.name = "iterations", .label = "Iterations", .help = "Steps.", .min = 1, .max = 1000},
          o.iterations);
  f.field({.name = "batch",
           .label = "Batch",
           .help = "Speed.",
           .min = 1,
           .max = 1000,
           .effect = Effect::SpeedOnly},
          o.batch);
  f.field({.name = "solver", .label = "Solver", .help = "Way.", .choices = {"plain", "fancy"}}, o.solver);
  if (o.follows) {
    f.group("later", [&] {
      f.field({.name = "reach", .label = "Reach", .help = "Of motion.", .min = 0, .max = 9}, o.reach);
    });
  }
  if (o.refines) {
    f.group("refine", [&] {
      f.field({.name = "normal_weight", .label = "Normals", .help = "Weight.", .min = 0, .max = 1},
              o.normal_weight);
    });
  }
}

// Called at the start of every step with its frame; may throw, sleep, or look.
struct FakeHooks {
  std::function<void(const StepId& step, StepContext&)> at_step;
  std::map<StepId, int> computed;
  std::mutex mutex;  // over `computed`, for tests with two runners
};

class FakeStage final : public StageOf<FakeOptions> {
 public:
  FakeStage(StageInfo info, FakeHooks& hooks) : info_(std::move(info)), hooks_(hooks) {
    for (const StepInfo& step : info_.steps) {
      options_.refines |= step.id == "refine";
      options_.follows |= !step.later.empty();
    }
  }
  const StageInfo& info() const override { return info_; }
  void run(std::string_view step, StepContext& c) const override {
    const StepId id(info_.id, step);
    if (hooks_.at_step) hooks_.at_step(id, c);
    std::string text = id.text() + "\n";
    for (const auto& [input, folder] : c.inputs) text += readTextFile(folder / "data.txt");
    for (const auto& [earlier, folder] : c.previous) {
      const std::string before = readTextFile(folder / "data.txt");
      text += "before " + earlier.text() + " " + digestOf(before).hex() + "\n";
    }
    text += "iterations " + std::to_string(options_.iterations) + "\n";
    if (id == "surface.seed"_step)
      text += std::to_string(c.capture.source->photo({}, c.frame).pixels[0].x) + "\n";
    c.progress.expect(options_.iterations);
    for (int i = 0; i < options_.iterations; ++i) c.progress.step();
    std::filesystem::create_directory(c.folder / "maps");
    std::ofstream(c.folder / "data.txt") << text;
    std::ofstream(c.folder / "maps" / "more.txt") << std::string(1000, 'x') << text;
    std::lock_guard lock(hooks_.mutex);
    ++hooks_.computed[id];
  }

 private:
  StageInfo info_;
  FakeHooks& hooks_;
};

inline std::vector<StageInfo> fakeStages() {
  return {{"capture",
           "Capture",
           "",
           {{.id = "import",
             .title = "Import",
             .per_frame = false,
             .reads = {Reads::Calibration},
             .shown = {.cameras_file = kCamerasFile}}}},
          {"light",
           "Light",
           "",
           {{.id = "import", .title = "Import", .per_frame = false, .reads = {Reads::Environment}}}},
          {"surface",
           "Surface",
           "",
           {{.id = "seed", .title = "Seed", .reads = {Reads::Pictures}, .inputs = {"capture.import"_step}},
            {.id = "fit",
             .title = "Fit",
             .reads = {Reads::Pictures},
             .inputs = {"surface.seed"_step},
             .memory = {.lower = {"surface.iterations"}},
             .shown = {.frame = true}},
            {.id = "refine",
             .title = "Refine",
             .inputs = {"surface.fit"_step},
             .shown = {.frame = true, .surface = "surface.refine"_step}}}},
          {"materials",
           "Materials",
           "",
           {{.id = "bake", .title = "Bake", .inputs = {"light.import"_step, "surface.refine"_step}}}}};
}

// With takes: the first frame of each is fitted, the others follow the frame before.
inline std::vector<StageInfo> fakeStagesWithTakes() {
  return {
      {"capture", "Capture", "", {{.id = "import", .title = "Import", .per_frame = false}}},
      {"track",
       "Track",
       "",
       {{.id = "pose",
         .title = "Pose",
         .reads = {Reads::Pictures},
         .inputs = {"capture.import"_step},
         .frames = Frames::InTakes,
         .later = {.previous = {"track.pose"_step}}}}},
      {"surface",
       "Surface",
       "",
       {{.id = "fit",
         .title = "Fit",
         .reads = {Reads::Pictures},
         .inputs = {"capture.import"_step},
         .frames = Frames::FirstOfTake},
        {.id = "refine",
         .title = "Refine",
         .reads = {Reads::Pictures},
         .inputs = {"surface.fit"_step},
         .later = {.inputs = {"track.pose"_step}, .previous = {"surface.refine"_step}}}}},
      {"materials", "Materials", "", {{.id = "bake", .title = "Bake", .inputs = {"surface.refine"_step}}}}};
}

// A folder with a capture, a panorama file, presets and room for projects; and what runs them.
class FakeHouse {
 public:
  explicit FakeHouse(const std::vector<StageInfo>& stages = fakeStages()) {
    std::filesystem::create_directories(root() / "capture");
    std::filesystem::create_directories(root() / "presets");
    std::ofstream(root() / "capture" / "dataset.json") << "{}";
    std::ofstream(root() / "light.hdr") << "light";
    std::ofstream(root() / "presets" / "standard.json") << "{}";
    std::ofstream(root() / "presets" / "draft.json") << R"({"surface.iterations": 3})";
    setup = std::make_shared<PipelineSetup>();
    for (const StageInfo& info : stages) {
      setup->stages.add([info, this] { return std::make_unique<FakeStage>(info, hooks); });
    }
    setup->presets = root() / "presets";
    setup->open_capture = [this](const std::filesystem::path&, const ImportOptions& options) {
      ImportedCapture imported;
      for (const char* name : {"left", "right", "top"}) {
        imported.set.views.push_back({name, {{50, 50, 2, 2}, 4, 4, {}}, Split::Train});
        for (const std::string& held : options.hold_out) {
          if (held == name) imported.set.views.back().split = Split::Test;
        }
      }
      imported.set.frames = frame_names;
      if (has_panorama) imported.set.environment_file = (root() / "light.hdr").string();
      imported.set.masks = masks;
      imported.set.source = frames;
      return imported;
    };
  }

  const std::filesystem::path& root() const { return folder_.path(); }
  Project newProject(const std::string& name = "p.beam") {
    Project project = Project::create(root() / name, {}, setup);
    project.setCapture(root() / "capture");
    project.save();
    return project;
  }
  Project open(const std::string& name = "p.beam") { return Project::open(root() / name, setup); }

  // Runs to the end and gives every event.
  std::vector<JobEvent> run(Project project, RunRequest request = {}) {
    Runner runner;
    runner.start(std::move(project), std::move(request), std::make_shared<FakeDevice>());
    std::vector<JobEvent> events;
    while (events.empty() || !std::holds_alternative<JobFinished>(events.back())) {
      if (auto event = runner.waitPop(std::chrono::milliseconds(100))) events.push_back(std::move(*event));
    }
    return events;
  }
  JobFinished finish(Project project, RunRequest request = {}) {
    return std::get<JobFinished>(run(std::move(project), std::move(request)).back());
  }

  FakeHooks hooks;
  std::vector<std::string> frame_names = {"000", "001", "002"};
  bool has_panorama = true;
  MaskKind masks = MaskKind::None;
  std::shared_ptr<FakeFrames> frames = std::make_shared<FakeFrames>();
  std::shared_ptr<PipelineSetup> setup;

 private:
  TempDir folder_;
};

// Every file below results/ that is a product, by path, with its bytes. Records hold times and are left out.
inline std::map<std::string, std::string> productsOf(const std::filesystem::path& project) {
  std::map<std::string, std::string> products;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(project / "results")) {
    if (!entry.is_regular_file() || entry.path().filename() == "result.json") continue;
    std::ifstream in(entry.path(), std::ios::binary);
    products[entry.path().lexically_relative(project).string()] = {std::istreambuf_iterator<char>(in), {}};
  }
  return products;
}

// All that is below a folder, with times: to see that nothing was touched.
inline std::map<std::string, std::string> everythingIn(const std::filesystem::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    all[entry.path().string()] = std::to_string(entry.last_write_time().time_since_epoch().count());
  }
  return all;
}

}  // namespace beam::testing
