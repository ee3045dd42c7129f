// SPDX-License-Identifier: Apache-2.0
// The version of the program, as the build knows it; goes into records, never into keys.
#pragma once

namespace beam {

extern const char* const kProgramVersion;  // "0.1.0"

}  // namespace beam
