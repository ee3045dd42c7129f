// SPDX-License-Identifier: Apache-2.0
// Builds the tree of splat_bvh.h: binary splits by the surface area heuristic in 16 bins, then every node
// takes in its largest descendants until it has 16 children. The tree does not depend on the number of
// threads.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/render/cpu/splat_bvh.h"

namespace beam {
namespace {

constexpr std::size_t kLeafSize = 32;  // Gaussians
constexpr int kBins = 16;
constexpr int kHeuristicDepth = 40;  // below, halves: 2^24 Gaussians still end above kMaxTreeDepth
constexpr std::size_t kParallelSize = 8192;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Box {
  vec3 low = vec3(kInfinity), high = vec3(-kInfinity);
  void add(vec3 a, vec3 b) {
    low = glm::min(low, a);
    high = glm::max(high, b);
  }
  void add(const Box& b) { add(b.low, b.high); }
  float area() const {
    const vec3 e = high - low;
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
};

struct Item {
  vec3 low, high;
  std::uint32_t splat;
  vec3 center() const { return 0.5f * (low + high); }
};

struct Branch {
  Box box;
  std::size_t begin = 0, end = 0;  // of the items
  std::unique_ptr<Branch> left, right;
};

struct Split {
  float cost = kInfinity;
  int axis = -1, bin = 0;
};

struct Binning {
  vec3 low, per_m;  // bin = (center - low) * per_m

  Binning(const Box& centers) : low(centers.low) {
    for (int a = 0; a < 3; ++a) {
      const float extent = centers.high[a] - centers.low[a];
      per_m[a] = extent > 0 ? kBins / extent : 0;
    }
  }
  int of(const Item& item, int axis) const {
    return std::min(kBins - 1, static_cast<int>((item.center()[axis] - low[axis]) * per_m[axis]));
  }
};

struct Bins {
  Box box[kBins];
  std::size_t count[kBins] = {};
};

// Cost of a side: its area times the number of leaves it needs.
float costOf(const Box& box, std::size_t count) {
  const std::size_t leaves = (count + kLeafSize - 1) / kLeafSize;
  return count == 0 ? 0 : box.area() * static_cast<float>(leaves);
}

void considerSplits(const Bins& bins, int axis, Split& best) {
  float right_cost[kBins] = {};
  std::size_t right_count[kBins] = {};
  Box right, left;
  for (int b = kBins - 1, n = 0; b > 0; --b) {
    right.add(bins.box[b]);
    n += static_cast<int>(bins.count[b]);
    right_count[b] = static_cast<std::size_t>(n);
    right_cost[b] = costOf(right, right_count[b]);
  }
  std::size_t left_count = 0;
  for (int b = 0; b + 1 < kBins; ++b) {
    left.add(bins.box[b]);
    left_count += bins.count[b];
    if (left_count == 0 || right_count[b + 1] == 0) continue;
    const float cost = costOf(left, left_count) + right_cost[b + 1];
    if (cost < best.cost) best = {cost, axis, b};
  }
}

class Builder {
 public:
  explicit Builder(const std::vector<RaySplat>& splats) : splats_(splats) {
    items_.reserve(splats.size());
    for (std::size_t i = 0; i < splats.size(); ++i) {
      items_.push_back({splats[i].low, splats[i].high, static_cast<std::uint32_t>(i)});
    }
  }

  SplatBvh build() {
    if (items_.empty()) return {};
    const std::unique_ptr<Branch> root = branch(0, items_.size(), 0);
    addNode(*root);
    parallelFor(children_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) fillSlab(i);
    });
    tree_.nodes.shrink_to_fit();
    tree_.blocks.shrink_to_fit();
    return std::move(tree_);
  }

 private:
  std::unique_ptr<Branch> branch(std::size_t begin, std::size_t end, int depth) {
    auto made = std::make_unique<Branch>();
    made->begin = begin;
    made->end = end;
    Box centers;
    for (std::size_t i = begin; i < end; ++i) {
      made->box.add(items_[i].low, items_[i].high);
      centers.add(items_[i].center(), items_[i].center());
    }
    if (end - begin <= kLeafSize) return made;
    const std::size_t middle = split(begin, end, depth, centers);
    const auto side = [&](std::size_t s) {
      (s == 0 ? made->left : made->right) =
          s == 0 ? branch(begin, middle, depth + 1) : branch(middle, end, depth + 1);
    };
    if (end - begin > kParallelSize) {
      parallelFor(2, 1, [&](std::size_t s, std::size_t) { side(s); });
    } else {
      side(0), side(1);
    }
    return made;
  }

