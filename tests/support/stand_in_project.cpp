// SPDX-License-Identifier: Apache-2.0
#include "tests/support/stand_in_project.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "core/io/file.h"
#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/pipeline/runner.h"
#include "core/render/device.h"
#include "core/scene/pose.h"
#include "core/stages/result_files.h"
#include "core/stages/step_ids.h"
#include "core/stages/track_files.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam::testing {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> g_hold{false};

// A field of every kind.
struct StandInOptions {
  int iterations = 100;
  double rate = 1.6e-4;
  bool careful = true;
  std::string solver = "linear";
};
void describe(Fields& f, StandInOptions& o) {
  f.field({.name = "iterations", .label = "Iterations", .help = "Steps.", .min = 1, .max = 1e6},
          o.iterations);
  f.field({.name = "careful", .label = "Careful", .help = "Looks twice."}, o.careful);
  f.field({.name = "solver", .label = "Solver", .help = "How.", .choices = {"linear", "adam"}}, o.solver);
  f.field({.name = "rate", .label = "Rate", .help = "Of learning.", .min = 0, .max = 1, .advanced = true},
          o.rate);
}

vec3 centerOf(int frame) { return {0.05f * static_cast<float>(frame), 1, 0}; }

GaussianCloud skinAt(int frame, int gaussians) {
  GaussianCloud cloud;
  addSphere(cloud, centerOf(frame), 0.3f, gaussians);
  return cloud;
}

GaussianCloud jointsAt(int frame) {
  GaussianCloud joints;
  for (const float side : {-0.3f, 0.3f})
    addSplat(joints, centerOf(frame) + vec3(side, 0, 0), vec3(0, 0, 1), 0.1f, 0.01f);
  return joints;
}

Mesh meshAt(int frame) {
  const vec3 c = centerOf(frame);
  return {{c + vec3(-0.2f, 0, 0), c + vec3(0.2f, 0, 0), c + vec3(0, 0.3f, 0)}, {{0, 1, 2}}};
}

class StandInStage final : public StageOf<StandInOptions> {
 public:
  StandInStage(StageInfo info, int gaussians) : info_(std::move(info)), gaussians_(gaussians) {}
  const StageInfo& info() const override { return info_; }
  void run(std::string_view step, StepContext& c) const override {
    const std::string id = info_.id + "." + std::string(step);
    const int frame = c.frame.value;
    const GaussianCloud skin = skinAt(frame, gaussians_);
    if (id == "surface.fit") wait(c, skin);
    c.scores["gaussians"] = static_cast<double>(skin.size()) + frame;
    if (id == "surface.seed") {
      writeFileAtomically(c.folder / "seeds.txt", "nothing to see");
    } else if (id == "surface.mesh") {
      writeMeshPly(c.folder / kMeshFile, meshAt(frame));
    } else if (info_.id == "surface") {
      writeSkin(c, skin);
    } else if (info_.id == "track") {
      writePosePly(c.folder / kRestPoseFile, poseOf(jointsAt(0)));
      writeTrackNote(c.folder, {false, 1});
      writeSplatPly(c.folder / kJointsFile, jointsAt(frame), nullptr);
    } else if (info_.id == "materials") {
      writeMaterials(c, skin);
    } else {
      writeFileAtomically(c.folder / "done.txt", "nothing to see");
    }
  }

