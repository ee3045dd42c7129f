// SPDX-License-Identifier: Apache-2.0
#include "app/services.h"

#include <fmt/format.h>

#include <map>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/pipeline/version.h"
#include "core/stages/builtin_stages.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

fs::path findResources() {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  fs::path installed = program.parent_path().parent_path() / "share" / "beam-studio" / "resources";
  if (!failed && fs::is_directory(installed / "recipes", failed)) return installed;
  fs::path source = BEAM_SOURCE_RESOURCES;
  if (fs::is_directory(source / "recipes", failed)) return source;
  throw Error(Error::Kind::Storage,
              fmt::format("the program's resources are gone: expected them at \"{}\" or \"{}\"; "
                          "install it again",
                          installed.string(), source.string()));
}

}  // namespace

Services makeServices() {
  Services services;
  services.resources = findResources();
  auto setup = std::make_shared<PipelineSetup>();
  registerBuiltinStages(setup->stages);
  setup->presets = services.resources / "recipes";
  services.pipeline = std::move(setup);
  return services;
}

std::unique_ptr<ComputeDevice> makeDevice(const DeviceChoice& choice) {
  static const std::map<std::string, SimdTarget> kTargets = {{"auto", SimdTarget::Auto},
                                                             {"avx512", SimdTarget::Avx512},
                                                             {"avx2", SimdTarget::Avx2},
                                                             {"scalar", SimdTarget::Scalar}};
  if (choice.device != "cpu") {
    throw Error(Error::Kind::Usage, fmt::format("there is no device \"{}\" (devices: cpu)", choice.device));
  }
  const auto target = kTargets.find(choice.simd);
  if (target == kTargets.end()) {
    throw Error(Error::Kind::Usage,
                fmt::format("--simd expects auto, avx512, avx2 or scalar, found \"{}\"", choice.simd));
  }
  setThreadCount(choice.threads);
  return makeCpuDevice(target->second);
}

const char* versionText() { return kProgramVersion; }

}  // namespace beam
