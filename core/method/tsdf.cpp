// SPDX-License-Identifier: Apache-2.0
#include "core/method/tsdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "core/method/kept_fusion.h"
#include "core/method/voxel_blocks.h"
#include "core/method/zero_surface.h"

namespace beam {
namespace {

constexpr double kNearest_m = 0.01;              // to a camera
constexpr std::size_t kTrianglesOfABlock = 400;  // of a person 190 to 320, the more the finer
constexpr std::size_t kSlab = 2048;              // blocks at least: 8 MB and their triangles
constexpr std::size_t kViewsAtOnce = 16;         // whose blocks are found side by side

// Keys of which most come again and again: sorted, each once.
class KeySet {
 public:
  explicit KeySet(std::size_t most) : most_(most) {}

  void add(std::uint64_t key) {
    if (std::exchange(recent_[(key * 0x9e3779b97f4a7c15ull) >> 52], key) == key) return;
    keys_.push_back(key);
    if (keys_.size() >= compact_at_) compact();
  }
  void compact() {
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    compact_at_ = 2 * keys_.size() + kSlack;
  }
  // After compact(), or while they are still being added: then it tells late.
  bool areTooMany() const { return compact_at_ > 2 * most_ + kSlack; }
  const std::vector<std::uint64_t>& keys() const { return keys_; }

 private:
  static constexpr std::size_t kSlack = 1u << 16;
  std::size_t most_, compact_at_ = kSlack;
  std::vector<std::uint64_t> keys_;
  std::array<std::uint64_t, 4096> recent_ = {};
};

void addTouched(const DepthView& view, const TsdfOptions& o, int every, const Progress& progress,
                KeySet& keys) {
  const double size = o.voxel_m * kBlock;
  const Rigid3 world_from_camera = inverse(view.camera.camera_from_world);
  for (int y = every / 2; y < view.depth.height; y += every) {
    if (progress.stopRequested() || keys.areTooMany()) return;
    for (int x = every / 2; x < view.depth.width; x += every) {
      const std::size_t p = static_cast<std::size_t>(y) * view.depth.width + x;
      if (view.depth.values[p] <= 0 || view.weight.values[p] <= 0) continue;
      const dvec3 at = world_from_camera * (static_cast<double>(view.depth.values[p]) *
                                            rayOf(view.camera.intrinsics, {x + 0.5, y + 0.5}));
      const dvec3 from = (at - double(o.truncation_m)) / size, to = (at + double(o.truncation_m)) / size;
      if (!o.bounds.contains(at) || !isInRange(from) || !isInRange(to)) continue;
      const ivec3 low = floorOf(from), high = floorOf(to);
      for (int k = low.z; k <= high.z; ++k) {
        for (int j = low.y; j <= high.y; ++j) {
          for (int i = low.x; i <= high.x; ++i) keys.add(keyOf({i, j, k}));
        }
      }
    }
  }
}

// A view, with what tells quickly that it says nothing of a block.
class FusedView {
 public:
  explicit FusedView(const DepthView& view)
      : view_(view),
        rotation_(glm::mat3_cast(view.camera.camera_from_world.rotation)),
        tiles_across_((view.depth.width + kTile - 1) / kTile),
        farthest_(static_cast<std::size_t>(tiles_across_) * ((view.depth.height + kTile - 1) / kTile), 0.0f) {
  }

  void findFarthest() {
    for (int y = 0; y < view_.depth.height; ++y) {
      for (int x = 0; x < view_.depth.width; ++x) {
        const std::size_t p = static_cast<std::size_t>(y) * view_.depth.width + x;
        float& farthest = farthest_[static_cast<std::size_t>(y / kTile) * tiles_across_ + x / kTile];
        if (view_.weight.values[p] > 0) farthest = std::max(farthest, view_.depth.values[p]);
      }
    }
  }

