// SPDX-License-Identifier: Apache-2.0
#include "core/sample/path_tracer.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/render/path_integrator.h"
#include "core/render/triangle_tracer.h"
#include "core/sample/look.h"

namespace beam {
namespace {

constexpr std::size_t kRows = 4;
constexpr double kNear_m = 0.05;

}  // namespace

// Triangles with the looks of the figure.
struct SampleScene::State final : PathSurfaces {
  const Figure& figure;
  mat3 world_from_capture;
  std::vector<vec3> first;  // in the figure's pose, capture axes
  Mesh posed;               // world
  TriangleTracer tracer;
  std::vector<std::uint32_t> part_start;  // the figure's parts near each triangle
  std::vector<std::uint8_t> parts;

  State(const Figure& f, const Mesh& surface, const dmat3& turn)
      : figure(f),
        world_from_capture(turn),
        first(surface.vertices),
        posed(turned(surface)),
        tracer({&posed, 1}, TriangleEdges::Rounded) {
    findParts();
  }

  Mesh turned(const Mesh& surface) const {
    Mesh mesh = surface;
    for (vec3& v : mesh.vertices) v = world_from_capture * v;
    for (vec3& n : mesh.normals) n = world_from_capture * n;
    return mesh;
  }

  void pose(const Mesh& surface) {
    posed = turned(surface);
    tracer.move(0, posed.vertices);
  }

  void findParts() {
    part_start.assign(1, 0);
    for (const auto& t : posed.triangles) {
      const vec3 a = first[t[0]];
      const float size = std::max(glm::length(first[t[1]] - a), glm::length(first[t[2]] - a));
      const std::vector<std::uint8_t> near = figure.partsNear(a, size);
      parts.insert(parts.end(), near.begin(), near.end());
      part_start.push_back(static_cast<std::uint32_t>(parts.size()));
    }
  }

  // The look belongs to the body: of the same point in the figure's pose.
  FigureLook lookAt(unsigned triangle, float u, float v) const {
    const auto& t = posed.triangles[triangle];
    const vec3 x = (1 - u - v) * first[t[0]] + u * first[t[1]] + v * first[t[2]];
    return lookOf(
        figure.pointAt(x, {parts.data() + part_start[triangle], parts.data() + part_start[triangle + 1]}));
  }

  std::optional<PathHit> nearest(vec3 o, vec3 d, std::uint64_t = 0) const override {
    const std::optional<TriangleHit> hit = tracer.nearest(o, d, kFar_m);
    if (!hit) return {};
    const auto& t = posed.triangles[hit->triangle];
    const float u = hit->weights.x, v = hit->weights.y;
    const FigureLook look = lookAt(hit->triangle, u, v);
    const std::vector<vec3>& normals = posed.normals;
    return PathHit{
        .position_m = o + hit->distance_m * d,
        .normal = glm::normalize((1 - u - v) * normals[t[0]] + u * normals[t[1]] + v * normals[t[2]]),
        .distance_m = hit->distance_m,
        .base_color = look.base_color,
        .roughness = look.roughness};
  }

  float transmittance(vec3 o, vec3 d, float distance_m) const override {
    return tracer.occluded(o, d, distance_m) ? 0.0f : 1.0f;
  }

  struct CameraRays {
    Rigid3 world_from_camera;
    Intrinsics intrinsics;
    vec3 origin;
    explicit CameraRays(const Camera& c)
        : world_from_camera(inverse(c.camera_from_world)),
          intrinsics(c.intrinsics),
          origin(world_from_camera.translation_m) {}
    vec3 direction(dvec2 p) const {
      return vec3(glm::normalize(world_from_camera.rotation * rayOf(intrinsics, p)));
    }
  };

  // 1 where a triangle may be seen: pixels of its projected bounding box and one around.
  Image<std::uint8_t> mayCover(const Camera& camera) const {
    Image<std::uint8_t> out(camera.width, camera.height);
    std::vector<vec2> at(posed.vertices.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      const dvec3 x = camera.camera_from_world * dvec3(posed.vertices[i]);
      if (x.z < kNear_m) return Image<std::uint8_t>(camera.width, camera.height, 1);
      at[i] = vec2(project(camera.intrinsics, x));
    }
    const vec2 last(camera.width - 1, camera.height - 1);
    for (const auto& t : posed.triangles) {
      const vec2 low = glm::floor(glm::min(at[t[0]], glm::min(at[t[1]], at[t[2]]))) - 1.0f,
                 high = glm::floor(glm::max(at[t[0]], glm::max(at[t[1]], at[t[2]]))) + 1.0f;
      const ivec2 a(glm::clamp(low, vec2(0), last)), b(glm::clamp(high, vec2(0), last));
      for (int y = a.y; y <= b.y; ++y) {
        for (int x = a.x; x <= b.x; ++x) out(x, y) = 1;
      }
    }
    return out;
  }

