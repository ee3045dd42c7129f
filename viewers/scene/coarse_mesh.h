// SPDX-License-Identifier: Apache-2.0
// A stand-in for a mesh that is too large to be drawn while the camera moves.
#pragma once

#include "core/scene/mesh.h"

namespace beam {

// At most `most_triangles`, by vertex clustering (Rossignac and Borrel 1993): vertices of one cell of an even
// grid become their mean, triangles that lose a corner go. Quadric error metrics would keep edges better and
// take ten times as long; what moves does not show the difference. A mesh that is small enough stays as it
// is.
Mesh coarser(const Mesh& mesh, std::size_t most_triangles);

}  // namespace beam
