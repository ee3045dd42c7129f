// SPDX-License-Identifier: Apache-2.0
// Available memory as the system's files tell it.
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "core/base/memory.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;

class AvailableMemory : public ::testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((root / file).parent_path());
    std::ofstream(root / file) << text;
  }
  void write(const std::string& file, std::uint64_t mib) const { write(file, std::to_string(mib * kMiB)); }
  std::uint64_t mib() const { return availableMemoryBytes(root.path()) / kMiB; }

  TempDir root;
};

TEST_F(AvailableMemory, IsTheMachinesWithoutLimits) {
  EXPECT_EQ(availableMemoryBytes(root.path()), std::numeric_limits<std::uint64_t>::max());
  write("proc/meminfo", "MemTotal: 8388608 kB\nMemAvailable:    4194304 kB\n");
  EXPECT_EQ(mib(), 4096u);
  write("proc/self/cgroup", "0::/\n");
  write("sys/fs/cgroup/memory.max", "max\n");
  EXPECT_EQ(mib(), 4096u);
}

TEST_F(AvailableMemory, IsAtMostWhatAnyGroupAboveLeaves) {
  write("proc/meminfo", "MemAvailable: 4194304 kB\n");
  write("proc/self/cgroup", "0::/outer/inner\n");
  write("sys/fs/cgroup/outer/inner/memory.max", 3000);
  write("sys/fs/cgroup/outer/inner/memory.current", 500);
  EXPECT_EQ(mib(), 2500u);
  write("sys/fs/cgroup/outer/memory.max", 2000);
  write("sys/fs/cgroup/outer/memory.current", 1500);
  EXPECT_EQ(mib(), 500u);
  write("sys/fs/cgroup/outer/memory.stat", "file 1\ninactive_file " + std::to_string(700 * kMiB) + "\n");
  EXPECT_EQ(mib(), 1200u);
  write("sys/fs/cgroup/outer/memory.current", 2800);
  EXPECT_EQ(mib(), 0u);
}

// Of version 1; the container's own group is at the top, whatever the path.
TEST_F(AvailableMemory, KnowsTheOlderVersion) {
  write("proc/meminfo", "MemAvailable: 4194304 kB\n");
  write("proc/self/cgroup", "5:cpu,cpuacct:/docker/1\n4:memory:/docker/1\n0::/\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", 1000);
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", 400);
  EXPECT_EQ(mib(), 600u);
}

TEST(Memory, SomethingIsAvailable) { EXPECT_GT(availableMemoryBytes(), kMiB); }

}  // namespace
}  // namespace beam::testing