 private:
  static void wait(StepContext& c, const GaussianCloud& skin) {
    c.preview(std::make_shared<const GaussianCloud>(skin));
    while (g_hold) {
      c.progress.check();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  static void writeSkin(StepContext& c, const GaussianCloud& skin) {
    if (c.later()) {
      writePosePly(c.folder / kRestPoseFile, poseOf(skinAt(0, static_cast<int>(skin.size()))));
      writePosePly(c.folder / kJointPoseFile, poseOf(jointsAt(c.frame.value)));
    }
    writeSplatPly(c.folder / kCloudFile, skin, nullptr);
  }
  static void writeMaterials(StepContext& c, const GaussianCloud& skin) {
    Materials m;
    m.roughness.assign(skin.size(), 0.5f);
    m.base_color = ShBlock(skin.size(), 3);
    m.ambient_occlusion = ShBlock(skin.size(), 1);
    writeSplatPly(c.folder / kMaterialsFile, skin, &m);
  }

  StageInfo info_;
  int gaussians_;
};

// The texture of the sphere turns from frame to frame.
class TurningSphere final : public FrameSource {
 public:
  TurningSphere(std::vector<View> views, int size_px) : views_(std::move(views)), size_px_(size_px) {}
  bool has(ViewIndex, FrameIndex) const override { return true; }
  Image<u8vec3> photo(ViewIndex view, FrameIndex frame) const override { return taken(view, frame).photo; }
  Image<std::uint8_t> mask(ViewIndex view, FrameIndex frame) const override {
    return taken(view, frame).mask;
  }

 private:
  FrameView taken(ViewIndex view, FrameIndex frame) const {
    const float half_turn = 0.1f * static_cast<float>(frame.value);
    const SphereCapture sphere{.size_px = size_px_, .turn = {std::cos(half_turn), 0, std::sin(half_turn), 0}};
    const View& v = views_[static_cast<std::size_t>(view.value)];
    return photographSphere(sphere, v.camera, v.name);
  }
  std::vector<View> views_;
  int size_px_;
};

ImportedCapture openStandIn(const StandInSize& size) {
  ImportedCapture imported;
  imported.set.name = "take";
  for (int i = 0; i < size.cameras; ++i)
    imported.set.views.push_back(viewOf({.cameras = size.cameras, .size_px = size.size_px}, i));
  for (int i = size.cameras - size.held_out; i < size.cameras; ++i)
    imported.set.views[static_cast<std::size_t>(i)].split = Split::Test;
  for (int f = 0; f < size.frames; ++f)
    imported.set.frames.push_back(fmt::format("{:06}{}", f, size.name_end));
  imported.set.frames_per_second = 25;
  imported.set.masks = MaskKind::Files;
  imported.set.source = std::make_shared<TurningSphere>(imported.set.views, size.size_px);
  imported.layout = "memory";
  return imported;
}

}  // namespace

std::shared_ptr<const PipelineSetup> standInPipeline(const StandInSize& size) {
  auto setup = std::make_shared<PipelineSetup>();
  const auto add = [&](const StageInfo& info) {
    setup->stages.add(
        [info, gaussians = size.gaussians] { return std::make_unique<StandInStage>(info, gaussians); });
  };
  const std::vector<Reads> pictures{Reads::Pictures};
  add({"capture",
       "Capture",
       "Reads the photographs.",
       {{.id = "import", .title = "Import", .reads = pictures}}});
  add({"light", "Light", "Reads the light.", {{.id = "import", .title = "Import", .reads = pictures}}});
  add({"surface",
       "Surface",
       "Fits Gaussians to the photographs.",
       {{.id = "seed", .title = "Seed", .reads = pictures},
        {.id = "fit", .title = "Fit", .inputs = {kSeedStep}, .shown = {.frame = true}},
        {.id = "refine",
         .title = "Refine",
         .inputs = {kFitStep},
         .later = {.previous = {kRefineStep}},
         .shown = {.frame = true, .surface = kRefineStep}},
        {.id = "mesh",
         .title = "Mesh",
         .inputs = {kRefineStep},
         .shown = {.frame = true, .surface = kRefineStep}}}});
  add({"track",
       "Track",
       "Follows the subject from frame to frame.",
       {{.id = "joints", .title = "Joints", .inputs = {kRefineStep}}}});
  add({"materials",
       "Materials",
       "Tells colour from light.",
       {{.id = "fit",
         .title = "Fit",
         .inputs = {kRefineStep},
         .shown = {.frame = true, .surface = kRefineStep, .last = true}}}});
  setup->presets = fs::path(BEAM_SOURCE_DIR) / "tests/support/presets";
  setup->open_capture = [size](const fs::path&, const ImportOptions&) { return openStandIn(size); };
  return setup;
}

void holdStandInRuns(bool hold) { g_hold = hold; }

Project newStandIn(const fs::path& folder, const StandInSize& size) {
  fs::create_directories(folder / "capture");
  Project project = Project::create(folder / "capture.beam", {}, standInPipeline(size));
  project.setCapture(folder / "capture");
  project.save();
  return project;
}

Project solvedStandIn(const fs::path& folder, const StandInSize& size, const RunRequest& request) {
  return solvedAgain(newStandIn(folder, size), size, request);
}

Project solvedAgain(const Project& project, const StandInSize& size, const RunRequest& request) {
  Runner runner;
  runner.start(project, request, makeCpuDevice());
  while (runner.running()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return Project::open(project.folder(), standInPipeline(size));
}

}  // namespace beam::testing
