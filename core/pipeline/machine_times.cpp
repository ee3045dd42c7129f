// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/machine_times.h"

#include <cstdlib>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/file.h"

namespace beam {
namespace fs = std::filesystem;

fs::path machineTimesFile() {
  const auto named = [](const char* variable) {
    const char* value = std::getenv(variable);
    return fs::path(value ? value : "");
  };
  const fs::path state = named("XDG_STATE_HOME"), home = named("HOME");
  if (state.is_absolute()) return state / "beam-studio" / "step-times.json";
  return home.is_absolute() ? home / ".local" / "state" / "beam-studio" / "step-times.json" : fs::path();
}

StepTimes readMachineTimes() {
  const fs::path file = machineTimesFile();
  std::error_code failed;
  if (file.empty() || !fs::is_regular_file(file, failed)) return {};
  try {
    return parseStepTimes(readTextFile(file));
  } catch (const Error& e) {
    logDebug("the times of earlier runs are not readable: {}", e.what());
    return {};
  }
}

void keepMachineTimes(const StepTimes& times) {
  const fs::path file = machineTimesFile();
  if (file.empty() || times.empty()) return;
  std::error_code failed;
  fs::create_directories(file.parent_path(), failed);
  try {
    writeFileAtomically(file, toJson(times));
  } catch (const Error& e) {
    logDebug("the times of this run are not kept: {}", e.what());
  }
}

}  // namespace beam
