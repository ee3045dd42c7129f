// SPDX-License-Identifier: Apache-2.0
// Network file systems whose locks other machines do not see: told by the table of mounts, refused for
// writing.
#include "core/pipeline/lock_reach.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class LockReach : public ::testing::Test {
 protected:
  LockReach() {
    std::ofstream(table()) << R"(22 1 8:1 / / rw,relatime shared:1 - ext4 /dev/sda1 rw,nolock
30 22 0:40 / /shots rw,relatime shared:9 master:2 - nfs server:/shots rw,vers=3,nolock,addr=10.0.0.1
31 22 0:41 / /proper rw,relatime - nfs4 server:/proper rw,vers=4.2,local_lock=none
32 22 0:42 / /old rw - nfs server:/old rw,vers=3,local_lock=flock
33 22 0:43 / /posix rw - nfs server:/p rw,vers=3,local_lock=posix
34 22 0:44 / /smb rw - cifs //server/x rw,nobrl,cache=strict
35 22 0:45 / /smb2 rw - cifs //server/x rw,cache=strict
36 22 0:46 / /home/a/far\040away rw,nosuid - fuse.sshfs a@b:/x rw,user_id=0
37 30 8:2 / /shots/local rw - xfs /dev/sdb1 rw
38 31 0:47 / /proper rw - nfs server:/other rw,vers=3,local_lock=all
a line that is not of the table
39 22 0:48 /
)";
  }
  ~LockReach() override { ::unsetenv(kLocalLocksVariable); }
  std::filesystem::path table() const { return folder_.path() / "mounts"; }
  std::string reason(const std::string& folder) const { return localLocksReason(folder, table()); }

  TempDir folder_;
};

TEST_F(LockReach, IsReadOffTheInnermostMount) {
  EXPECT_THAT(reason("/tmp/p.beam"), IsEmpty()) << "a disk of this machine, whatever its options";
  EXPECT_EQ(reason("/shots/day 1/p.beam"), "NFS, mounted with nolock");
  EXPECT_THAT(reason("/shots2/p.beam"), IsEmpty());
  EXPECT_THAT(reason("/shots/local/p.beam"), IsEmpty());
  EXPECT_THAT(reason("/old/p.beam"), IsEmpty()) << "flock is another kind of lock";
  EXPECT_EQ(reason("/posix/p.beam"), "NFS, mounted with local_lock=posix");
  EXPECT_EQ(reason("/smb/p.beam"), "SMB, mounted with nobrl");
  EXPECT_THAT(reason("/smb2/p.beam"), IsEmpty());
  EXPECT_EQ(reason("/home/a/far away/p.beam"), "fuse.sshfs");
  EXPECT_EQ(reason("/proper/p.beam"), "NFS, mounted with local_lock=all") << "the mount on top";
  EXPECT_THAT(localLocksReason("/shots/p.beam", folder_ / "no table"), IsEmpty());
}

TEST_F(LockReach, RefusesToWriteUnlessItIsAskedFor) {
  EXPECT_THAT(messageOf(Error::Kind::Refused, [&] { requireSharedLocks("/shots/p.beam", table()); }),
              AllOf(HasSubstr("/shots/p.beam"), HasSubstr("NFS, mounted with nolock"),
                    HasSubstr("BEAM_LOCAL_LOCKS=1")));
  ::setenv(kLocalLocksVariable, "0", 1);
  EXPECT_THROW(requireSharedLocks("/shots/p.beam", table()), Error);
  ::setenv(kLocalLocksVariable, "1", 1);
  EXPECT_NO_THROW(requireSharedLocks("/shots/p.beam", table()));
  ::unsetenv(kLocalLocksVariable);
  EXPECT_NO_THROW(requireSharedLocks("/proper2/p.beam", table()));
}

TEST_F(LockReach, IsFoundOfTheDiskThatTheTestsRunOn) {
  EXPECT_THAT(localLocksReason(folder_.path()), IsEmpty());
}

}  // namespace
}  // namespace beam::testing
