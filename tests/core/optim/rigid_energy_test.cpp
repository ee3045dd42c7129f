// SPDX-License-Identifier: Apache-2.0
// Laws of anchors and of the rigid energy (methods 3.2, 3.3).
#include "core/optim/rigid_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "tests/support/random_pose.h"

namespace beam {
namespace {

using testing::moved;
using testing::randomPose;

struct Case {
  Pose before = randomPose(40, 0.1f, 3), now;
  Anchors graph = neighborGraph(before.position_m, 8, 0.02f);
  AnchorLists lists = listsOf(graph, before.size());

  double energy(PoseGradient& gradient, float weight = 1) const {
    return rigidEnergy(graph, lists, before, now, weight, gradient);
  }
  double energy() const {
    PoseGradient ignored(now.size());
    return energy(ignored);
  }
};

TEST(Anchors, WeighTheNearestMostAndSumToOne) {
  const Pose a = randomPose(50, 0.3f, 1), b = randomPose(30, 0.3f, 2);
  const Anchors anchors = anchorTo(a.position_m, b.position_m, 8, 0.02f);
  ASSERT_EQ(anchors.points(), 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    float sum = 0;
    for (int k = 0; k < 8; ++k) {
      const std::size_t s = i * 8 + k;
      sum += anchors.weight[s];
      if (k > 0) {
        EXPECT_LE(anchors.weight[s], anchors.weight[s - 1]);
      }
    }
    EXPECT_NEAR(sum, 1, 1e-6);
  }
}

TEST(Anchors, HoldAPointThatLiesFarFromEveryTarget) {
  const std::vector<vec3> far = {vec3(5, 0, 0)};
  const Anchors anchors = anchorTo(far, randomPose(30, 0.1f, 2).position_m, 8, 0.02f);
  for (const float w : anchors.weight) EXPECT_TRUE(std::isfinite(w));
  EXPECT_GT(anchors.weight[0], 0.1f);
}

TEST(Anchors, TakeWhatThereIsAndRefuseNothing) {
  const std::vector<vec3> two = {vec3(0), vec3(0.01f, 0, 0)};
  EXPECT_EQ(neighborGraph(two, 8, 0.02f).per_point, 1);
  EXPECT_EQ(neighborGraph(two, 8, 0.02f).target[0], 1u);
  const auto refusal = [](auto&& call) -> std::string {
    try {
      call();
    } catch (const Error& e) {
      return e.what();
    }
    return {};
  };
  EXPECT_NE(refusal([] { neighborGraph(std::vector<vec3>{vec3(0)}, 8, 0.02f); }).find("found 1"),
            std::string::npos);
  EXPECT_NE(refusal([&] { anchorTo(two, {}, 8, 0.02f); }).find("2 Gaussians"), std::string::npos);
}

TEST(Anchors, ReachPastCopiesAtOnePlace) {
  // A row of places, five points at each: without a distance apart every point would hang on its copies.
  std::vector<vec3> points;
  for (int place = 0; place < 10; ++place) {
    for (int copy = 0; copy < 5; ++copy) points.push_back({0.02f * place, 1e-5f * copy, 0});
  }
  const auto placesOf = [&](const Anchors& graph, std::size_t i) {
    std::set<int> places;
    for (int k = 0; k < 2; ++k) places.insert(static_cast<int>(graph.target[i * 2 + k]) / 5);
    return places;
  };
  const Anchors crowded = neighborGraph(points, 2, 0.02f), spread = neighborGraph(points, 2, 0.02f, 0.01f);
  for (std::size_t i = 5; i < points.size() - 5; ++i) {
    const int own = static_cast<int>(i) / 5;
    EXPECT_EQ(placesOf(crowded, i), std::set<int>{own}) << i;
    EXPECT_EQ(placesOf(spread, i), (std::set<int>{own - 1, own + 1})) << i;
    EXPECT_NEAR(spread.weight[i * 2] + spread.weight[i * 2 + 1], 1, 1e-6);
  }
}

TEST(Anchors, AreFoundAgainFromTheirTargets) {
  const Case c;
  std::vector<int> seen(c.graph.target.size(), 0);
  for (std::uint32_t j = 0; j < c.before.size(); ++j) {
    for (std::uint32_t l = c.lists.first[j]; l < c.lists.first[j + 1]; ++l) {
      EXPECT_EQ(c.graph.target[c.lists.slot[l]], j);
      ++seen[c.lists.slot[l]];
    }
  }
  for (const int n : seen) EXPECT_EQ(n, 1);
}

TEST(RigidEnergy, IsZeroForARigidMotion) {
  Case c;
  c.now = moved(c.before, glm::angleAxis(2.9f, glm::normalize(vec3(1, 2, -1))), vec3(0.3f, -0.2f, 1));
  EXPECT_LT(c.energy(), 1e-11);
}

TEST(RigidEnergy, GrowsWithTheSquareOfAStretch) {
  Case c;
  const auto stretched = [&](float by) {
    c.now = c.before;
    for (vec3& x : c.now.position_m) x *= 1 + by;
    return c.energy();
  };
  EXPECT_NEAR(stretched(0.02f) / stretched(0.01f), 4, 1e-3);
}

TEST(RigidEnergy, HasTheGradientOfItsDifferences) {
  Case c;
  c.now = moved(c.before, glm::angleAxis(0.6f, vec3(0, 1, 0)), vec3(0.02f));
  const Pose noise = randomPose(c.now.size(), 0.02f, 9);
  for (std::size_t i = 0; i < c.now.size(); ++i) {
    c.now.position_m[i] += noise.position_m[i];
    c.now.rotation[i] = 1.3f * glm::slerp(c.now.rotation[i], noise.rotation[i], 0.1f);
  }
  PoseGradient gradient(c.now.size());
  c.energy(gradient, 0.5f);
  double largest = 0, worst = 0;
  testing::forEachNumber(c.now, gradient, [&](float& number, float analytic) {
    const float keep = number, h = 1e-3f;
    number = keep + h;
    const double up = c.energy();
    number = keep - h;
    const double down = c.energy();
    number = keep;
    const double numeric = 0.5 * (up - down) / (2.0 * h);
    largest = std::max(largest, std::abs(numeric));
    worst = std::max(worst, std::abs(numeric - analytic));
  });
  EXPECT_LT(worst, 2e-4 * largest);
}

TEST(RigidEnergy, GivesTheSameBitsForAnyNumberOfThreads) {
  Case c;
  c.before = randomPose(5000, 0.5f, 4);
  c.now = randomPose(5000, 0.5f, 5);
  c.graph = neighborGraph(c.before.position_m, 8, 0.02f);
  c.lists = listsOf(c.graph, c.before.size());
  PoseGradient one(5000), two(5000);
  setThreadCount(1);
  const double a = c.energy(one);
  setThreadCount(2);
  const double b = c.energy(two);
  setThreadCount(0);
  EXPECT_EQ(a, b);
  EXPECT_EQ(one.position, two.position);
  EXPECT_EQ(one.rotation, two.rotation);
}

}  // namespace
}  // namespace beam
