// SPDX-License-Identifier: Apache-2.0
#include "core/math/knn.h"

#include <algorithm>
#include <numeric>

namespace beam {
namespace {

constexpr std::uint32_t kLeafSize = 12;

bool nearer(const Neighbor& a, const Neighbor& b) {
  return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                  : a.index < b.index;
}

}  // namespace

KdTree::KdTree(std::span<const vec3> points) : points_(points.begin(), points.end()), order_(points.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (!points_.empty()) build(0, static_cast<std::uint32_t>(points_.size()));
}

void KdTree::build(std::uint32_t begin, std::uint32_t end) {
  const auto node = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({begin, end});
  if (end - begin <= kLeafSize) return;
  vec3 low = points_[order_[begin]], high = low;
  for (std::uint32_t i = begin; i < end; ++i) {
    low = glm::min(low, points_[order_[i]]);
    high = glm::max(high, points_[order_[i]]);
  }
  const vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return points_[a][axis] != points_[b][axis] ? points_[a][axis] < points_[b][axis]
                                                                 : a < b;
                   });
  nodes_[node].axis = axis;
  nodes_[node].split = points_[order_[middle]][axis];
  build(begin, middle);
  nodes_[node].right = static_cast<std::uint32_t>(nodes_.size());
  build(middle, end);
}

std::vector<Neighbor> KdTree::nearest(vec3 query, int k) const {
  std::vector<Neighbor> heap;
  heap.reserve(static_cast<std::size_t>(k) + 1);
  if (!nodes_.empty() && k > 0) search(0, query, static_cast<std::size_t>(k), heap);
  std::sort_heap(heap.begin(), heap.end(), nearer);
  return heap;
}

void KdTree::search(std::uint32_t index, vec3 query, std::size_t k, std::vector<Neighbor>& heap) const {
  const Node& node = nodes_[index];
  if (node.right == 0) {
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const vec3 d = points_[order_[i]] - query;
      const Neighbor candidate{glm::dot(d, d), order_[i]};
      if (heap.size() == k && !nearer(candidate, heap.front())) continue;
      heap.push_back(candidate);
      std::push_heap(heap.begin(), heap.end(), nearer);
      if (heap.size() > k) {
        std::pop_heap(heap.begin(), heap.end(), nearer);
        heap.pop_back();
      }
    }
    return;
  }
  const float offset = query[node.axis] - node.split;
  const std::uint32_t near = offset < 0 ? index + 1 : node.right, far = offset < 0 ? node.right : index + 1;
  search(near, query, k, heap);
  if (heap.size() < k || offset * offset <= heap.front().squared_distance) search(far, query, k, heap);
}

}  // namespace beam
