// SPDX-License-Identifier: Apache-2.0
#include "core/optim/rigid_energy.h"

#include "core/base/parallel.h"
#include "core/math/quaternion.h"

namespace beam {
namespace {

constexpr std::size_t kGrain = 1024;

}  // namespace

double rigidEnergy(const Anchors& graph, const AnchorLists& lists, const Pose& before, const Pose& now,
                   float weight, PoseGradient& gradient) {
  const auto per_point = static_cast<std::size_t>(graph.per_point);
  std::vector<vec3> pull(graph.target.size());  // 2 w e of every pair
  const double energy = parallelReduce(
      now.size(), kGrain, 0.0,
      [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) {
          const quat old = glm::normalize(before.rotation[i]);
          const quat turn = glm::normalize(now.rotation[i]) * glm::conjugate(old);
          vec4 d_turn(0);
          vec3 total(0);
          for (std::size_t s = i * per_point; s < (i + 1) * per_point; ++s) {
            const std::uint32_t k = graph.target[s];
            const vec3 was = before.position_m[i] - before.position_m[k];
            const vec3 e = turn * was - (now.position_m[i] - now.position_m[k]);
            sum += static_cast<double>(graph.weight[s]) * glm::dot(e, e);
            pull[s] = (2 * weight * graph.weight[s]) * e;
            total += pull[s];
            d_turn += rotatedGradient(turn, was, pull[s]);
          }
          gradient.position[i] -= total;
          gradient.rotation[i] +=
              throughNormalize(now.rotation[i], throughRightProduct(d_turn, glm::conjugate(old)));
        }
        return sum;
      },
      [](double a, double b) { return a + b; });
  parallelFor(now.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      for (std::uint32_t l = lists.first[k]; l < lists.first[k + 1]; ++l) {
        gradient.position[k] += pull[lists.slot[l]];
      }
    }
  });
  return energy;
}

}  // namespace beam
