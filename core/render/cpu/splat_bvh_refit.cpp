// SPDX-License-Identifier: Apache-2.0
// Lays the tree of splat_bvh.h around its Gaussians: data of the leaves, boxes, slabs. The Gaussians below a
// node lie in one run of blocks.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/render/cpu/splat_bvh.h"

namespace beam {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct BlockRange {
  std::size_t first, last;  // last: one past the end
};

bool isLeaf(std::int32_t child) { return child < 0; }
BlockRange blocksOf(std::int32_t leaf) {
  const auto code = static_cast<std::size_t>(~leaf);
  return {code / 2, code / 2 + code % 2 + 1};
}

// Of every child of every node. Children stand behind their parents.
std::vector<BlockRange> rangesOf(const SplatBvh& tree) {
  std::vector<BlockRange> ranges(tree.nodes.size() * 16), whole(tree.nodes.size());
  for (std::size_t n = tree.nodes.size(); n-- > 0;) {
    whole[n] = {tree.blocks.size(), 0};
    for (std::size_t lane = 0; lane < 16; ++lane) {
      const std::int32_t child = tree.nodes[n].child[lane];
      if (child == 0) continue;
      const BlockRange r = isLeaf(child) ? blocksOf(child) : whole[static_cast<std::size_t>(child)];
      ranges[n * 16 + lane] = r;
      whole[n] = {std::min(whole[n].first, r.first), std::max(whole[n].last, r.last)};
    }
  }
  return ranges;
}

// Rows of the canonical transform are axis / sigma.
vec3 rowOf(const RaySplat& s, int k) {
  return {s.canonical[3 * k], s.canonical[3 * k + 1], s.canonical[3 * k + 2]};
}
vec3 thinAxis(const RaySplat& s) {
  vec3 thin = rowOf(s, 0);
  for (int k = 1; k < 3; ++k) {
    if (const vec3 row = rowOf(s, k); glm::dot(row, row) > glm::dot(thin, thin)) thin = row;
  }
  return glm::normalize(thin);
}

class Refit {
 public:
  Refit(SplatBvh& tree, const std::vector<RaySplat>& splats) : tree_(tree), splats_(splats) {}

  void run() {
    parallelFor(tree_.blocks.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) fillBlock(b);
    });
    const std::vector<BlockRange> ranges = rangesOf(tree_);
    parallelFor(ranges.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        fillBox(tree_.nodes[i / 16], i % 16, ranges[i]);
        if (tree_.nodes[i / 16].child[i % 16] != 0) fillSlab(tree_.nodes[i / 16], i % 16, ranges[i]);
      }
    });
  }

 private:
  void fillBlock(std::size_t b) {
    SplatBlock& block = tree_.blocks[b];
    std::fill_n(block.cut2, 16, -1.0f);
    for (std::size_t lane = 0; lane < 16; ++lane) {
      if (tree_.splat[16 * b + lane] == kNoSplat) continue;
      const RaySplat& s = splats_[tree_.splat[16 * b + lane]];
      for (int k = 0; k < 9; ++k) block.canonical[k][lane] = s.canonical[k];
      for (int k = 0; k < 3; ++k) block.center[k][lane] = s.center[k];
      block.opacity[lane] = s.opacity;
      block.cut2[lane] = s.cut2;
    }
  }

  template <class Body>
  void forSplats(const BlockRange& range, Body&& body) const {
    for (std::size_t i = 16 * range.first; i < 16 * range.last; ++i) {
      if (tree_.splat[i] != kNoSplat) body(splats_[tree_.splat[i]]);
    }
  }

  void fillBox(SplatNode& node, std::size_t lane, const BlockRange& range) const {
    vec3 low(kInfinity), high(-kInfinity);
    forSplats(range, [&](const RaySplat& s) {
      low = glm::min(low, s.low);
      high = glm::max(high, s.high);
    });
    for (int k = 0; k < 3; ++k) {
      node.bound[k][lane] = low[k];
      node.bound[3 + k][lane] = high[k];
    }
  }

  void fillSlab(SplatNode& node, std::size_t lane, const BlockRange& range) const {
    vec3 axis(0);
    forSplats(range, [&](const RaySplat& s) {
      const vec3 thin = thinAxis(s);
      axis += glm::dot(axis, thin) < 0 ? -thin : thin;
    });
    axis = glm::normalize(axis);
    float low = kInfinity, high = -kInfinity;
    forSplats(range, [&](const RaySplat& s) {
      float variance = 0;
      for (int k = 0; k < 3; ++k) {
        const vec3 row = rowOf(s, k);
        const float along = glm::dot(row, axis) / glm::dot(row, row);  // sigma (axis . own axis)
        variance += along * along;
      }
      const float reach = std::sqrt(variance * s.cut2) + s.margin_m, at = glm::dot(s.center, axis);
      low = std::min(low, at - reach);
      high = std::max(high, at + reach);
    });
    for (int k = 0; k < 3; ++k) node.axis[k][lane] = axis[k];
    node.axis_low[lane] = low;
    node.axis_high[lane] = high;
  }

  SplatBvh& tree_;
  const std::vector<RaySplat>& splats_;
};

float areaOf(vec3 low, vec3 high) {
  const vec3 e = high - low;
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

}  // namespace

void refitSplatBvh(SplatBvh& tree, const std::vector<RaySplat>& splats) {
  if (splats.size() != tree.splats)
    throw Error(Error::Kind::Bug, "a tree can only be refitted to as many Gaussians as it was built for");
  Refit(tree, splats).run();
}

float costOf(const SplatBvh& tree) {
  double sum = 0;
  vec3 low(kInfinity), high(-kInfinity);
  for (const SplatNode& node : tree.nodes) {
    for (int i = 0; i < 16; ++i) {
      if (node.child[i] == 0) continue;
      const vec3 a(node.bound[0][i], node.bound[1][i], node.bound[2][i]);
      const vec3 b(node.bound[3][i], node.bound[4][i], node.bound[5][i]);
      sum += areaOf(a, b);
      if (&node == &tree.nodes.front()) low = glm::min(low, a), high = glm::max(high, b);
    }
  }
  return tree.nodes.empty() ? 0 : static_cast<float>(sum / areaOf(low, high));
}

}  // namespace beam
