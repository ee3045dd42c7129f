// SPDX-License-Identifier: Apache-2.0
// Memory of the process as a whole.
#pragma once

#include <cstdint>
#include <filesystem>

namespace beam {

// Most resident memory so far.
std::uint64_t peakMemoryBytes();

// What the process may still take: what the machine has available, and at most what the memory limits of its
// control groups (version 1 or 2, as containers set them) leave; file cache that can go counts as free. Linux
// kills who takes more, rather than refuse it. The largest number where the system does not say. `root` is
// for tests.
std::uint64_t availableMemoryBytes(const std::filesystem::path& root = "/");

// Gives pages that were freed back to the system. Between pieces of work of different shape: the holes that
// one leaves in the heap do not fit the next, so that a process which alternates between them would grow
// although neither does.
void returnFreeMemory();

}  // namespace beam