  std::size_t split(std::size_t begin, std::size_t end, int depth, const Box& centers) {
    const auto first = items_.begin() + static_cast<std::ptrdiff_t>(begin),
               last = items_.begin() + static_cast<std::ptrdiff_t>(end);
    Split best;
    const Binning binning(centers);
    if (depth < kHeuristicDepth) {
      Bins bins[3];
      for (auto i = first; i != last; ++i) {
        for (int a = 0; a < 3; ++a) {
          const int b = binning.of(*i, a);
          ++bins[a].count[b];
          bins[a].box[b].add(i->low, i->high);
        }
      }
      for (int a = 0; a < 3; ++a) considerSplits(bins[a], a, best);
    }
    if (best.axis < 0) return begin + (end - begin) / 2;
    const auto goesLeft = [&](const Item& i) { return binning.of(i, best.axis) <= best.bin; };
    return begin + static_cast<std::size_t>(std::partition(first, last, goesLeft) - first);
  }

  // The largest descendants, at most 16.
  static std::vector<const Branch*> childrenOf(const Branch& parent) {
    std::vector<const Branch*> children{&parent};
    while (children.size() < 16) {
      std::size_t best = children.size();
      for (std::size_t i = 0; i < children.size(); ++i) {
        if (!children[i]->left) continue;
        if (best == children.size() || children[i]->box.area() > children[best]->box.area()) best = i;
      }
      if (best == children.size()) break;
      const Branch* opened = children[best];
      children[best] = opened->left.get();
      children.push_back(opened->right.get());
    }
    return children;
  }

  std::int32_t addNode(const Branch& parent) {
    const std::size_t at = tree_.nodes.size();
    tree_.nodes.emplace_back();
    const std::vector<const Branch*> children = childrenOf(parent);
    for (std::size_t i = 0; i < 16; ++i) {
      const Box box = i < children.size() ? children[i]->box : Box{};
      for (int k = 0; k < 3; ++k) {
        tree_.nodes[at].bound[k][i] = box.low[k];
        tree_.nodes[at].bound[3 + k][i] = box.high[k];
      }
      if (i >= children.size()) continue;
      children_.push_back({at, i, children[i]->begin, children[i]->end});
      const std::int32_t child = children[i]->left ? addNode(*children[i]) : addLeaf(*children[i]);
      tree_.nodes[at].child[i] = child;
    }
    return static_cast<std::int32_t>(at);
  }

  std::int32_t addLeaf(const Branch& leaf) {
    const std::size_t first = tree_.blocks.size();
    for (std::size_t begin = leaf.begin; begin < leaf.end; begin += 16) {
      tree_.blocks.emplace_back();
      SplatBlock& block = tree_.blocks.back();
      std::fill_n(block.cut2, 16, -1.0f);
      for (std::size_t i = begin; i < std::min(begin + 16, leaf.end); ++i) {
        const RaySplat& s = splats_[items_[i].splat];
        const std::size_t lane = i - begin;
        for (int k = 0; k < 9; ++k) block.canonical[k][lane] = s.canonical[k];
        for (int k = 0; k < 3; ++k) block.center[k][lane] = s.center[k];
        block.opacity[lane] = s.opacity;
        block.cut2[lane] = s.cut2;
      }
    }
    return ~static_cast<std::int32_t>(2 * first + (tree_.blocks.size() - first - 1));
  }

  // Rows of the canonical transform are axis / sigma.
  static vec3 rowOf(const RaySplat& s, int k) {
    return {s.canonical[3 * k], s.canonical[3 * k + 1], s.canonical[3 * k + 2]};
  }
  static vec3 thinAxis(const RaySplat& s) {
    vec3 thin = rowOf(s, 0);
    for (int k = 1; k < 3; ++k) {
      if (const vec3 row = rowOf(s, k); glm::dot(row, row) > glm::dot(thin, thin)) thin = row;
    }
    return glm::normalize(thin);
  }

  void fillSlab(std::size_t index) {
    const Child& c = children_[index];
    vec3 axis(0);
    for (std::size_t i = c.begin; i < c.end; ++i) {
      const vec3 thin = thinAxis(splats_[items_[i].splat]);
      axis += glm::dot(axis, thin) < 0 ? -thin : thin;
    }
    axis = glm::normalize(axis);
    float low = kInfinity, high = -kInfinity;
    for (std::size_t i = c.begin; i < c.end; ++i) {
      const RaySplat& s = splats_[items_[i].splat];
      float variance = 0;
      for (int k = 0; k < 3; ++k) {
        const vec3 row = rowOf(s, k);
        const float along = glm::dot(row, axis) / glm::dot(row, row);  // sigma (axis . own axis)
        variance += along * along;
      }
      const float reach = std::sqrt(variance * s.cut2) + s.margin_m, at = glm::dot(s.center, axis);
      low = std::min(low, at - reach);
      high = std::max(high, at + reach);
    }
    SplatNode& node = tree_.nodes[c.node];
    for (int k = 0; k < 3; ++k) node.axis[k][c.lane] = axis[k];
    node.axis_low[c.lane] = low;
    node.axis_high[c.lane] = high;
  }

  struct Child {
    std::size_t node, lane, begin, end;
  };
  const std::vector<RaySplat>& splats_;
  std::vector<Item> items_;
  std::vector<Child> children_;
  SplatBvh tree_;
};

}  // namespace

SplatBvh buildSplatBvh(const std::vector<RaySplat>& splats) { return Builder(splats).build(); }

}  // namespace beam
