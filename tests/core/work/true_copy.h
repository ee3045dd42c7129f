// SPDX-License-Identifier: Apache-2.0
// A data set whose ground truth is what a project renders: every score against it is known.
#pragma once

#include <filesystem>

#include "core/io/file.h"
#include "core/render/cpu_scene_renderer.h"
#include "core/work/render_frames.h"

namespace beam::testing {

// Makes `folder`/dataset.json and `folder`/gt of frames 000000 and 000001 and camera cam3.
inline void makeTrueCopy(const Project& project, const std::filesystem::path& folder, ComputeDevice& device) {
  const std::filesystem::path truth = folder / "gt";
  std::filesystem::create_directories(truth);
  Progress progress;
  renderFrames({.project = project,
                .channels = {"rgb", "base_color", "ao", "roughness", "normal", "depth", "alpha", "mesh"},
                .cameras = "cam3",
                .frames = "0-1",
                .environments = {},
                .world_frame = false,
                .out = truth},
               *newCpuSceneRenderer(device), progress);
  std::filesystem::rename(truth / "alpha", truth / "mask");
  writeFileAtomically(folder / "dataset.json",
                      R"({"test_cameras": ["cam3"], "frame_names": ["000000", "000001"],
                          "gt_frames": ["000000", "000001"], "relight_environments": []})");
}

}  // namespace beam::testing
