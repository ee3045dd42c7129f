// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/lock_reach.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/file_reference.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

struct Mount {
  fs::path point;
  std::string type, options;
};

// The table writes blanks and the like as three octal digits.
std::string plain(const std::string& escaped) {
  std::string text;
  for (std::size_t i = 0; i < escaped.size(); ++i) {
    const bool octal =
        escaped[i] == '\\' && i + 3 < escaped.size() && escaped[i + 1] >= '0' && escaped[i + 1] <= '3';
    if (!octal) {
      text += escaped[i];
      continue;
    }
    text += static_cast<char>(std::strtol(escaped.substr(i + 1, 3).c_str(), nullptr, 8));
    i += 3;
  }
  return text;
}

// proc(5): "36 35 98:0 /root /point rw,noatime master:1 - ext3 /dev/sda1 rw,errors=continue", with any number
// of words before the dash.
std::optional<Mount> mountOf(const std::string& line) {
  std::istringstream words(line);
  std::string word, source;
  Mount mount;
  for (int i = 0; i < 5 && words >> word; ++i) mount.point = plain(word);
  while (words >> word && word != "-") continue;
  if (!(words >> mount.type >> source >> mount.options)) return std::nullopt;
  return mount;
}

// The innermost; of several at one point the last, which lies on top.
std::optional<Mount> mountAt(const fs::path& folder, const fs::path& table) {
  std::error_code failed;
  const fs::path whole = fs::weakly_canonical(fs::absolute(folder), failed);
  std::ifstream lines(table);
  std::optional<Mount> found;
  for (std::string line; std::getline(lines, line);) {
    const std::optional<Mount> mount = mountOf(line);
    if (!mount || !isAtOrBelow(whole, mount->point)) continue;
    if (!found || mount->point.native().size() >= found->point.native().size()) found = mount;
  }
  return found;
}

}  // namespace

std::string localLocksReason(const fs::path& folder, const fs::path& mount_table) {
  const std::optional<Mount> mount = mountAt(folder, mount_table);
  if (!mount) return {};
  std::vector<std::string> options;
  std::istringstream list(mount->options);
  for (std::string option; std::getline(list, option, ',');) options.push_back(option);
  const auto with = [&](const char* name, std::initializer_list<const char*> local) -> std::string {
    for (const char* option : local)
      if (std::find(options.begin(), options.end(), option) != options.end())
        return fmt::format("{}, mounted with {}", name, option);
    return {};
  };
  const std::string& type = mount->type;
  // These locks are POSIX's, which NFS sends to the server unless it was told not to (nfs(5)).
  if (type == "nfs" || type == "nfs4") return with("NFS", {"nolock", "local_lock=all", "local_lock=posix"});
  if (type == "cifs" || type == "smb3") return with("SMB", {"nobrl"});
  if (type == "lustre") return with("Lustre", {"localflock", "noflock"});
  // Their servers know no locks: the kernel keeps them to itself.
  for (const char* no_locks : {"fuse.sshfs", "fuse.rclone", "fuse.s3fs", "fuse.gcsfuse", "fuse.davfs"})
    if (type == no_locks) return type;
  return {};
}

void requireSharedLocks(const fs::path& folder, const fs::path& mount_table) {
  const char* allowed = std::getenv(kLocalLocksVariable);
  if (allowed && std::string_view(allowed) == "1") return;
  const std::string why = localLocksReason(folder, mount_table);
  if (why.empty()) return;
  throw Error(
      Error::Kind::Refused,
      fmt::format("\"{}\" is not written to: other machines do not see locks there ({}), so that two of "
                  "them would compute and write the same; mount it with locks, or set {}=1 while no "
                  "other machine works in it",
                  folder.string(), why, kLocalLocksVariable));
}

}  // namespace beam
