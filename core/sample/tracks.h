// SPDX-License-Identifier: Apache-2.0
// Points of the body followed through a take: the ground truth of motion.
#pragma once

#include <filesystem>

#include "core/sample/figure.h"

namespace beam {

class TrackPoints {
 public:
  // Uniform over the area of `first`.
  TrackPoints(const Mesh& first, std::size_t count, int seed);

  struct Point {
    vec3 position_m, normal;
  };
  // In the same order for every pose of the mesh.
  std::vector<Point> on(const Mesh& surface) const;
  // Binary PLY, columns x y z nx ny nz.
  void write(const std::filesystem::path& path, const Mesh& surface) const;

 private:
  struct Place {
    std::uint32_t triangle;
    vec2 barycentric;  // of the second and third corner
  };
  std::vector<Place> places_;
};

}  // namespace beam
