// SPDX-License-Identifier: Apache-2.0
#include "core/sample/figure.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "core/base/parallel.h"

namespace beam {
namespace {

using namespace bone;

constexpr float kBlend_m = 0.014f;       // of neighbouring parts
constexpr float kBlendReach_m = 0.025f;  // parts within thrice this of the nearest take part in its blend

float roundCone(vec3 p, vec3 a, vec3 b, float ra, float rb) {
  const vec3 ba = b - a, pa = p - a;
  const float t = std::clamp(glm::dot(pa, ba) / std::max(glm::dot(ba, ba), 1e-9f), 0.0f, 1.0f);
  return glm::length(pa - t * ba) - glm::mix(ra, rb, t);
}

}  // namespace

Figure::Figure(const BodyPose& pose) {
  const PosedBones bones = placeBones(pose);
  const auto add = [&](int bone, Cloth cloth, vec3 a, vec3 b, float ra, float rb, vec3 stretch = vec3(1)) {
    parts_.push_back({a, b, ra, rb, stretch, bone, cloth, bones.rotation[bone], bones.translation[bone]});
  };
  const vec3 flat(0.78f, 1.18f, 1);  // broader than deep
  add(Root, Cloth::Jeans, {0, 0, 0.90f}, {0, 0, 1.00f}, 0.125f, 0.12f, {0.80f, 1.12f, 1});
  add(Root, Cloth::Belt, {0, 0, 1.0f}, {0, 0, 1.015f}, 0.122f, 0.122f, {0.80f, 1.12f, 1});
  add(Chest, Cloth::Shirt, {0, 0, 1.02f}, {0, 0.005f, 1.30f}, 0.125f, 0.140f, flat);
  add(Chest, Cloth::Shirt, {-0.11f, 0.005f, 1.385f}, {0.11f, 0.005f, 1.385f}, 0.075f, 0.075f);
  add(Chest, Cloth::Shirt, {0, 0.01f, 1.42f}, {0, 0.012f, 1.465f}, 0.075f, 0.062f);
  add(Head, Cloth::Skin, {0, 0.015f, 1.45f}, {0, 0, 1.54f}, 0.052f, 0.052f);
  add(Head, Cloth::Skin, {0, -0.005f, 1.60f}, {0, 0.0f, 1.665f}, 0.078f, 0.092f, {1.12f, 0.95f, 1});
  add(Head, Cloth::Skin, {0, -0.045f, 1.555f}, {0, -0.03f, 1.60f}, 0.042f, 0.055f);
  add(Head, Cloth::Skin, {0, -0.098f, 1.605f}, {0, -0.088f, 1.635f}, 0.013f, 0.009f);
  add(Head, Cloth::Lip, {-0.016f, -0.083f, 1.572f}, {0.016f, -0.083f, 1.572f}, 0.008f, 0.008f);
  add(Head, Cloth::Hair, {0, 0.02f, 1.665f}, {0, 0.03f, 1.69f}, 0.093f, 0.085f, {1.08f, 0.95f, 1});
  for (const float side : {-1.0f, 1.0f}) {
    add(Head, Cloth::Eye, {side * 0.033f, -0.082f, 1.642f}, {side * 0.033f, -0.082f, 1.643f}, 0.013f, 0.013f);
    add(Head, Cloth::Skin, {side * 0.084f, 0.01f, 1.605f}, {side * 0.088f, 0.018f, 1.64f}, 0.014f, 0.018f,
        {1.4f, 0.8f, 1});
    const int upper = side > 0 ? LUpper : RUpper, fore = side > 0 ? LFore : RFore,
              hand = side > 0 ? LHand : RHand;
    add(upper, Cloth::Shirt, {side * 0.18f, 0, 1.40f}, {side * 0.36f, 0, 1.20f}, 0.068f, 0.050f);
    add(fore, Cloth::Shirt, {side * 0.36f, 0, 1.20f}, {side * 0.475f, -0.013f, 1.055f}, 0.049f, 0.040f);
    add(fore, Cloth::Skin, {side * 0.475f, -0.013f, 1.055f}, {side * 0.51f, -0.02f, 1.01f}, 0.030f, 0.026f);
    add(hand, Cloth::Skin, {side * 0.515f, -0.022f, 1.00f}, {side * 0.555f, -0.03f, 0.945f}, 0.028f, 0.030f,
        {1.25f, 0.85f, 1});
    for (int f = 0; f < 4; ++f) {
      const vec3 root(side * (0.555f + 0.004f * (f - 1.5f)), -0.058f + 0.021f * static_cast<float>(f),
                      0.935f);
      add(hand, Cloth::Skin, root, root + vec3(side * 0.038f, -0.004f, -0.062f), 0.0105f, 0.0085f);
    }
    add(hand, Cloth::Skin, {side * 0.525f, -0.05f, 0.98f}, {side * 0.53f, -0.085f, 0.935f}, 0.013f, 0.010f);
    const int thigh = side > 0 ? LThigh : RThigh, shin = side > 0 ? LShin : RShin,
              foot = side > 0 ? LFoot : RFoot;
    add(thigh, Cloth::Jeans, {side * 0.09f, 0.005f, 0.89f}, {side * 0.115f, 0, 0.50f}, 0.098f, 0.066f);
    add(shin, Cloth::Jeans, {side * 0.115f, 0, 0.50f}, {side * 0.125f, 0.012f, 0.13f}, 0.066f, 0.054f);
    add(foot, Cloth::Shoe, {side * 0.125f, 0.02f, 0.075f}, {side * 0.135f, -0.135f, 0.045f}, 0.046f, 0.038f,
        {1.05f, 1, 1});
    add(foot, Cloth::Sole, {side * 0.125f, 0.03f, 0.02f}, {side * 0.135f, -0.15f, 0.02f}, 0.036f, 0.036f,
        {0.95f, 1, 2.2f});
  }
  all_.resize(parts_.size());
  std::iota(all_.begin(), all_.end(), std::uint8_t{0});
}

float Figure::partDistance(const Part& p, vec3 x, vec3& rest) const {
  rest = glm::transpose(p.rotation) * (x - p.translation);
  const vec3 middle = 0.5f * (p.a + p.b);
  const auto stretched = [&](vec3 v) { return middle + p.stretch * (v - middle); };
  const float largest = std::max({p.stretch.x, p.stretch.y, p.stretch.z});
  return roundCone(stretched(rest), stretched(p.a), stretched(p.b), p.ra, p.rb) / largest;
}

float Figure::distance(vec3 x) const { return distance(x, all_); }

float Figure::distance(vec3 x, std::span<const std::uint8_t> parts) const {
  vec3 rest;
  float d = 1e3f;
  for (const std::uint8_t i : parts) {
    const Part& p = parts_[i];
    const float e = partDistance(p, x, rest);
    const bool hard = p.cloth == Cloth::Eye || p.cloth == Cloth::Sole;
    const float k = hard ? 0.003f : kBlend_m;
    const float h = std::max(k - std::abs(d - e), 0.0f) / k;
    d = std::min(d, e) - h * h * k * 0.25f;  // polynomial smooth minimum
  }
  return d;
}

FigurePoint Figure::pointAt(vec3 x, std::span<const std::uint8_t> parts) const {
  FigurePoint best;
  float nearest = 1e9f;
  for (const std::uint8_t i : parts) {
    vec3 rest;
    const float d = partDistance(parts_[i], x, rest);
    if (d >= nearest) continue;
    nearest = d;
    best = {rest, parts_[i].cloth};
  }
  return best;
}

FigurePoint Figure::pointAt(vec3 x) const { return pointAt(x, all_); }

std::vector<std::uint8_t> Figure::partsNear(vec3 x, float reach_m) const {
  // Along a step a distance changes by at most this factor: cones of unequal radii are steeper than 1.
  constexpr float kSteepest = 1.5f;
  std::vector<float> d(parts_.size());
  vec3 rest;
  for (std::size_t i = 0; i < parts_.size(); ++i) d[i] = partDistance(parts_[i], x, rest);
  const float limit = *std::min_element(d.begin(), d.end()) + 2 * kSteepest * reach_m;
  std::vector<std::uint8_t> near;
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (d[i] <= limit) near.push_back(static_cast<std::uint8_t>(i));
  }
  return near;
}

