// SPDX-License-Identifier: Apache-2.0
#include "core/render/mesh_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/math/brdf.h"
#include "core/scene/transform.h"

namespace beam {
namespace {

// A path's next ray begins this share of the largest coordinate off its triangle: some 100 roundings.
constexpr float kGap = 1e-5f;
constexpr float kLeastSize_m = 0.1f;
constexpr float kSmooth = 0.9f;        // cosine; corners that lean further from their triangle are a crease
constexpr float kLeastFacing = 0.01f;  // cosine of a shading normal and the eye

template <class T>
void requireOfVertices(const std::vector<T>& values, const char* what, std::size_t vertices,
                       std::size_t place) {
  if (!values.empty() && values.size() != vertices)
    throw Error(Error::Kind::Data,
                fmt::format("mesh {}: {} {} of {} vertices", place, values.size(), what, vertices));
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (int c = 0; c < values[i].length(); ++c)
      if (!std::isfinite(values[i][c]))
        throw Error(Error::Kind::Data,
                    fmt::format("mesh {}: {} of vertex {} are not finite", place, what, i));
  }
}

std::vector<Mesh> inWorld(const std::vector<RenderMesh>& meshes) {
  std::vector<Mesh> all;
  for (const RenderMesh& m : meshes) {
    const std::size_t vertices = m.mesh->vertices.size(), place = all.size();
    requireOfVertices(m.mesh->normals, "normals", vertices, place);
    requireOfVertices(m.mesh->uv, "uv", vertices, place);
    all.push_back(transformed(*m.mesh, m.world_from_mesh));
  }
  return all;
}

// Bilinear between the middles of texels, repeated.
template <class T>
T textureAt(const Image<T>& picture, vec2 uv) {
  const vec2 size(picture.width, picture.height), at = (uv - glm::floor(uv)) * size - 0.5f,
                                                  low = glm::floor(at), part = at - low;
  const auto inside = [](int i, int count) { return (i + count) % count; };
  const int x0 = inside(static_cast<int>(low.x), picture.width), x1 = inside(x0 + 1, picture.width),
            y0 = inside(static_cast<int>(low.y), picture.height), y1 = inside(y0 + 1, picture.height);
  const T above = (1 - part.x) * picture(x0, y0) + part.x * picture(x1, y0),
          below = (1 - part.x) * picture(x0, y1) + part.x * picture(x1, y1);
  return (1 - part.y) * above + part.y * below;
}

vec3 asBaseColor(vec3 c) { return glm::clamp(c, 0.0f, 1.0f); }
float asRoughness(float r) { return std::clamp(r, kLeastRoughness, 1.0f); }

// A normal that the eye would see from behind though not its triangle is turned until it is just seen.
vec3 turnedInSight(vec3 normal, vec3 to_eye) {
  const float facing = glm::dot(normal, to_eye);
  return facing >= kLeastFacing ? normal : glm::normalize(normal + (kLeastFacing - facing) * to_eye);
}

struct Corners {
  std::array<float, 3> weights;
  std::array<vec3, 3> at, normals;

  vec3 position() const { return weights[0] * at[0] + weights[1] * at[1] + weights[2] * at[2]; }
  vec3 normal() const { return weights[0] * normals[0] + weights[1] * normals[1] + weights[2] * normals[2]; }
  float size() const {
    float most = kLeastSize_m;
    for (const vec3& x : at) most = std::max({most, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    return most;
  }
  // How far the surface that the triangle stands for bulges out above it (methods 7.10).
  vec3 bulge(vec3 x, vec3 outer) const {
    vec3 sum(0);
    for (int k = 0; k < 3; ++k) {
      if (glm::dot(normals[k], outer) < kSmooth) return vec3(0);
      sum -= weights[k] * std::min(0.0f, glm::dot(x - at[k], normals[k])) * normals[k];
    }
    return sum;
  }
};

}  // namespace

MeshSurfaces::MeshSurfaces(const std::vector<RenderMesh>& meshes, const Ground& ground)
    : meshes_(inWorld(meshes)), ground_(ground), triangles_(meshes_) {
  for (const RenderMesh& m : meshes) finishes_.push_back({m.textures, m.base_color, m.roughness});
}

float MeshSurfaces::groundAt(vec3 o, vec3 d) const {
  if (!ground_.enabled) return PathSurfaces::kFar_m;
  const float t = (static_cast<float>(ground_.height_m) - o.y) / d.y;
  return t > 0 ? t : PathSurfaces::kFar_m;
}

PathHit MeshSurfaces::groundHit(vec3 o, vec3 d, float distance_m) const {
  PathHit hit{.position_m = o + distance_m * d,
              .normal = vec3(0, d.y < 0 ? 1 : -1, 0),
              .distance_m = distance_m,
              .base_color = asBaseColor(vec3(ground_.base_color)),
              .roughness = asRoughness(static_cast<float>(ground_.roughness))};
  hit.position_m.y = static_cast<float>(ground_.height_m);
  hit.step_m = kGap * std::max(1.0f, std::abs(hit.position_m.y)) * hit.normal;
  return hit;
}

PathHit MeshSurfaces::meshHit(const TriangleHit& t, vec3 direction) const {
  const Mesh& mesh = meshes_[t.mesh];
  const Finish& finish = finishes_[t.mesh];
  const auto& corner = mesh.triangles[t.triangle];
  const vec3 outer = glm::dot(t.normal, direction) > 0 ? -t.normal : t.normal;
  Corners c{{1 - t.weights.x - t.weights.y, t.weights.x, t.weights.y}, {}, {outer, outer, outer}};
  for (int k = 0; k < 3; ++k) c.at[k] = mesh.vertices[corner[k]];
  if (!mesh.normals.empty()) {
    for (int k = 0; k < 3; ++k) c.normals[k] = mesh.normals[corner[k]];
    if (glm::dot(c.normal(), outer) < 0)
      for (vec3& n : c.normals) n = -n;
  }
  const vec3 x = c.position(), mean = c.normal();
  const float length = glm::length(mean);
  PathHit hit{.position_m = x,
              .normal = turnedInSight(length > 1e-6f ? mean / length : outer, -direction),
              .distance_m = t.distance_m,
              .base_color = finish.base_color,
              .roughness = finish.roughness,
              .step_m = c.bulge(x, outer) + kGap * c.size() * outer};
  if (finish.textures && !mesh.uv.empty()) {
    vec2 uv(0);
    for (int k = 0; k < 3; ++k) uv += c.weights[k] * mesh.uv[corner[k]];
    const MeshTextures& textures = *finish.textures;
    if (!textures.base_color.empty()) hit.base_color = textureAt(textures.base_color, uv);
    if (!textures.roughness.empty()) hit.roughness = textureAt(textures.roughness, uv);
  }
  hit.base_color = asBaseColor(hit.base_color);
  hit.roughness = asRoughness(hit.roughness);
  return hit;
}

std::optional<PathHit> MeshSurfaces::nearest(vec3 o, vec3 d, float reach_m) const {
  const float ground_m = groundAt(o, d);
  if (const auto hit = triangles_.nearest(o, d, std::min(reach_m, ground_m))) return meshHit(*hit, d);
  return ground_m < reach_m ? std::optional(groundHit(o, d, ground_m)) : std::nullopt;
}

float MeshSurfaces::distance(vec3 o, vec3 d, float reach_m) const {
  const float reach = std::min(reach_m, groundAt(o, d));
  const auto hit = triangles_.nearest(o, d, reach);
  return hit ? hit->distance_m : reach;
}

}  // namespace beam
