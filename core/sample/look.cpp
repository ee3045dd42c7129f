// SPDX-License-Identifier: Apache-2.0
#include "core/sample/look.h"

#include <cmath>
#include <string>
#include <vector>

#include "core/base/rng.h"

namespace beam {
namespace {

constexpr int kWidth = 256, kHeight = 128;

float latticeValue(int x, int y, int z) { return RandomStream(11, x, y, z).uniform(0); }

// Value noise in [0, 1], one octave.
float noise(vec3 p) {
  const vec3 f = glm::floor(p), t = p - f, s = t * t * (3.0f - 2.0f * t);
  const ivec3 i(f);
  float sum = 0;
  for (int k = 0; k < 8; ++k) {
    const ivec3 c(k & 1, (k >> 1) & 1, k >> 2);
    const vec3 w = glm::mix(1.0f - s, s, vec3(c));
    sum += w.x * w.y * w.z * latticeValue(i.x + c.x, i.y + c.y, i.z + c.z);
  }
  return sum;
}

float stripe(float x, float period, float share) {
  const float t = x / period - std::floor(x / period);
  const float edge = 0.08f;
  return glm::smoothstep(0.0f, edge, t) * (1 - glm::smoothstep(share, share + edge, t));
}

FigureLook shirt(vec3 r) {
  const float u = std::atan2(r.x, -r.y) * 0.16f + 0.35f * r.x, v = r.z;
  const float wide = 0.5f * (stripe(u, 0.058f, 0.45f) + stripe(v, 0.058f, 0.45f));
  const float thin = std::max(stripe(u + 0.012f, 0.058f, 0.07f), stripe(v + 0.012f, 0.058f, 0.07f));
  vec3 c = glm::mix(vec3(0.42f, 0.055f, 0.05f), vec3(0.05f, 0.06f, 0.20f), wide);
  c = glm::mix(c, vec3(0.70f, 0.62f, 0.40f), 0.8f * thin);
  return {c * (0.88f + 0.24f * noise(r * 160.0f)), 0.85f};
}

FigureLook jeans(vec3 r) {
  const float worn = glm::smoothstep(0.45f, 0.75f, noise(r * vec3(16, 16, 7))), weave = noise(r * 260.0f);
  const float seam = stripe(r.y + 0.004f, 10.0f, 0.0008f);
  vec3 c = glm::mix(vec3(0.045f, 0.085f, 0.21f), vec3(0.19f, 0.27f, 0.45f), worn);
  c = glm::mix(c, vec3(0.35f, 0.20f, 0.07f), 0.7f * seam);
  return {c * (0.85f + 0.3f * weave), 0.8f};
}

FigureLook skin(vec3 r) {
  const float flush = glm::smoothstep(1.56f, 1.60f, r.z) * (1 - glm::smoothstep(1.61f, 1.65f, r.z));
  vec3 c = glm::mix(vec3(0.46f, 0.25f, 0.165f), vec3(0.52f, 0.23f, 0.16f), 0.5f * flush);
  if (r.z > 1.655f && r.z < 1.666f && r.y < -0.05f && std::abs(std::abs(r.x) - 0.033f) < 0.02f)
    c *= 0.35f;  // brows
  return {c * (0.97f + 0.06f * noise(r * 40.0f)), 0.45f};
}

FigureLook eye(vec3 r) {
  const vec2 d(std::abs(r.x) - 0.033f, r.z - 1.642f);
  const float radius = glm::length(d);
  if (radius < 0.0028f) return {vec3(0.01f), 0.2f};
  if (radius < 0.006f) return {vec3(0.06f, 0.13f, 0.10f), 0.2f};
  return {vec3(0.72f, 0.70f, 0.67f), 0.2f};
}

struct Lamp {
  vec3 direction;
  float cosine, softness;
  vec3 radiance;
};

Environment lit(vec3 sky, vec3 horizon, vec3 floor, const std::vector<Lamp>& lamps) {
  Image<vec3> image(kWidth, kHeight, vec3(0), Encoding::Linear);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const vec3 d = directionFromLatLong({(x + 0.5f) / kWidth, (y + 0.5f) / kHeight});
      vec3 c = d.y > 0 ? glm::mix(horizon, sky, std::sqrt(d.y))
                       : glm::mix(horizon, floor, std::min(1.0f, -4 * d.y));
      for (const Lamp& l : lamps) {
        const float t = glm::dot(d, glm::normalize(l.direction));
        c += l.radiance * glm::smoothstep(l.cosine - l.softness, l.cosine, t);
      }
      image(x, y) = c;
    }
  }
  return makeEnvironment(std::move(image));
}

}  // namespace

FigureLook lookOf(const FigurePoint& p) {
  const vec3 r = p.rest;
  switch (p.cloth) {
    case Cloth::Shirt:
      return shirt(r);
    case Cloth::Jeans:
      return jeans(r);
    case Cloth::Skin:
      return skin(r);
    case Cloth::Eye:
      return eye(r);
    case Cloth::Hair:
      return {vec3(0.055f, 0.032f, 0.02f) * (0.55f + 0.9f * noise(r * vec3(230, 230, 30))), 0.5f};
    case Cloth::Lip:
      return {vec3(0.42f, 0.13f, 0.11f), 0.4f};
    case Cloth::Shoe:
      return {glm::mix(vec3(0.60f), vec3(0.03f, 0.17f, 0.13f), stripe(r.y + r.z, 0.05f, 0.3f)), 0.3f};
    case Cloth::Sole:
      return {vec3(0.62f, 0.60f, 0.55f), 0.6f};
    case Cloth::Belt:
      return {vec3(0.07f, 0.035f, 0.02f), 0.4f};
  }
  return {};
}

// World axes: the performer faces -X, has the left hand at +Z.
Environment domeLight() {
  return lit(vec3(0.55f), vec3(0.42f), vec3(0.16f, 0.15f, 0.14f),
             {{{-0.8f, 0.6f, 0.5f}, 0.93f, 0.03f, vec3(5.5f, 5.2f, 4.8f)},
              {{-0.5f, 0.5f, -0.9f}, 0.95f, 0.03f, vec3(3.0f, 3.4f, 4.2f)},
              {{0.9f, 0.45f, 0.2f}, 0.95f, 0.03f, vec3(3.6f, 3.5f, 3.4f)},
              {{0.1f, 1.0f, 0.0f}, 0.94f, 0.03f, vec3(2.6f)}});
}

Environment namedLight(const std::string& name) {
  if (name == "studio") {
    return lit(vec3(0.10f), vec3(0.09f), vec3(0.05f),
               {{{-0.7f, 0.5f, 0.9f}, 0.9f, 0.05f, vec3(9, 8.6f, 8)},
                {{0.8f, 0.3f, -0.6f}, 0.96f, 0.02f, vec3(5, 6, 8)}});
  }
  return lit(vec3(0.18f, 0.28f, 0.55f), vec3(0.70f, 0.45f, 0.32f), vec3(0.12f, 0.10f, 0.08f),
             {{{0.55f, 0.25f, -0.8f}, 0.985f, 0.01f, vec3(60, 36, 18)}});
}

}  // namespace beam
