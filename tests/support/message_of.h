// SPDX-License-Identifier: Apache-2.0
// What a refusal says, and that it is one of the kind that is expected.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "core/base/error.h"

namespace beam::testing {

template <class Body>
std::string messageOf(Error::Kind kind, Body&& body) {
  try {
    body();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), kind) << e.what();
    return e.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

template <class Body>
std::string dataErrorOf(Body&& body) {
  return messageOf(Error::Kind::Data, std::forward<Body>(body));
}

}  // namespace beam::testing
