// SPDX-License-Identifier: Apache-2.0
// The views of the window, in the order of their tabs.
#pragma once

namespace beam {

enum class StudioView { Splat, Image, Scene };

}  // namespace beam
