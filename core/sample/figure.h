// SPDX-License-Identifier: Apache-2.0
// A clothed person as a smooth implicit surface over a skeleton, in capture axes: x to the performer's left,
// y to the back, z up, metres. Posed by rotations of its bones.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/types.h"
#include "core/sample/pose.h"
#include "core/scene/mesh.h"

namespace beam {

enum class Cloth { Skin, Hair, Shirt, Jeans, Shoe, Sole, Eye, Lip, Belt };

// Where a surface point lies in the rest pose and what it is made of.
struct FigurePoint {
  vec3 rest{0};
  Cloth cloth = Cloth::Skin;
};

class Figure {
 public:
  explicit Figure(const BodyPose& pose);

  // Signed distance (negative inside), in metres; exact only near the surface.
  float distance(vec3 x) const;
  FigurePoint pointAt(vec3 x) const;
  // The same among some parts: those of partsNear() serve every point within its reach.
  FigurePoint pointAt(vec3 x, std::span<const std::uint8_t> parts) const;
  std::vector<std::uint8_t> partsNear(vec3 x, float reach_m) const;
  // To the nearest part of each bone.
  std::array<float, bone::Count> boneDistances(vec3 x) const;
  vec3 normalAt(vec3 x) const;
  // The surface as triangles of about `cell_m`.
  Mesh mesh(float cell_m) const;
  Mesh surface(float cell_m) const;  // with normals

 private:
  struct Part {
    vec3 a, b;     // rest pose
    float ra, rb;  // radii at the ends
    vec3 stretch;  // of space in front of the distance: > 1 makes it thinner along that axis
    int bone;
    Cloth cloth;
    mat3 rotation;  // posed from rest
    vec3 translation;
  };
  float distance(vec3 x, std::span<const std::uint8_t> parts) const;
  vec3 normalAt(vec3 x, std::span<const std::uint8_t> parts) const;
  float partDistance(const Part& part, vec3 x, vec3& rest) const;

  std::vector<Part> parts_;
  std::vector<std::uint8_t> all_;  // indices of all parts
};

}  // namespace beam
