// SPDX-License-Identifier: Apache-2.0
#include "core/method/tsdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "core/base/parallel.h"

namespace beam {
namespace {

constexpr int kBlock = 8;  // voxels a side
constexpr int kBlockVoxels = kBlock * kBlock * kBlock;
constexpr int kRange = 1 << 20;  // block indices lie in [-kRange, kRange)

std::uint64_t keyOf(ivec3 b) {
  return (static_cast<std::uint64_t>(b.x + kRange) << 42) | (static_cast<std::uint64_t>(b.y + kRange) << 21) |
         static_cast<std::uint64_t>(b.z + kRange);
}
ivec3 blockOf(std::uint64_t key) {
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  return {static_cast<int>(key >> 42) - kRange, static_cast<int>((key >> 21) & kMask) - kRange,
          static_cast<int>(key & kMask) - kRange};
}

struct Block {
  ivec3 index;
  std::array<float, kBlockVoxels> distance;  // of the truncation, [-1, 1]
  std::array<float, kBlockVoxels> weight;
};

// Blocks within the truncation of any depth sample, sorted by key.
std::vector<std::uint64_t> touchedBlocks(std::span<const DepthView> views, const TsdfOptions& o) {
  std::vector<std::vector<std::uint64_t>> found(views.size());
  const double size = o.voxel_m * kBlock;
  parallelFor(views.size(), 1, [&](std::size_t v, std::size_t) {
    const DepthView& view = views[v];
    const Rigid3 world_from_camera = inverse(view.camera.camera_from_world);
    for (int y = 0; y < view.depth.height; ++y) {
      for (int x = 0; x < view.depth.width; ++x) {
        const std::size_t p = static_cast<std::size_t>(y) * view.depth.width + x;
        if (view.depth.values[p] <= 0 || view.weight.values[p] <= 0) continue;
        const dvec3 at = world_from_camera * (static_cast<double>(view.depth.values[p]) *
                                              rayOf(view.camera.intrinsics, {x + 0.5, y + 0.5}));
        const ivec3 low = ivec3(glm::floor((at - double(o.truncation_m)) / size));
        const ivec3 high = ivec3(glm::floor((at + double(o.truncation_m)) / size));
        for (int k = low.z; k <= high.z; ++k) {
          for (int j = low.y; j <= high.y; ++j) {
            for (int i = low.x; i <= high.x; ++i) found[v].push_back(keyOf({i, j, k}));
          }
        }
      }
    }
    std::sort(found[v].begin(), found[v].end());
    found[v].erase(std::unique(found[v].begin(), found[v].end()), found[v].end());
  });
  std::vector<std::uint64_t> all;
  for (const auto& f : found) all.insert(all.end(), f.begin(), f.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void integrate(Block& block, std::span<const DepthView> views, const TsdfOptions& o) {
  block.distance.fill(0);
  block.weight.fill(0);
  for (const DepthView& view : views) {
    const dmat3 r = glm::mat3_cast(view.camera.camera_from_world.rotation);
    for (int i = 0; i < kBlockVoxels; ++i) {
      const ivec3 voxel =
          block.index * kBlock + ivec3(i % kBlock, i / kBlock % kBlock, i / (kBlock * kBlock));
      const dvec3 t =
          r * (dvec3(voxel) * static_cast<double>(o.voxel_m)) + view.camera.camera_from_world.translation_m;
      if (t.z <= 0.01) continue;
      const dvec2 p = project(view.camera.intrinsics, t);
      if (!(p.x >= 0 && p.y >= 0 && p.x < view.depth.width && p.y < view.depth.height)) continue;
      const std::size_t at = static_cast<std::size_t>(p.y) * view.depth.width + static_cast<std::size_t>(p.x);
      const float depth = view.depth.values[at], weight = view.weight.values[at];
      if (depth <= 0 || weight <= 0) continue;
      // Along the ray, not along the axis: free of the obliquity of border pixels.
      const double along = (depth - t.z) * glm::length(t) / t.z;
      if (along < -o.truncation_m) continue;
      const auto d = static_cast<float>(std::min(1.0, along / o.truncation_m));
      block.distance[i] = (block.distance[i] * block.weight[i] + d * weight) / (block.weight[i] + weight);
      block.weight[i] += weight;
    }
  }
}

class Surface {
 public:
  Surface(const std::vector<Block>& blocks, float voxel_m) : blocks_(blocks), voxel_m_(voxel_m) {
    for (std::size_t b = 0; b < blocks.size(); ++b) index_[keyOf(blocks[b].index)] = b;
  }

  // Marching tetrahedra: six around the diagonal of every cell, shared edges give shared vertices.
  Mesh extract(Progress& progress) {
    for (const Block& block : blocks_) {
      progress.step();
      for (int i = 0; i < kBlockVoxels; ++i) {
        cell(block.index * kBlock + ivec3(i % kBlock, i / kBlock % kBlock, i / (kBlock * kBlock)));
      }
    }
    return std::move(mesh_);
  }

 private:
  struct Corner {
    ivec3 voxel;
    float distance;
  };

  bool value(ivec3 voxel, float& distance) const {
    const auto floorDiv = [](int a) { return a >= 0 ? a / kBlock : -((-a + kBlock - 1) / kBlock); };
    const ivec3 b(floorDiv(voxel.x), floorDiv(voxel.y), floorDiv(voxel.z)), in = voxel - b * kBlock;
    const auto found = index_.find(keyOf(b));
    if (found == index_.end()) return false;
    const Block& block = blocks_[found->second];
    const int i = (in.z * kBlock + in.y) * kBlock + in.x;
    distance = block.distance[i];
    return block.weight[i] > 0;
  }

  void cell(ivec3 origin) {
    std::array<Corner, 8> corner;
    int inside = 0;
    for (int c = 0; c < 8; ++c) {
      corner[c].voxel = origin + ivec3(c & 1, (c >> 1) & 1, (c >> 2) & 1);
      if (!value(corner[c].voxel, corner[c].distance)) return;
      inside += corner[c].distance < 0;
    }
    if (inside == 0 || inside == 8) return;
    static constexpr int kTetrahedra[6][4] = {{0, 5, 1, 7}, {0, 1, 3, 7}, {0, 3, 2, 7},
                                              {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}};
    for (const auto& t : kTetrahedra)
      tetrahedron({&corner[t[0]], &corner[t[1]], &corner[t[2]], &corner[t[3]]});
  }

  void tetrahedron(const std::array<const Corner*, 4>& c) {
    std::vector<const Corner*> in, out;
    for (const Corner* k : c) (k->distance < 0 ? in : out).push_back(k);
    if (in.empty() || out.empty()) return;
    if (in.size() == 2) {
      const std::uint32_t a = vertex(*in[0], *out[0]), b = vertex(*in[0], *out[1]);
      const std::uint32_t d = vertex(*in[1], *out[0]), e = vertex(*in[1], *out[1]);
      triangle(a, b, d, *in[0], *out[0]);
      triangle(d, b, e, *in[0], *out[0]);
      return;
    }
    const bool alone_inside = in.size() == 1;
    const Corner& tip = alone_inside ? *in[0] : *out[0];
    const auto& others = alone_inside ? out : in;
    triangle(vertex(tip, *others[0]), vertex(tip, *others[1]), vertex(tip, *others[2]),
             alone_inside ? tip : *others[0], alone_inside ? *others[0] : tip);
  }

  std::uint32_t vertex(const Corner& a, const Corner& b) {
    const Corner &low = less(a.voxel, b.voxel) ? a : b, &high = less(a.voxel, b.voxel) ? b : a;
    const ivec3 step = high.voxel - low.voxel;
    const int edge = (step.x + 1) + 3 * (step.y + 1) + 9 * (step.z + 1);
    const auto [at, fresh] =
        vertices_.try_emplace({keyOf(low.voxel), edge}, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (fresh) {
      const float t = low.distance / (low.distance - high.distance);
      mesh_.vertices.push_back(voxel_m_ * (vec3(low.voxel) + t * vec3(step)));
    }
    return at->second;
  }

  static bool less(ivec3 a, ivec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

  // Wound so that it faces from the inside corner to the outside one.
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, const Corner& in, const Corner& out) {
    if (a == b || b == c || a == c) return;
    const vec3 p = mesh_.vertices[a], n = glm::cross(mesh_.vertices[b] - p, mesh_.vertices[c] - p);
    if (glm::dot(n, vec3(out.voxel - in.voxel)) < 0) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  }

  struct EdgeHash {
    std::size_t operator()(const std::pair<std::uint64_t, int>& e) const {
      return std::hash<std::uint64_t>()(e.first * 31 + static_cast<std::uint64_t>(e.second));
    }
  };

  const std::vector<Block>& blocks_;
  float voxel_m_;
  std::unordered_map<std::uint64_t, std::size_t> index_;
  std::unordered_map<std::pair<std::uint64_t, int>, std::uint32_t, EdgeHash> vertices_;
  Mesh mesh_;
};

}  // namespace

Mesh fuseDepth(std::span<const DepthView> views, const TsdfOptions& options, Progress& progress) {
  const std::vector<std::uint64_t> keys = touchedBlocks(views, options);
  std::vector<Block> blocks(keys.size());
  progress.expect(static_cast<std::int64_t>(blocks.size()));
  progress.check();
  parallelFor(keys.size(), 16, [&](std::size_t begin, std::size_t end) {
    if (progress.stopRequested()) return;
    for (std::size_t b = begin; b < end; ++b) {
      blocks[b].index = blockOf(keys[b]);
      integrate(blocks[b], views, options);
    }
  });
  return Surface(blocks, options.voxel_m).extract(progress);
}

Mesh keepLargeComponents(const Mesh& mesh, double share) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : mesh.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  std::vector<std::size_t> size(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles) ++size[root(t[0])];
  const std::size_t largest = size.empty() ? 0 : *std::max_element(size.begin(), size.end());
  Mesh out;
  std::vector<std::uint32_t> renamed(mesh.vertices.size(), UINT32_MAX);
  for (const auto& t : mesh.triangles) {
    if (static_cast<double>(size[root(t[0])]) < share * static_cast<double>(largest)) continue;
    std::array<std::uint32_t, 3> n;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& r = renamed[t[k]];
      if (r == UINT32_MAX) {
        r = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[t[k]]);
      }
      n[k] = r;
    }
    out.triangles.push_back(n);
  }
  return out;
}

}  // namespace beam
