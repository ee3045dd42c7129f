// SPDX-License-Identifier: Apache-2.0
#include "app/cli/exit_codes.h"

#include "core/base/error.h"

namespace beam {

const std::vector<ExitCodeInfo>& exitCodes() {
  using Kind = Error::Kind;
  static const std::vector<ExitCodeInfo> all = {
      {kDone, "done", ""},
      {exitCode(Kind::Usage), "the words were not understood, or a file would have been overwritten",
       "read the line that starts with \"error:\"; beam COMMAND --help"},
      {kSomeFailed, "finished, but some frames failed; they are listed",
       "beam status says why; the other frames are done"},
      {exitCode(Kind::Data), "bad input: a capture, a picture or a panorama cannot be used",
       "beam check CAPTURE says what is wrong with it"},
      {exitCode(Kind::Refused), "refused before the work: the memory or the disk will not do",
       "ask for less, or free what the message names"},
      {exitCode(Kind::Bug), "a bug of beam", "report it with the line that starts with \"error:\""},
      {exitCode(Kind::OutOfMemory), "the memory ran out", "close other programs, or ask for less"},
      {exitCode(Kind::Locked), "another process has the project", "wait for it; the message names it"},
      {exitCode(Kind::Storage), "reading or writing failed in the file system",
       "look at the disk and the rights of the file that is named"},
      {kInterrupted, "interrupted by SIGINT, SIGTERM or SIGHUP; what is finished is kept",
       "the same command goes on where it stopped; of sample the folder is removed first"},
  };
  return all;
}

}  // namespace beam
