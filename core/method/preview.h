// SPDX-License-Identifier: Apache-2.0
// How a long computation shows what it has so far. May be empty; called on the job's thread, about once a
// second.
#pragma once

#include <functional>
#include <memory>

#include "core/scene/gaussian_cloud.h"

namespace beam {

using CloudPreview = std::function<void(std::shared_ptr<const GaussianCloud>)>;

}  // namespace beam
