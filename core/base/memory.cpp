// SPDX-License-Identifier: Apache-2.0
#include "core/base/memory.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace beam {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

// The number after a name at the start of a line: "MemAvailable: 123 kB", "inactive_file 123".
std::uint64_t fieldOf(const fs::path& file, const std::string& name, std::uint64_t otherwise) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(name)) return std::strtoull(line.c_str() + name.size(), nullptr, 10);
  }
  return otherwise;
}

// Not a number: "max", or no such file.
std::uint64_t numberIn(const fs::path& file, std::uint64_t otherwise) {
  std::uint64_t number = 0;
  return std::ifstream(file) >> number ? number : otherwise;
}

struct GroupFiles {
  const char *limit, *usage, *cache;
};
constexpr GroupFiles kVersion1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file "};
constexpr GroupFiles kVersion2{"memory.max", "memory.current", "inactive_file "};

// What the limits of the group and of those above it leave. A container sees the path of its host, but only
// its own group at the top.
std::uint64_t leftInGroups(const fs::path& top, fs::path group, const GroupFiles& files) {
  std::uint64_t least = kUnlimited;
  while (true) {
    const fs::path folder = group.empty() ? top : top / group;
    const std::uint64_t limit = numberIn(folder / files.limit, kUnlimited);
    const std::uint64_t usage = numberIn(folder / files.usage, 0);
    const std::uint64_t used = usage - std::min(usage, fieldOf(folder / "memory.stat", files.cache, 0));
    if (limit != kUnlimited) least = std::min(least, limit - std::min(limit, used));
    if (group.empty()) return least;
    group = group.parent_path();
  }
}

// Lines of /proc/self/cgroup: "0::/path" of version 2, "4:memory:/path" of version 1.
std::uint64_t leftInGroups(const fs::path& root) {
  const fs::path top = root / "sys/fs/cgroup";
  std::uint64_t least = kUnlimited;
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    std::string kinds = line.substr(first, second - first + 1);
    std::replace(kinds.begin(), kinds.end(), ':', ',');
    const fs::path group = fs::path(line.substr(second + 1)).relative_path();
    if (kinds == ",,") least = std::min(least, leftInGroups(top, group, kVersion2));
    if (kinds.find(",memory,") != std::string::npos)
      least = std::min(least, leftInGroups(top / "memory", group, kVersion1));
  }
  return least;
}

}  // namespace

std::uint64_t availableMemoryBytes(const fs::path& root) {
  const std::uint64_t kib = fieldOf(root / "proc/meminfo", "MemAvailable:", kUnlimited / 1024);
  return std::min(kib >= kUnlimited / 1024 ? kUnlimited : kib * 1024, leftInGroups(root));
}

std::uint64_t peakMemoryBytes() {
  struct rusage usage {};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

void returnFreeMemory() {
#if defined(__GLIBC__)
  ::malloc_trim(0);
#endif
}

}  // namespace beam
