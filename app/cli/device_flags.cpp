// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "app/cli/commands.h"

namespace beam {

void addForceFlag(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "Replace files that this command did not write");
}

void addStrictFlag(CLI::App& command, bool& strict) {
  command.add_flag("--strict", strict, "Refuse results of other settings than those in force");
}

void addDeviceFlags(CLI::App& command, DeviceChoice& choice) {
  command.add_option("--threads", choice.threads, "Threads to compute with; 0: all of the machine")
      ->type_name("N")
      ->check(CLI::Range(0, 4096));
  command.add_option("--simd", choice.simd, "Instruction set; results do not depend on it")
      ->type_name("NAME");
  command.add_option("--device", choice.device, "Compute device")->type_name("NAME");
}

}  // namespace beam
