// SPDX-License-Identifier: Apache-2.0
// The one exception of the house. Throw it where the fact is known; it is caught at three borders only:
// the programs' main, the runner, and plugin calls.
#pragma once

#include <stdexcept>
#include <string>

namespace beam {

class Error : public std::runtime_error {
 public:
  enum class Kind {
    Usage,        // the caller's words: unknown flag, value out of range
    Data,         // bad input: what was expected, what was found, where
    Refused,      // memory or disk will not do, or a disk whose locks others do not see
    OutOfMemory,  //
    Locked,       // the project is in use by another process
    Storage,      // reading or writing failed in the file system
    Bug,          // a broken promise of our own
  };
  // `message`: what happened, to which file, what was expected and found, what to do.
  Error(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

// For handlers that go on without what bad data spoiled: throws the error that is being handled again unless
// it is one of Data. A disk or a memory that fails for a moment says nothing about the data.
void requireData(const Error& handled);

// Thrown by Progress when a stop was requested; nobody but the runner and main catches it.
class Cancelled : public std::exception {
 public:
  const char* what() const noexcept override { return "cancelled"; }
};

// Process exit code of a failure, by sysexits.h where it has one; scripts rely on them.
int exitCode(Error::Kind kind);

}  // namespace beam
