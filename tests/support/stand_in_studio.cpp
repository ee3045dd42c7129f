// SPDX-License-Identifier: Apache-2.0
#include "tests/support/stand_in_studio.h"

#include "core/render/cpu_scene_renderer.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {

namespace fs = std::filesystem;

StudioServices standInServices(const StandInSize& size) {
  const std::shared_ptr<ComputeDevice> device = makeCpuDevice();
  return {.pipeline = standInPipeline(size),
          .job_device = device,
          .new_renderer = cpuSceneRenderers(device),
          .make_sample = [](const fs::path& folder, Progress&) { fs::create_directories(folder); },
          .version = "test"};
}

void copySolvedStandIn(const fs::path& folder) {
  static const TempDir made;
  static const bool solved = [] {
    solvedStandIn(made.path());
    // A project finds its capture by the way from its folder, else where it was: only the copy's own counts
    // here.
    fs::remove_all(made / "capture");
    return true;
  }();
  if (solved) fs::copy(made.path(), folder, fs::copy_options::recursive);
  fs::create_directories(folder / "capture");
}

}  // namespace beam::testing
