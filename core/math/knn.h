// SPDX-License-Identifier: Apache-2.0
// k-d tree over points; k nearest neighbours by Euclidean distance, ties by index. Safe to query from many
// threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/types.h"

namespace beam {

struct Neighbor {
  float squared_distance = 0;
  std::uint32_t index = 0;  // in the points the tree was built from
};

class KdTree {
 public:
  explicit KdTree(std::span<const vec3> points);  // keeps a copy

  // At most k neighbours, nearest first.
  std::vector<Neighbor> nearest(vec3 query, int k) const;

 private:
  struct Node {
    std::uint32_t begin = 0, end = 0;  // of order_
    std::uint32_t right = 0;           // 0: a leaf; the left child follows its parent
    int axis = 0;
    float split = 0;
  };
  void build(std::uint32_t begin, std::uint32_t end);
  void search(std::uint32_t node, vec3 query, std::size_t k, std::vector<Neighbor>& heap) const;

  std::vector<vec3> points_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace beam
