// SPDX-License-Identifier: Apache-2.0
// Builds the tree of splat_bvh.h: binary splits by the surface area heuristic in 16 bins, then every node
// takes in its largest descendants until it has 16 children; the refit lays boxes and slabs around them. The
// tree does not depend on the number of threads.
#include <algorithm>
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
    tree_.nodes.shrink_to_fit();
    tree_.blocks.resize(tree_.splat.size() / 16);
    tree_.splats = splats_.size();
    refitSplatBvh(tree_, splats_);
    tree_.built_cost = costOf(tree_);
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
    for (std::size_t i = 0; i < children.size(); ++i) {
      const std::int32_t child = children[i]->left ? addNode(*children[i]) : addLeaf(*children[i]);
      tree_.nodes[at].child[i] = child;
    }
    return static_cast<std::int32_t>(at);
  }

  std::int32_t addLeaf(const Branch& leaf) {
    const std::size_t first = tree_.splat.size() / 16, blocks = (leaf.end - leaf.begin + 15) / 16;
    tree_.splat.resize(16 * (first + blocks), kNoSplat);
    for (std::size_t i = leaf.begin; i < leaf.end; ++i)
      tree_.splat[16 * first + (i - leaf.begin)] = items_[i].splat;
    return ~static_cast<std::int32_t>(2 * first + (blocks - 1));
  }

  const std::vector<RaySplat>& splats_;
  std::vector<Item> items_;
  SplatBvh tree_;
};

}  // namespace

SplatBvh buildSplatBvh(const std::vector<RaySplat>& splats) { return Builder(splats).build(); }

}  // namespace beam
