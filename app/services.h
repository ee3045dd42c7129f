// SPDX-License-Identifier: Apache-2.0
// What both programs are put together from: the stages, the resources on disk, the compute device.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/pipeline/project.h"
#include "core/render/device.h"

namespace beam {

// What --device, --simd and --threads say.
struct DeviceChoice {
  std::string device = "cpu";
  std::string simd = "auto";  // auto, avx512, avx2, scalar
  int threads = 0;            // 0: all
};

struct Services {
  std::filesystem::path resources;  // folder with recipes/
  std::shared_ptr<const PipelineSetup> pipeline;
};

// Registers the built-in stages and finds the resources: beside the installed program, else in the source
// tree.
Services makeServices();

// Sets the thread count of the process and makes the device. Throws Error{Usage} for an unknown one.
std::unique_ptr<ComputeDevice> makeDevice(const DeviceChoice& choice);

const char* versionText();  // "0.1.0"

}  // namespace beam
