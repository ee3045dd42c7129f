// SPDX-License-Identifier: Apache-2.0
// What the window is given by the program that makes it; the window itself knows no stage and no device by
// name.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/pipeline/project.h"
#include "core/render/device.h"
#include "core/render/scene_renderer.h"

namespace beam {

// What is wrong with the pictures of a capture, a sentence each; may be cancelled.
using CaptureCheck =
    std::function<std::vector<std::string>(const std::filesystem::path&, const ImportOptions&, Progress&)>;

struct StudioServices {
  std::shared_ptr<const PipelineSetup> pipeline;
  std::shared_ptr<ComputeDevice> job_device;
  // Of views: on another device than jobs, so that neither waits for the other.
  SceneRendererFactory new_renderer;
  // Writes the sample capture into a folder that does not exist; empty: none comes with the program.
  std::function<void(const std::filesystem::path&, Progress&)> make_sample;
  CaptureCheck check_capture = {};  // empty: pictures are not looked at when a project is opened
  std::string version;
  std::uint64_t frame_memory_bytes = 0;  // most that decoded frames may take; 0: as the machine can spare
};

}  // namespace beam
