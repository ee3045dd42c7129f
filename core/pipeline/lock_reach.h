// SPDX-License-Identifier: Apache-2.0
// Whether a lock on a file is seen by other machines that share it. Leases and LOCK are such locks: where
// they are not seen, two machines compute and write the same.
#pragma once

#include <filesystem>
#include <string>

namespace beam {

inline constexpr const char* kMountTable = "/proc/self/mountinfo";

// Set to 1 by who knows that no other machine works in the project.
inline constexpr const char* kLocalLocksVariable = "BEAM_LOCAL_LOCKS";

// Why locks on files in `folder` are seen by this machine alone although others may share it: "NFS, mounted
// with nolock"; empty: they are seen, or the file system is of this machine, as far as the table of mounts
// tells.
std::string localLocksReason(const std::filesystem::path& folder,
                             const std::filesystem::path& mount_table = kMountTable);

// Throws Error{Refused} where there is such a reason and kLocalLocksVariable is not set.
void requireSharedLocks(const std::filesystem::path& folder,
                        const std::filesystem::path& mount_table = kMountTable);

}  // namespace beam