  void addTo(TsdfBlock& block, const TsdfOptions& o) const {
    if (!tellsOf(block, o)) return;
    for (int i = 0; i < kBlockVoxels; ++i) {
      const ivec3 voxel = block.index * kBlock + voxelInBlock(i);
      const dvec3 t = inCamera(dvec3(voxel) * static_cast<double>(o.voxel_m));
      if (t.z <= kNearest_m) continue;
      const dvec2 p = project(view_.camera.intrinsics, t);
      if (!(p.x >= 0 && p.y >= 0 && p.x < view_.depth.width && p.y < view_.depth.height)) continue;
      const std::size_t at =
          static_cast<std::size_t>(p.y) * view_.depth.width + static_cast<std::size_t>(p.x);
      const float depth = view_.depth.values[at], weight = view_.weight.values[at];
      if (depth <= 0 || weight <= 0 || depth - t.z < -kMargin * o.truncation_m) continue;
      // Along the ray, not along the axis: free of the obliquity of border pixels.
      const double along =
          depth - t.z > kMargin * o.truncation_m ? depth - t.z : (depth - t.z) * glm::length(t) / t.z;
      if (along < -o.truncation_m) continue;
      const auto d = static_cast<float>(std::min(1.0, along / o.truncation_m));
      block.distance[i] = (block.distance[i] * block.weight[i] + d * weight) / (block.weight[i] + weight);
      block.weight[i] += weight;
    }
  }

 private:
  static constexpr int kTile = 8;            // pixels
  static constexpr double kMargin = 1.0001;  // on what is left out early, against rounding

  dvec3 inCamera(const dvec3& x) const {
    return rotation_ * x + view_.camera.camera_from_world.translation_m;
  }

  // Whether the block's surrounding ball meets the picture, no further behind its depth than the truncation.
  bool tellsOf(const TsdfBlock& block, const TsdfOptions& o) const {
    const double half = 0.5 * (kBlock - 1);
    const double radius = kMargin * std::sqrt(3.0) * half * o.voxel_m;
    const dvec3 center = inCamera((dvec3(block.index * kBlock) + half) * static_cast<double>(o.voxel_m));
    const double nearest = center.z - radius, farthest = center.z + radius;
    if (farthest <= kNearest_m) return false;
    if (nearest <= kNearest_m) return true;
    const Intrinsics& k = view_.camera.intrinsics;
    const auto [x0, x1] = tilesAlong(k.fx, k.cx, center.x, radius, nearest, farthest, view_.depth.width);
    const auto [y0, y1] = tilesAlong(k.fy, k.cy, center.y, radius, nearest, farthest, view_.depth.height);
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const float depth = farthest_[static_cast<std::size_t>(y) * tiles_across_ + x];
        if (depth > 0 && depth >= nearest - kMargin * o.truncation_m) return true;
      }
    }
    return false;
  }

  // First and last tile of one axis that a ball may fall on; the last before the first: none.
  static std::pair<int, int> tilesAlong(double focal, double middle, double at, double radius, double nearest,
                                        double farthest, int pixels) {
    const double low = at - radius, high = at + radius;
    const double from = focal * (low / (low < 0 ? nearest : farthest)) + middle - 1;
    const double to = focal * (high / (high < 0 ? farthest : nearest)) + middle + 1;
    if (!(from < pixels && to >= 0)) return {0, -1};
    return {static_cast<int>(std::max(from, 0.0)) / kTile,
            static_cast<int>(std::min(to, pixels - 1.0)) / kTile};
  }

  const DepthView& view_;
  dmat3 rotation_;  // camera_from_world
  int tiles_across_;
  std::vector<float> farthest_;  // depth of a tile's pixels that count; 0: none does
};

TsdfBlock fusedBlock(std::uint64_t key, std::span<const FusedView> views, const TsdfOptions& o) {
  TsdfBlock block{.index = blockOf(key)};
  for (const FusedView& view : views) view.addTo(block, o);
  for (int i = 0; i < kBlockVoxels; ++i) {
    const dvec3 at = dvec3(block.index * kBlock + voxelInBlock(i)) * static_cast<double>(o.voxel_m);
    if (!o.bounds.contains(at)) block.weight[i] = 0;
  }
  return block;
}

