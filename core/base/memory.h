// SPDX-License-Identifier: Apache-2.0
// Memory of the process as a whole.
#pragma once

#include <cstdint>

namespace beam {

// Most resident memory so far.
std::uint64_t peakMemoryBytes();

// Gives pages that were freed back to the system. Between pieces of work of different shape: the holes that
// one leaves in the heap do not fit the next, so that a process which alternates between them would grow
// although neither does.
void returnFreeMemory();

}  // namespace beam
