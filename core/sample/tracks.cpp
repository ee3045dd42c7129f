// SPDX-License-Identifier: Apache-2.0
#include "core/sample/tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/rng.h"
#include "core/io/file.h"

namespace beam {

TrackPoints::TrackPoints(const Mesh& first, std::size_t count, int seed) {
  std::vector<double> area(1, 0.0);  // running sum
  for (const auto& t : first.triangles) {
    const vec3 a = first.vertices[t[0]], b = first.vertices[t[1]], c = first.vertices[t[2]];
    area.push_back(area.back() + 0.5 * glm::length(glm::cross(b - a, c - a)));
  }
  const RandomStream random(seed, 0x72ac5u);
  places_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double at =
        area.back() * (static_cast<double>(i) + random.uniform(3 * i)) / static_cast<double>(count);
    const auto above = std::upper_bound(area.begin(), area.end() - 1, at);
    const float root = std::sqrt(random.uniform(3 * i + 1)), v = random.uniform(3 * i + 2);
    places_.push_back({static_cast<std::uint32_t>(above - area.begin() - 1), {root * (1 - v), root * v}});
  }
}

std::vector<TrackPoints::Point> TrackPoints::on(const Mesh& s) const {
  std::vector<Point> out;
  out.reserve(places_.size());
  for (const Place& p : places_) {
    const auto& t = s.triangles[p.triangle];
    const auto mix = [&](const std::vector<vec3>& of) {
      return (1 - p.barycentric.x - p.barycentric.y) * of[t[0]] + p.barycentric.x * of[t[1]] +
             p.barycentric.y * of[t[2]];
    };
    out.push_back({mix(s.vertices), glm::normalize(mix(s.normals))});
  }
  return out;
}

void TrackPoints::write(const std::filesystem::path& path, const Mesh& surface) const {
  const std::vector<Point> points = on(surface);
  std::string bytes = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", points.size());
  for (const char* column : {"x", "y", "z", "nx", "ny", "nz"})
    bytes += fmt::format("property float {}\n", column);
  bytes += "end_header\n";
  static_assert(sizeof(Point) == 6 * sizeof(float));
  bytes.append(reinterpret_cast<const char*>(points.data()), points.size() * sizeof(Point));
  writeFileAtomically(path, bytes);
}

}  // namespace beam
