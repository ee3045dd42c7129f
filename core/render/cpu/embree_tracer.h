// SPDX-License-Identifier: Apache-2.0
// Visibility through Embree user geometry, one box a Gaussian: the oracle of all tracers, too slow for a
// whole dome. Beside it triangle_tracer.h alone knows Embree.
#pragma once

#include <memory>

#include "core/render/tracer.h"

namespace beam {

// Throws Error{Bug} when Embree cannot start.
std::unique_ptr<Tracer> makeEmbreeTracer(const TracerDesc& desc, const GaussianCloud& cloud);

}  // namespace beam
