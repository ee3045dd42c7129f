// SPDX-License-Identifier: Apache-2.0
// The figure's surface on its skeleton: polygonised once, in the first pose, then moved with the bones by
// blended dual quaternions (Kavan et al. 2007). A vertex is the same point of the body in every pose.
#pragma once

#include "core/sample/figure.h"

namespace beam {

class Skin {
 public:
  // Parts of the body that are not joined must stand apart in the first pose.
  Skin(const BodyPose& first, float cell_m);

  const Figure& figure() const { return figure_; }  // in the first pose
  const Mesh& first() const { return first_; }
  Mesh posed(const BodyPose& pose) const;

 private:
  struct Influence {
    std::uint8_t bone;
    float weight;
  };
  struct Edge {
    std::uint32_t to;
    vec2 share;  // of the edge in the derivatives along the two tangents
  };
  void weigh();
  void findTangents();
  void turnNormals(Mesh& surface, const std::vector<quat>& turns) const;

  PosedBones bones_;
  Figure figure_;
  Mesh first_;
  std::vector<std::uint32_t> influence_start_, edge_start_;
  std::vector<Influence> influences_;
  std::vector<Edge> edges_;
  std::vector<vec2> bulge_;  // what the edges' normal components add to the derivatives
};

}  // namespace beam
