// SPDX-License-Identifier: Apache-2.0
#include "core/sample/skin.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/math/sampling.h"

namespace beam {
namespace {

constexpr float kReach_m = 0.045f;  // beyond the nearest bone's part at which another bone has no say
constexpr std::size_t kGrain = 1024;

struct DualQuaternion {
  quat turn{1, 0, 0, 0}, shift{0, 0, 0, 0};
};

std::array<DualQuaternion, bone::Count> motionOf(const PosedBones& from, const PosedBones& to) {
  std::array<DualQuaternion, bone::Count> out;
  for (int b = 0; b < bone::Count; ++b) {
    const mat3 r = to.rotation[b] * glm::transpose(from.rotation[b]);
    const vec3 t = to.translation[b] - r * from.translation[b];
    out[b].turn = glm::normalize(glm::quat_cast(r));
    out[b].shift = 0.5f * (quat(0, t.x, t.y, t.z) * out[b].turn);
  }
  return out;
}

}  // namespace

Skin::Skin(const BodyPose& first, float cell_m)
    : bones_(placeBones(first)), figure_(first), first_(figure_.surface(cell_m)) {
  weigh();
  findTangents();
}

void Skin::weigh() {
  influence_start_.push_back(0);
  for (const vec3& x : first_.vertices) {
    const auto d = figure_.boneDistances(x);
    const float nearest = *std::min_element(d.begin(), d.end());
    float sum = 0;
    for (int b = 0; b < bone::Count; ++b) {
      const float w = 1 - (d[b] - nearest) / kReach_m;
      if (w <= 0) continue;
      influences_.push_back({static_cast<std::uint8_t>(b), w * w});
      sum += w * w;
    }
    for (std::size_t i = influence_start_.back(); i < influences_.size(); ++i) influences_[i].weight /= sum;
    influence_start_.push_back(static_cast<std::uint32_t>(influences_.size()));
  }
}

// The derivative of a motion along the tangents is fitted to the edges around a vertex, least squares.
void Skin::findTangents() {
  const Mesh& m = first_;
  std::vector<std::vector<std::uint32_t>> ring(m.vertices.size());
  for (const auto& t : m.triangles) {
    for (int k = 0; k < 3; ++k) ring[t[k]].push_back(t[(k + 1) % 3]);
  }
  edge_start_.push_back(0);
  bulge_.resize(m.vertices.size(), vec2(0));
  for (std::size_t i = 0; i < m.vertices.size(); ++i) {
    const Frame3 frame(first_.normals[i]);
    glm::mat2 square(0.0f);
    const std::size_t begin = edges_.size();
    std::vector<float> height;
    for (const std::uint32_t j : ring[i]) {
      const vec3 e = m.vertices[j] - m.vertices[i];
      const vec2 p(glm::dot(e, frame.toWorld(vec3(1, 0, 0))), glm::dot(e, frame.toWorld(vec3(0, 1, 0))));
      square += glm::outerProduct(p, p);
      edges_.push_back({j, p});
      height.push_back(glm::dot(e, first_.normals[i]));
    }
    const float det = glm::determinant(square);
    const glm::mat2 solve = det > 1e-20f ? glm::inverse(square) : glm::mat2(0.0f);
    for (std::size_t k = begin; k < edges_.size(); ++k) {
      edges_[k].share = solve * edges_[k].share;
      bulge_[i] += height[k - begin] * edges_[k].share;
    }
    edge_start_.push_back(static_cast<std::uint32_t>(edges_.size()));
  }
}

void Skin::turnNormals(Mesh& s, const std::vector<quat>& turns) const {
  parallelFor(s.normals.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const vec3 turned = turns[i] * first_.normals[i];
      vec3 u = -bulge_[i].x * turned, v = -bulge_[i].y * turned;
      for (std::uint32_t k = edge_start_[i]; k < edge_start_[i + 1]; ++k) {
        const vec3 e = s.vertices[edges_[k].to] - s.vertices[i];
        u += edges_[k].share.x * e;
        v += edges_[k].share.y * e;
      }
      const vec3 n = glm::cross(u, v);
      const float length = glm::length(n);
      // Where the skin folds into itself the derivative says nothing.
      s.normals[i] = length > 1e-3f && glm::dot(n, turned) > 0 ? n / length : turned;
    }
  });
}

Mesh Skin::posed(const BodyPose& pose) const {
  const auto motion = motionOf(bones_, placeBones(pose));
  Mesh s = first_;
  std::vector<quat> turns(s.normals.size());
  parallelFor(s.normals.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      DualQuaternion q{quat(0, 0, 0, 0), quat(0, 0, 0, 0)};
      const quat& reference = motion[influences_[influence_start_[i]].bone].turn;
      for (std::uint32_t k = influence_start_[i]; k < influence_start_[i + 1]; ++k) {
        const DualQuaternion& b = motion[influences_[k].bone];
        const float w = influences_[k].weight * (glm::dot(b.turn, reference) < 0 ? -1.0f : 1.0f);
        q.turn = q.turn + w * b.turn;
        q.shift = q.shift + w * b.shift;
      }
      const float length = glm::length(q.turn);
      turns[i] = q.turn / length;
      const quat t = 2.0f * ((q.shift / length) * glm::conjugate(turns[i]));
      s.vertices[i] = turns[i] * first_.vertices[i] + vec3(t.x, t.y, t.z);
    }
  });
  turnNormals(s, turns);
  return s;
}

}  // namespace beam