  // Calls body(pixel x, y, sample's position, numbers, sample) for every sample of every pixel that may see
  // the figure, parallel over rows.
  template <class Body>
  void forEachSample(const Camera& camera, const TraceSettings& s, const Progress& progress,
                     Body&& body) const {
    const Image<std::uint8_t> covered = mayCover(camera);
    parallelFor(static_cast<std::size_t>(camera.height), kRows, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end && !progress.stopRequested(); ++y) {
        for (int x = 0; x < camera.width; ++x) {
          if (!covered(x, static_cast<int>(y))) continue;
          for (int i = 0; i < s.samples; ++i) {
            PathNumbers numbers(s.seed, y * static_cast<std::size_t>(camera.width) + x, i, s.samples);
            const vec2 jitter = numbers.next();
            body(x, static_cast<int>(y), dvec2(x + jitter.x, y + jitter.y), numbers, i);
          }
        }
      }
    });
    progress.check();
  }
};

SampleScene::SampleScene(const Figure& figure, const Mesh& surface, const dmat3& world_from_capture)
    : state_(std::make_unique<State>(figure, surface, world_from_capture)) {}
SampleScene::~SampleScene() = default;

void SampleScene::pose(const Mesh& surface) { state_->pose(surface); }

SampleScene::Picture SampleScene::photograph(const Camera& camera, const EnvironmentSampler& light,
                                             const TraceSettings& s, const Progress& progress) const {
  Picture out{Image<vec3>(camera.width, camera.height, vec3(0), Encoding::Linear),
              Image<float>(camera.width, camera.height)};
  const State::CameraRays rays(camera);
  const PanoramaLights lights(light);
  const PathIntegrator paths(*state_, lights, {.bounces = s.bounces});
  const float share = 1.0f / static_cast<float>(s.samples);
  state_->forEachSample(camera, s, progress, [&](int x, int y, dvec2 p, PathNumbers& numbers, int) {
    const vec3 d = rays.direction(p);
    const std::optional<PathHit> hit = state_->nearest(rays.origin, d);
    if (!hit) return;
    out.coverage(x, y) += share;
    out.radiance(x, y) += share * paths.radiance(*hit, -d, numbers);
  });
  return out;
}

TracedMaps SampleScene::maps(const Camera& camera, const TraceSettings& s, const Progress& progress) const {
  const int w = camera.width, h = camera.height;
  TracedMaps m{Image<vec3>(w, h),  Image<vec3>(w, h),  Image<float>(w, h),
               Image<float>(w, h), Image<float>(w, h), Image<float>(w, h)};
  const State::CameraRays rays(camera);
  const vec3 axis = vec3(glm::normalize(rays.world_from_camera.rotation * dvec3(0, 0, 1)));
  const float share = 1.0f / static_cast<float>(s.samples);
  state_->forEachSample(camera, s, progress, [&](int x, int y, dvec2 p, PathNumbers& numbers, int sample) {
    const vec3 d = rays.direction(p);
    const std::optional<PathHit> hit = state_->nearest(rays.origin, d);
    if (!hit) return;
    const vec3 n = glm::dot(hit->normal, d) > 0 ? -hit->normal : hit->normal;
    m.coverage(x, y) += share;
    m.base_color(x, y) += share * hit->base_color;
    m.roughness(x, y) += share * hit->roughness;
    m.normal(x, y) += share * n;
    m.depth_m(x, y) += share * hit->distance_m * glm::dot(d, axis);
    constexpr int kEvery = 4, kSky = 32;  // sky rays of every fourth sample
    if (sample % kEvery == 0) {
      const int used = (s.samples + kEvery - 1) / kEvery;
      m.ambient_occlusion(x, y) +=
          beam::skyVisibility(*state_, hit->position_m, n, kSky, numbers) / static_cast<float>(used);
    }
  });
  for (std::size_t i = 0; i < m.coverage.pixels.size(); ++i) {
    const float c = m.coverage.pixels[i];
    m.depth_m.pixels[i] = c > 0.5f ? m.depth_m.pixels[i] / c : 0;
    const float length = glm::length(m.normal.pixels[i]);
    m.normal.pixels[i] = length > 1e-6f ? m.normal.pixels[i] / length : vec3(0);
    m.ambient_occlusion.pixels[i] = std::min(m.ambient_occlusion.pixels[i], 1.0f);
  }
  return m;
}

float SampleScene::skyVisibility(vec3 x, vec3 normal, int samples, std::uint64_t seed) const {
  return beam::skyVisibility(*state_, x, normal, samples, PathNumbers(seed, 0, 0, 1));
}

}  // namespace beam
