// SPDX-License-Identifier: Apache-2.0
// Results are the same for every instruction set: a test runs what it compares once for each.
#pragma once

#include "core/base/error.h"
#include "core/render/device.h"

namespace beam::testing {

// body(target) for each one that the machine has; the automatic one holds again afterwards.
template <class Body>
void forEveryInstructionSet(Body&& body) {
  for (const SimdTarget target : {SimdTarget::Scalar, SimdTarget::Avx2, SimdTarget::Avx512}) {
    try {
      makeCpuDevice(target);
    } catch (const Error&) {
      continue;  // the machine lacks it
    }
    body(target);
  }
  makeCpuDevice();
}

}  // namespace beam::testing
