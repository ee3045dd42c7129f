// SPDX-License-Identifier: Apache-2.0
#include "core/optim/anchors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/knn.h"
#include "core/math/statistics.h"

namespace beam {
namespace {

constexpr std::size_t kGrain = 512;

constexpr std::size_t kCandidates = 8;  // as many times the count are looked at

// The first `count` of `near` that stand `apart_m` from each other and from `own`, then the nearest others;
// by distance.
std::vector<Neighbor> spreadOut(const std::vector<Neighbor>& near, std::span<const vec3> targets,
                                std::size_t count, const vec3* own, float apart_m) {
  std::vector<Neighbor> chosen, rest;
  for (const Neighbor& n : near) {
    const vec3& at = targets[n.index];
    const auto close = [&](const vec3& other) { return glm::length(other - at) < apart_m; };
    const bool crowded =
        (own && close(*own)) ||
        std::any_of(chosen.begin(), chosen.end(), [&](const auto& c) { return close(targets[c.index]); });
    (crowded || chosen.size() == count ? rest : chosen).push_back(n);
  }
  for (std::size_t k = 0; chosen.size() < count; ++k) chosen.push_back(rest[k]);
  std::stable_sort(chosen.begin(), chosen.end(), [](const Neighbor& a, const Neighbor& b) {
    return a.squared_distance < b.squared_distance;
  });
  return chosen;
}

// `skip`: leave the point itself out.
Anchors anchored(std::span<const vec3> points, std::span<const vec3> targets, int count, float length_m,
                 float apart_m, bool skip) {
  const KdTree tree(targets);
  const std::size_t own = skip ? 1 : 0;
  const std::size_t per_point = std::min<std::size_t>(count, targets.size() - own);
  const std::size_t seen = std::min(targets.size(), per_point * (apart_m > 0 ? kCandidates : 1) + own);
  Anchors a{static_cast<int>(per_point), std::vector<std::uint32_t>(points.size() * per_point),
            std::vector<float>(points.size() * per_point)};
  parallelFor(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::vector<Neighbor> near = tree.nearest(points[i], static_cast<int>(seen));
      if (skip) std::erase_if(near, [&](const Neighbor& n) { return n.index == i; });
      if (apart_m > 0) near = spreadOut(near, targets, per_point, skip ? &points[i] : nullptr, apart_m);
      double sum = 0;
      std::vector<double> weight(per_point);
      for (std::size_t k = 0; k < per_point; ++k) {
        const double excess = near[k].squared_distance - near[0].squared_distance;
        sum += weight[k] = std::exp(-excess / (static_cast<double>(length_m) * length_m));
      }
      for (std::size_t k = 0; k < per_point; ++k) {
        a.target[i * per_point + k] = near[k].index;
        a.weight[i * per_point + k] = static_cast<float>(weight[k] / sum);
      }
    }
  });
  return a;
}

}  // namespace

Anchors anchorTo(std::span<const vec3> points, std::span<const vec3> targets, int count, float length_m,
                 float apart_m) {
  if (targets.empty()) {
    throw Error(Error::Kind::Data,
                fmt::format("found no joint to hang {} Gaussians on; check the masks, then "
                            "raise track.joints and run Track again",
                            points.size()));
  }
  return anchored(points, targets, count, length_m, apart_m, false);
}

Anchors neighborGraph(std::span<const vec3> points, int count, float length_m, float apart_m) {
  if (points.size() < 2) {
    throw Error(Error::Kind::Data, fmt::format("a graph of neighbours needs two Gaussians or more, found {}; "
                                               "check masks and calibration, then raise surface.cap or "
                                               "track.joints",
                                               points.size()));
  }
  return anchored(points, points, count, length_m, apart_m, true);
}

double spacingOf(std::span<const vec3> points) {
  constexpr int kEighth = 8;
  const double on_lattice = std::sqrt(2.0);
  const KdTree tree(points);
  std::vector<float> distance(points.size());
  parallelFor(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      distance[i] = std::sqrt(tree.nearest(points[i], kEighth + 1).back().squared_distance);
  });
  return median(std::move(distance)) / on_lattice;
}

Anchors surfaceGraph(std::span<const vec3> points, double reach) {
  const double spacing = spacingOf(points);
  return neighborGraph(points, kSurfaceNeighbors, static_cast<float>(reach * spacing),
                       static_cast<float>(kNeighborsApart * spacing));
}

AnchorLists listsOf(const Anchors& anchors, std::size_t targets) {
  AnchorLists lists{std::vector<std::uint32_t>(targets + 1, 0),
                    std::vector<std::uint32_t>(anchors.target.size())};
  for (const std::uint32_t t : anchors.target) ++lists.first[t + 1];
  for (std::size_t j = 0; j < targets; ++j) lists.first[j + 1] += lists.first[j];
  std::vector<std::uint32_t> next(lists.first.begin(), lists.first.end() - 1);
  for (std::size_t s = 0; s < anchors.target.size(); ++s) {
    lists.slot[next[anchors.target[s]]++] = static_cast<std::uint32_t>(s);
  }
  return lists;
}

}  // namespace beam