// Whole layers of rising x.
std::size_t endOfSlab(std::span<const std::uint64_t> blocks, std::size_t begin) {
  std::size_t end = std::min(begin + kSlab, blocks.size());
  while (end < blocks.size() && blockOf(blocks[end]).x == blockOf(blocks[end - 1]).x) ++end;
  return end;
}

}  // namespace

std::optional<std::vector<std::uint64_t>> touchedBlocks(std::span<const DepthView> views,
                                                        const TsdfOptions& options, std::size_t most,
                                                        int every, const Progress& progress) {
  std::vector<std::uint64_t> all;
  for (std::size_t first = 0; first < views.size(); first += kViewsAtOnce) {
    const auto now = views.subspan(first, std::min(kViewsAtOnce, views.size() - first));
    std::vector<KeySet> found(now.size(), KeySet(most));
    parallelFor(now.size(), 1, [&](std::size_t v, std::size_t) {
      addTouched(now[v], options, every, progress, found[v]);
      found[v].compact();
    });
    progress.check();
    for (const KeySet& of_view : found) {
      std::vector<std::uint64_t> both;
      std::set_union(all.begin(), all.end(), of_view.keys().begin(), of_view.keys().end(),
                     std::back_inserter(both));
      all = std::move(both);
      if (of_view.areTooMany() || all.size() > most) return std::nullopt;
    }
  }
  return all;
}

std::optional<Mesh> fuseDepth(std::span<const DepthView> views, const TsdfOptions& options,
                              std::span<const std::uint64_t> blocks, std::size_t most_rows,
                              Progress& progress, KeptFusion* kept) {
  progress.expect(static_cast<std::int64_t>(blocks.size()));
  std::vector<FusedView> fused(views.begin(), views.end());
  parallelFor(fused.size(), 1, [&](std::size_t v, std::size_t) {
    if (!progress.stopRequested()) fused[v].findFarthest();
  });
  ZeroSurface surface(options.voxel_m, std::min(kTrianglesOfABlock * blocks.size(), most_rows));
  std::size_t begin = kept ? kept->takeUp(blocks.size(), surface) : 0;
  progress.step(static_cast<std::int64_t>(begin));
  while (begin < blocks.size()) {
    const std::size_t end = endOfSlab(blocks, begin);
    std::vector<TsdfBlock> slab(end - begin);
    parallelFor(slab.size(), 16, [&](std::size_t from, std::size_t to) {
      if (progress.stopRequested()) return;
      for (std::size_t b = from; b < to; ++b) slab[b] = fusedBlock(blocks[begin + b], fused, options);
    });
    progress.check();
    surface.add(std::move(slab), end == blocks.size(), progress);
    if (std::max(surface.soFar().vertices.size(), surface.soFar().triangles.size()) > most_rows)
      return std::nullopt;
    progress.step(static_cast<std::int64_t>(end - begin));
    begin = end;
    if (kept && begin < blocks.size()) kept->keep(begin, surface, progress);
  }
  return surface.take();
}

Mesh keepLargeComponents(const Mesh& mesh, double share, const Progress& progress) {
  constexpr std::size_t kBetweenChecks = 1u << 18;
  const auto eachTriangle = [&](auto&& body) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      if (i % kBetweenChecks == 0) progress.check();
      body(mesh.triangles[i]);
    }
  };
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  eachTriangle([&](const auto& t) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  });
  std::vector<std::uint32_t> size(mesh.vertices.size(), 0);
  eachTriangle([&](const auto& t) { ++size[root(t[0])]; });
  const std::uint32_t largest = size.empty() ? 0 : *std::max_element(size.begin(), size.end());
  Mesh out;
  out.vertices.reserve(mesh.vertices.size());
  out.triangles.reserve(mesh.triangles.size());
  std::vector<std::uint32_t> renamed(mesh.vertices.size(), UINT32_MAX);
  eachTriangle([&](const auto& t) {
    if (static_cast<double>(size[root(t[0])]) < share * static_cast<double>(largest)) return;
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
  });
  return out;
}

}  // namespace beam
