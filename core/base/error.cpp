// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"

namespace beam {

void requireData(const Error& handled) {
  if (handled.kind() != Error::Kind::Data) throw;
}

int exitCode(Error::Kind kind) {
  switch (kind) {
    case Error::Kind::Usage:
      return 2;
    case Error::Kind::Data:
      return 65;
    case Error::Kind::Refused:
      return 69;
    case Error::Kind::OutOfMemory:
      return 71;
    case Error::Kind::Locked:
      return 73;
    case Error::Kind::Storage:
      return 74;
    case Error::Kind::Bug:
      return 70;
  }
  return 70;
}

}  // namespace beam