std::array<float, bone::Count> Figure::boneDistances(vec3 x) const {
  std::array<float, bone::Count> out;
  out.fill(1e3f);
  vec3 rest;
  for (const Part& p : parts_) out[p.bone] = std::min(out[p.bone], partDistance(p, x, rest));
  return out;
}

vec3 Figure::normalAt(vec3 x) const { return normalAt(x, all_); }

vec3 Figure::normalAt(vec3 x, std::span<const std::uint8_t> parts) const {
  constexpr float h = 0.002f;
  const auto along = [&](vec3 step) { return distance(x + step, parts) - distance(x - step, parts); };
  return glm::normalize(vec3(along(vec3(h, 0, 0)), along(vec3(0, h, 0)), along(vec3(0, 0, h))));
}

// Surface nets: one vertex a cell that the surface crosses, one quad an edge.
Mesh Figure::mesh(float cell) const {
  const vec3 low(-0.9f, -0.9f, -0.06f), size(1.8f, 1.8f, 1.95f);
  const ivec3 n = ivec3(size / cell) + 1;
  const auto at = [&](int x, int y, int z) { return low + cell * vec3(x, y, z); };
  std::vector<float> field(static_cast<std::size_t>(n.x) * n.y * n.z);
  const auto index = [&](int x, int y, int z) { return (static_cast<std::size_t>(z) * n.y + y) * n.x + x; };
  // Coarse cells that lie far from the surface need no fine values.
  constexpr int kStride = 4;
  const ivec3 blocks = (n + kStride - 1) / kStride;
  std::vector<std::uint8_t> far_block(static_cast<std::size_t>(blocks.x) * blocks.y * blocks.z);
  const auto block = [&](int x, int y, int z) {
    return (static_cast<std::size_t>(z / kStride) * blocks.y + y / kStride) * blocks.x + x / kStride;
  };
  parallelFor(static_cast<std::size_t>((n.z + kStride - 1) / kStride), 1, [&](std::size_t slab, std::size_t) {
    for (int y = 0; y < n.y; y += kStride) {
      for (int x = 0; x < n.x; x += kStride) {
        const int z = static_cast<int>(slab) * kStride;
        const float d = distance(at(x + kStride / 2, y + kStride / 2, z + kStride / 2));
        const bool far = std::abs(d) > 2.2f * kStride * cell;
        const std::vector<std::uint8_t> near =
            far ? std::vector<std::uint8_t>{}
                : partsNear(at(x + kStride / 2, y + kStride / 2, z + kStride / 2),
                            kBlendReach_m + kStride * cell);
        far_block[block(x, y, z)] = far;
        for (int k = z; k < std::min(z + kStride, n.z); ++k) {
          for (int j = y; j < std::min(y + kStride, n.y); ++j) {
            for (int i = x; i < std::min(x + kStride, n.x); ++i)
              field[index(i, j, k)] = far ? d : distance(at(i, j, k), near);
          }
        }
      }
    }
  });
  Mesh m;
  std::unordered_map<std::size_t, std::uint32_t> vertex;
  for (int z = 0; z + 1 < n.z; ++z) {
    for (int y = 0; y + 1 < n.y; ++y) {
      for (int x = 0; x + 1 < n.x; ++x) {
        if (far_block[block(x, y, z)]) continue;  // nor is any edge to the next block crossed
        vec3 sum(0);
        int crossings = 0;
        for (int e = 0; e < 12; ++e) {
          const int axis = e / 4, u = e & 1, v = (e >> 1) & 1;
          ivec3 p(0);
          p[(axis + 1) % 3] = u;
          p[(axis + 2) % 3] = v;
          ivec3 q = p;
          q[axis] = 1;
          const float a = field[index(x + p.x, y + p.y, z + p.z)],
                      b = field[index(x + q.x, y + q.y, z + q.z)];
          if ((a < 0) == (b < 0)) continue;
          sum += glm::mix(vec3(p), vec3(q), a / (a - b));
          ++crossings;
        }
        if (crossings == 0) continue;
        vertex[index(x, y, z)] = static_cast<std::uint32_t>(m.vertices.size());
        m.vertices.push_back(at(x, y, z) + cell * sum / static_cast<float>(crossings));
      }
    }
  }
  for (int z = 1; z + 1 < n.z; ++z) {
    for (int y = 1; y + 1 < n.y; ++y) {
      for (int x = 1; x + 1 < n.x; ++x) {
        if (far_block[block(x, y, z)]) continue;
        for (int axis = 0; axis < 3; ++axis) {
          ivec3 step(0), u(0), v(0);
          step[axis] = 1, u[(axis + 1) % 3] = 1, v[(axis + 2) % 3] = 1;
          const bool a = field[index(x, y, z)] < 0, b = field[index(x + step.x, y + step.y, z + step.z)] < 0;
          if (a == b) continue;
          const ivec3 p(x, y, z);
          const auto id = [&](ivec3 c) { return vertex.at(index(c.x, c.y, c.z)); };
          const std::uint32_t q[4] = {id(p - u - v), id(p - v), id(p), id(p - u)};
          if (a) {
            m.triangles.push_back({q[0], q[1], q[2]}), m.triangles.push_back({q[0], q[2], q[3]});
          } else {
            m.triangles.push_back({q[0], q[2], q[1]}), m.triangles.push_back({q[0], q[3], q[2]});
          }
        }
      }
    }
  }
  // Onto the surface, so that shading normals and silhouettes are smooth.
  parallelFor(m.vertices.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      vec3& v = m.vertices[i];
      const std::vector<std::uint8_t> near = partsNear(v, kBlendReach_m);
      v -= distance(v, near) * normalAt(v, near);
    }
  });
  return m;
}

Mesh Figure::surface(float cell) const {
  Mesh s = mesh(cell);
  s.normals.resize(s.vertices.size());
  parallelFor(s.normals.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const vec3 v = s.vertices[i];
      s.normals[i] = normalAt(v, partsNear(v, kBlendReach_m));
    }
  });
  return s;
}

}  // namespace beam
