// SPDX-License-Identifier: Apache-2.0
#include "tests/support/capsule_man.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace beam::testing {
namespace {

constexpr float kTurn = 6.2831853f;

// PCG32 (O'Neill 2014): a sequence, so that the cloud is the one of the yardstick programs.
class Sequence {
 public:
  explicit Sequence(std::uint64_t seed) : state_(seed * kStep + kIncrement) {}
  std::uint32_t bits() {
    const std::uint64_t old = state_;
    state_ = old * kStep + kIncrement;
    const auto x = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto turn = static_cast<std::uint32_t>(old >> 59);
    return (x >> turn) | (x << ((32 - turn) & 31));
  }
  float uniform() { return static_cast<float>(bits() >> 8) * (1 / 16777216.0f); }
  float normal() {
    const float radius = std::sqrt(-2 * std::log(uniform() + 1e-7f));
    return radius * std::cos(kTurn * uniform());
  }

 private:
  static constexpr std::uint64_t kStep = 6364136223846793005ull, kIncrement = 1442695040888963407ull;
  std::uint64_t state_;
};

struct Capsule {
  vec3 a, b;
  float radius;
};

constexpr int kParts = 15;
const Capsule kMan[kParts] = {{{0, 1.62f, 0}, {0, 1.66f, 0}, 0.10f},           // head
                              {{0, 1.45f, 0}, {0, 1.55f, 0}, 0.055f},          // neck
                              {{0, 1.00f, 0}, {0, 1.33f, 0}, 0.15f},           // trunk
                              {{-0.12f, 1.38f, 0}, {0.12f, 1.38f, 0}, 0.08f},  // shoulders
                              {{-0.09f, 0.93f, 0}, {0.09f, 0.93f, 0}, 0.10f},  // hips
                              {{0.20f, 1.38f, 0}, {0.42f, 1.16f, 0.03f}, 0.048f},
                              {{0.42f, 1.16f, 0.03f}, {0.56f, 0.97f, 0.14f}, 0.038f},
                              {{-0.20f, 1.38f, 0}, {-0.42f, 1.16f, 0.03f}, 0.048f},
                              {{-0.42f, 1.16f, 0.03f}, {-0.30f, 1.05f, 0.22f}, 0.038f},
                              {{0.10f, 0.90f, 0}, {0.13f, 0.50f, 0.02f}, 0.075f},
                              {{0.13f, 0.50f, 0.02f}, {0.14f, 0.09f, -0.02f}, 0.052f},
                              {{-0.10f, 0.90f, 0}, {-0.13f, 0.50f, 0.06f}, 0.075f},
                              {{-0.13f, 0.50f, 0.06f}, {-0.14f, 0.09f, -0.02f}, 0.052f},
                              {{0.14f, 0.05f, -0.03f}, {0.15f, 0.05f, 0.15f}, 0.045f},
                              {{-0.14f, 0.05f, -0.03f}, {-0.15f, 0.05f, 0.15f}, 0.045f}};

float distanceTo(const Capsule& c, vec3 p) {
  const vec3 axis = c.b - c.a;
  const float t = std::clamp(glm::dot(p - c.a, axis) / glm::dot(axis, axis), 0.0f, 1.0f);
  return glm::length(p - (c.a + t * axis)) - c.radius;
}

void tangents(vec3 n, vec3& t, vec3& b) {
  t = glm::normalize(glm::cross(n, std::abs(n.x) > 0.7f ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  b = glm::cross(n, t);
}

CapsulePoint pointOn(int part, Sequence& random) {
  const Capsule& c = kMan[part];
  const vec3 axis = c.b - c.a;
  const float length = glm::length(axis), side = kTurn * c.radius * length,
              caps = 2 * kTurn * c.radius * c.radius;
  vec3 t, b;
  const vec3 z = axis / length;
  tangents(z, t, b);
  const float phi = kTurn * random.uniform();
  if (random.uniform() * (side + caps) < side) {
    const vec3 n = t * std::cos(phi) + b * std::sin(phi);
    return {c.a + axis * random.uniform() + n * c.radius, n, part};
  }
  const float up = 2 * random.uniform() - 1, out = std::sqrt(1 - up * up);
  const vec3 n = t * (out * std::cos(phi)) + b * (out * std::sin(phi)) + z * up;
  return {(up > 0 ? c.b : c.a) + n * c.radius, n, part};
}

// A pattern of coloured blobs, so that an optimiser has something to fit.
vec3 colorAt(const CapsulePoint& s) {
  const vec3 p = s.position;
  const float k = static_cast<float>(s.part) * 0.7f;
  return vec3(0.5f) + 0.4f * vec3(std::sin(9 * p.y + k) * std::cos(30 * p.x),
                                  std::sin(17 * p.y + 21 * p.x + 2 * k), std::cos(25 * p.z + 11 * p.y - k));
}

}  // namespace

std::vector<CapsulePoint> capsulePoints(std::size_t count, std::uint64_t seed) {
  float area[kParts], sum = 0;
  for (int k = 0; k < kParts; ++k) {
    const Capsule& c = kMan[k];
    area[k] = sum += kTurn * c.radius * (glm::length(c.b - c.a) + 2 * c.radius);
  }
  Sequence random(seed);
  std::vector<CapsulePoint> points;
  while (points.size() < count) {
    const float at = random.uniform() * sum;
    const int part = static_cast<int>(std::lower_bound(area, area + kParts - 1, at) - area);
    const CapsulePoint p = pointOn(part, random);
    const auto holds = [&](const Capsule& c) { return &c != &kMan[part] && distanceTo(c, p.position) < 0; };
    if (std::none_of(kMan, kMan + kParts, holds)) points.push_back(p);
  }
  return points;
}

GaussianCloud capsuleCloud(std::size_t count, float sigma_m) {
  constexpr std::uint64_t kSeed = 7;
  Sequence random(kSeed + 99), noise(5);
  const float grow = std::sqrt(140000.0f / static_cast<float>(count));
  const auto spread = [&](float size_m) { return size_m * std::exp(0.25f * random.normal()); };
  GaussianCloud cloud;
  cloud.color = ShBlock(count, 3);
  for (const CapsulePoint& s : capsulePoints(count, kSeed)) {
    vec3 jitter, t, b;
    for (int k = 0; k < 3; ++k) jitter[k] = random.normal();
    const vec3 n = glm::normalize(s.normal + 0.12f * jitter);
    tangents(n, t, b);
    const float turn = kTurn * random.uniform();
    const vec3 first = t * std::cos(turn) + b * std::sin(turn);
    vec3 scale;
    for (int k = 0; k < 3; ++k) scale[k] = spread(k < 2 ? sigma_m * grow : sigma_m / 6);
    float* sh = cloud.color.of(cloud.size());
    const vec3 color = colorAt(s);
    for (int c = 0; c < 3; ++c) sh[c] = (color[c] - 0.5f) / kShC0;
    for (int k = 3; k < 3 * kShCount; ++k) sh[k] = 0.01f * noise.normal();
    cloud.position_m.push_back(s.position);
    cloud.rotation.push_back(glm::normalize(glm::quat_cast(mat3(first, glm::cross(n, first), n))));
    cloud.scale_m.push_back(scale);
    cloud.opacity.push_back(0.5f + 0.49f * random.uniform());
  }
  return cloud;
}

Camera capsuleCamera(int width, int height) {
  Camera c;
  c.width = width;
  c.height = height;
  const double focal = 0.85 * height * 3 / 1.75;
  c.intrinsics = {focal, focal, 0.5 * width, 0.5 * height};
  c.camera_from_world.rotation = dquat(0, 1, 0, 0);  // half a turn about X: +Y down, +Z towards the figure
  c.camera_from_world.translation_m = dvec3(0, 0.88, 3);
  return c;
}

std::vector<Ray> capsuleRays(std::size_t points, int rays_per_point, float offset_m) {
  Sequence random(11);
  std::vector<Ray> rays;
  for (const CapsulePoint& s : capsulePoints(points, 123)) {
    vec3 t, b;
    tangents(s.normal, t, b);
    for (int i = 0; i < rays_per_point; ++i) {
      const float u = random.uniform(), phi = kTurn * random.uniform(), out = std::sqrt(u);
      rays.push_back({s.position + offset_m * s.normal,
                      glm::normalize(t * (out * std::cos(phi)) + b * (out * std::sin(phi)) +
                                     s.normal * std::sqrt(1 - u))});
    }
  }
  return rays;
}

}  // namespace beam::testing
