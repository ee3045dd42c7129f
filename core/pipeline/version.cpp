// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/version.h"

namespace beam {

const char* const kProgramVersion = BEAM_VERSION;

}  // namespace beam
