// SPDX-License-Identifier: Apache-2.0
#include "core/method/light_integrals.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/image/filter.h"
#include "core/math/brdf.h"
#include "core/math/color.h"
#include "core/math/sampling.h"
#include "core/scene/frame_views.h"

namespace beam {
namespace {

constexpr std::size_t kPiece = 64;      // points whose rays are traced in one call
constexpr std::size_t kBand = 64 * 64;  // points between two looks at the progress: well under 0.5 s
constexpr float kEven_m = 0.01f;        // radius over which the depth of ray origins is evened out
constexpr float kMinRoughness = 0.1f;   // narrower lobes are noise at this number of rays (methods 5.4)

// What one ray brings if it is free: f / (sum of N p), the balance heuristic of all strategies (Veach 1995).
struct Contribution {
  vec3 diffuse, specular;
  float sky;
  std::uint32_t point;  // of the piece
  std::uint32_t half;
};

struct Piece {
  std::vector<Ray> rays;
  std::vector<Contribution> contributions;
  std::vector<std::uint8_t> blocked;
};

class Sampler {
 public:
  Sampler(const LightSampling& sampling, const EnvironmentSampler& environment)
      : s_(sampling),
        environment_(environment),
        alpha_(ggxAlpha(std::max(sampling.roughness, kMinRoughness))) {}

  void addRays(const SurfacePoint& p, std::uint32_t point, Piece& piece) const {
    const Frame3 frame(p.normal);
    const vec3 eye = frame.toLocal(p.to_eye);
    const RandomStream turn(s_.seed, p.x / 4, p.y / 4);
    for (int i = 0; i < s_.cosine; ++i) {
      const vec3 d = frame.toWorld(cosineDirection(drawn(p, turn, 0, s_.cosine, i)));
      add(p, environment_.at(d), point, i, piece);
    }
    for (int i = 0; i < s_.environment; ++i) {
      const vec2 u = drawn(p, turn, 1, s_.environment, i);
      add(p, environment_.sample(u.x, u.y), point, i, piece);
    }
    for (int i = 0; i < s_.specular; ++i) {
      const vec3 h = visibleNormal(eye, alpha_, drawn(p, turn, 2, s_.specular, i));
      const vec3 d = frame.toWorld(2 * glm::dot(eye, h) * h - eye);
      add(p, environment_.at(glm::normalize(d)), point, i, piece);
    }
  }

 private:
  // Pixels of a 4x4 block take consecutive runs of one sequence in Morton order, so that a small filter sees
  // an even set of 16 times as many points.
  vec2 drawn(const SurfacePoint& p, const RandomStream& turn, std::uint32_t strategy, int count,
             int i) const {
    const std::uint32_t x = p.x & 3, y = p.y & 3;
    const std::uint32_t run = (x & 1) | (y & 1) << 1 | (x & 2) << 1 | (y & 2) << 2;
    const std::uint64_t bits = turn.bits(strategy);
    const R2Sequence sequence{static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)};
    return sequence(run * static_cast<std::uint32_t>(count) + static_cast<std::uint32_t>(i));
  }

  void add(const SurfacePoint& p, const EnvironmentSampler::Sample& light, std::uint32_t point, int i,
           Piece& piece) const {
    const float cosine = glm::dot(p.normal, light.direction);
    if (cosine <= 0) return;  // below the shading horizon: nothing
    const Reflectance r = reflectance(p.normal, light.direction, p.to_eye, alpha_);
    const float density =
        s_.cosine * cosine / kPi + s_.environment * light.pdf + s_.specular * r.reflection_pdf;
    const float weight = cosine / density;
    piece.rays.push_back({p.position_m + s_.offset_m * p.normal, light.direction});
    piece.contributions.push_back({(1 - r.fresnel) / kPi * weight * light.radiance,
                                   r.specular * weight * light.radiance, weight / kPi, point,
                                   static_cast<std::uint32_t>(i & 1)});
  }

