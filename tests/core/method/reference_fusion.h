// SPDX-License-Identifier: Apache-2.0
// The mesh of depth pictures said the simplest way: every voxel asks every view, all blocks are kept, one
// thread. What core/method/tsdf.h makes must be the same to the bit.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/method/tsdf.h"
#include "core/method/voxel_blocks.h"

namespace beam::testing {

class ReferenceFusion {
 public:
  ReferenceFusion(std::span<const DepthView> views, const TsdfOptions& o) : o_(o) {
    for (const std::uint64_t key : blocksNear(views)) {
      TsdfBlock& block = blocks_[key] = {.index = blockOf(key)};
      for (const DepthView& view : views) {
        for (int i = 0; i < kBlockVoxels; ++i) add(view, block, i);
      }
    }
    for (const auto& [key, block] : blocks_) {
      for (int i = 0; i < kBlockVoxels; ++i) cell(block.index * kBlock + voxelInBlock(i));
    }
  }
  const Mesh& mesh() const { return mesh_; }

 private:
  using Voxel = std::tuple<int, int, int>;
  struct Corner {
    ivec3 voxel;
    float distance;
  };

  std::set<std::uint64_t> blocksNear(std::span<const DepthView> views) const {
    std::set<std::uint64_t> keys;
    const double size = o_.voxel_m * kBlock;
    for (const DepthView& view : views) {
      const Rigid3 world_from_camera = inverse(view.camera.camera_from_world);
      for (int p = 0; p < view.depth.width * view.depth.height; ++p) {
        if (view.depth.values[p] <= 0 || view.weight.values[p] <= 0) continue;
        const dvec2 at(p % view.depth.width + 0.5, p / view.depth.width + 0.5);
        const dvec3 x = world_from_camera *
                        (static_cast<double>(view.depth.values[p]) * rayOf(view.camera.intrinsics, at));
        const ivec3 low(glm::floor((x - double(o_.truncation_m)) / size));
        const ivec3 high(glm::floor((x + double(o_.truncation_m)) / size));
        for (int k = low.z; k <= high.z; ++k)
          for (int j = low.y; j <= high.y; ++j)
            for (int i = low.x; i <= high.x; ++i) keys.insert(keyOf({i, j, k}));
      }
    }
    return keys;
  }

  void add(const DepthView& view, TsdfBlock& block, int i) const {
    const dvec3 voxel(block.index * kBlock + voxelInBlock(i));
    const dvec3 t =
        glm::mat3_cast(view.camera.camera_from_world.rotation) * (voxel * static_cast<double>(o_.voxel_m)) +
        view.camera.camera_from_world.translation_m;
    if (t.z <= 0.01) return;
    const dvec2 p = project(view.camera.intrinsics, t);
    if (!(p.x >= 0 && p.y >= 0 && p.x < view.depth.width && p.y < view.depth.height)) return;
    const std::size_t at = static_cast<std::size_t>(p.y) * view.depth.width + static_cast<std::size_t>(p.x);
    const float depth = view.depth.values[at], weight = view.weight.values[at];
    if (depth <= 0 || weight <= 0) return;
    const double along = (depth - t.z) * glm::length(t) / t.z;
    if (along < -o_.truncation_m) return;
    const auto d = static_cast<float>(std::min(1.0, along / o_.truncation_m));
    block.distance[i] = (block.distance[i] * block.weight[i] + d * weight) / (block.weight[i] + weight);
    block.weight[i] += weight;
  }

  bool value(ivec3 voxel, float& distance) const {
    const ivec3 b(glm::floor(dvec3(voxel) / double(kBlock)));
    const auto found = blocks_.find(keyOf(b));
    if (found == blocks_.end()) return false;
    const int i = indexInBlock(voxel - b * kBlock);
    distance = found->second.distance[i];
    return found->second.weight[i] > 0;
  }

  void cell(ivec3 origin) {
    std::array<Corner, 8> corner;
    for (int c = 0; c < 8; ++c) {
      corner[c].voxel = origin + ivec3(c & 1, (c >> 1) & 1, (c >> 2) & 1);
      if (!value(corner[c].voxel, corner[c].distance)) return;
    }
    for (const auto& t : {std::array{0, 5, 1, 7}, std::array{0, 1, 3, 7}, std::array{0, 3, 2, 7},
                          std::array{0, 2, 6, 7}, std::array{0, 6, 4, 7}, std::array{0, 4, 5, 7}}) {
      std::vector<Corner> in, out;
      for (const int c : t) (corner[c].distance < 0 ? in : out).push_back(corner[c]);
      if (in.size() == 2) {
        const std::uint32_t a = vertex(in[0], out[0]), b = vertex(in[0], out[1]);
        const std::uint32_t d = vertex(in[1], out[0]), e = vertex(in[1], out[1]);
        triangle(a, b, d, in[0], out[0]);
        triangle(d, b, e, in[0], out[0]);
      } else if (in.size() == 1) {
        triangle(vertex(in[0], out[0]), vertex(in[0], out[1]), vertex(in[0], out[2]), in[0], out[0]);
      } else if (in.size() == 3) {
        triangle(vertex(out[0], in[0]), vertex(out[0], in[1]), vertex(out[0], in[2]), in[0], out[0]);
      }
    }
  }

  std::uint32_t vertex(const Corner& a, const Corner& b) {
    const Voxel va(a.voxel.x, a.voxel.y, a.voxel.z), vb(b.voxel.x, b.voxel.y, b.voxel.z);
    const Corner &low = va < vb ? a : b, &high = va < vb ? b : a;
    const auto [at, fresh] = vertices_.try_emplace({std::min(va, vb), std::max(va, vb)},
                                                   static_cast<std::uint32_t>(vertices_.size()));
    if (fresh) {
      const float t = low.distance / (low.distance - high.distance);
      mesh_.vertices.push_back(o_.voxel_m * (vec3(low.voxel) + t * vec3(high.voxel - low.voxel)));
    }
    return at->second;
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, const Corner& in, const Corner& out) {
    const vec3 p = mesh_.vertices[a], n = glm::cross(mesh_.vertices[b] - p, mesh_.vertices[c] - p);
    if (glm::dot(n, vec3(out.voxel - in.voxel)) < 0) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  }

  TsdfOptions o_;
  std::map<std::uint64_t, TsdfBlock> blocks_;
  std::map<std::pair<Voxel, Voxel>, std::uint32_t> vertices_;
  Mesh mesh_;
};

}  // namespace beam::testing