  const LightSampling& s_;
  const EnvironmentSampler& environment_;
  float alpha_;
};

// Sums of a half set of rays, in their order.
struct HalfSum {
  vec3 diffuse = vec3(0), specular = vec3(0);
  float sky = 0, open_sky = 0;  // with and without occlusion; the latter is known to be 1/2
};

// A as the ratio of two estimates from the same rays: exact where nothing occludes, and less noisy elsewhere
// than either the plain MIS sum or the mean over the cosine rays.
float skyRatio(float sky, float open_sky) { return open_sky > 0 ? std::min(sky / open_sky, 1.0f) : 0.0f; }

LightIntegrals joined(const std::array<HalfSum, 2>& h) {
  const HalfSum &a = h[0], &b = h[1];
  const auto spread = [](float x, float y) { return 0.25f * (x - y) * (x - y); };
  LightIntegrals out{a.diffuse + b.diffuse, a.specular + b.specular,
                     skyRatio(a.sky + b.sky, a.open_sky + b.open_sky), vec3(0)};
  out.variance = {spread(2 * luminance(a.diffuse), 2 * luminance(b.diffuse)),
                  spread(2 * luminance(a.specular), 2 * luminance(b.specular)),
                  spread(skyRatio(a.sky, a.open_sky), skyRatio(b.sky, b.open_sky))};
  return out;
}

void integratePiece(std::span<const SurfacePoint> points, const Sampler& sampler, const Tracer& tracer,
                    std::span<LightIntegrals> out) {
  Piece piece;
  for (std::size_t i = 0; i < points.size(); ++i)
    sampler.addRays(points[i], static_cast<std::uint32_t>(i), piece);
  piece.blocked.resize(piece.rays.size());
  tracer.occluded(piece.rays, piece.blocked);
  std::array<std::array<HalfSum, 2>, kPiece> sums;
  for (std::size_t r = 0; r < piece.rays.size(); ++r) {
    const Contribution& c = piece.contributions[r];
    HalfSum& sum = sums[c.point][c.half];
    sum.open_sky += c.sky;
    if (piece.blocked[r]) continue;
    sum.diffuse += c.diffuse;
    sum.specular += c.specular;
    sum.sky += c.sky;
  }
  for (std::size_t i = 0; i < points.size(); ++i) out[i] = joined(sums[i]);
}

}  // namespace

std::vector<SurfacePoint> surfacePoints(const GBuffer& g, const Camera& camera,
                                        const Image<std::uint8_t>& mask) {
  const Image<std::uint8_t> edges = depthEdges(g.depth_m, g.alpha);
  const Rigid3 world_from_camera = inverse(camera.camera_from_world);
  std::vector<SurfacePoint> points;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      if (edges(x, y) || !(g.alpha(x, y) > 0.9f) || (!mask.empty() && mask(x, y) < kInside)) continue;
      const dvec3 ray = rayOf(camera.intrinsics, {x + 0.5, y + 0.5});
      const vec3 to_eye(glm::normalize(world_from_camera.rotation * -ray));
      if (!(glm::dot(g.normal_world(x, y), to_eye) > 0.05f)) continue;
      // The median depth steps from Gaussian to Gaussian by more than the ray offset; a point in a step's
      // foot would be shadowed by its own surface.
      const double pixels = kEven_m * camera.intrinsics.fx / g.depth_m(x, y);
      const int radius = static_cast<int>(std::clamp(std::lround(pixels), 1l, 8l));
      const double depth = evenDepth({g.depth_m, g.alpha, g.normal_world}, x, y, radius);
      const vec3 position(world_from_camera * (ray * depth));
      points.push_back({x, y, position, g.normal_world(x, y), to_eye});
    }
  }
  return points;
}

std::vector<LightIntegrals> integrateLight(std::span<const SurfacePoint> points,
                                           const LightSampling& sampling,
                                           const EnvironmentSampler& environment, const Tracer& tracer,
                                           Progress& progress) {
  const Sampler sampler(sampling, environment);
  std::vector<LightIntegrals> integrals(points.size());
  const std::span<LightIntegrals> out(integrals);
  for (std::size_t band = 0; band < points.size(); band += kBand) {
    const std::size_t count = std::min(kBand, points.size() - band);
    parallelFor(count, kPiece, [&](std::size_t begin, std::size_t end) {
      if (progress.stopRequested()) return;
      integratePiece(points.subspan(band + begin, end - begin), sampler, tracer,
                     out.subspan(band + begin, end - begin));
    });
    progress.step(static_cast<std::int64_t>(count));
  }
  return integrals;
}

}  // namespace beam
