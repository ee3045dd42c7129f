// SPDX-License-Identifier: Apache-2.0
#include "viewers/scene/vtk_convert.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "viewers/false_color.h"

namespace beam {
namespace {

// Collects points, colours and cells, then hands them over as one vtkPolyData.
class Builder {
 public:
  vtkIdType point(vec3 p, u8vec3 color) {
    colors_->InsertNextTypedTuple(&color.x);
    return points_->InsertNextPoint(p.x, p.y, p.z);
  }
  void normal(vec3 n) { normals_->InsertNextTypedTuple(&n.x); }
  void line(vtkIdType a, vtkIdType b) {
    const vtkIdType ids[2] = {a, b};
    lines_->InsertNextCell(2, ids);
  }
  void line(vec3 a, vec3 b, u8vec3 color) {
    const vtkIdType first = point(a, color);
    line(first, point(b, color));
  }
  void vertex(vtkIdType a) { vertices_->InsertNextCell(1, &a); }
  void triangle(vtkIdType a, vtkIdType b, vtkIdType c) {
    const vtkIdType ids[3] = {a, b, c};
    triangles_->InsertNextCell(3, ids);
  }
  PolyData build() {
    auto data = PolyData::New();
    data->SetPoints(points_);
    data->GetPointData()->SetScalars(colors_);
    if (normals_->GetNumberOfTuples() > 0) data->GetPointData()->SetNormals(normals_);
    data->SetLines(lines_);
    data->SetVerts(vertices_);
    data->SetPolys(triangles_);
    return data;
  }
  Builder() {
    colors_->SetNumberOfComponents(3);
    normals_->SetNumberOfComponents(3);
  }

 private:
  vtkSmartPointer<vtkPoints> points_ = vtkSmartPointer<vtkPoints>::New();
  vtkSmartPointer<vtkUnsignedCharArray> colors_ = vtkSmartPointer<vtkUnsignedCharArray>::New();
  vtkSmartPointer<vtkFloatArray> normals_ = vtkSmartPointer<vtkFloatArray>::New();
  vtkSmartPointer<vtkCellArray> lines_ = vtkSmartPointer<vtkCellArray>::New();
  vtkSmartPointer<vtkCellArray> vertices_ = vtkSmartPointer<vtkCellArray>::New();
  vtkSmartPointer<vtkCellArray> triangles_ = vtkSmartPointer<vtkCellArray>::New();
};

// The unit sphere: an octahedron whose faces are split (twice: 66 points, 128 triangles).
Mesh unitSphere(int splits) {
  Mesh sphere;
  sphere.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  sphere.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < splits; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(sphere.vertices.size()));
      if (fresh) sphere.vertices.push_back(glm::normalize(sphere.vertices[a] + sphere.vertices[b]));
      return it->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : sphere.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    sphere.triangles = std::move(finer);
  }
  return sphere;
}

std::vector<std::size_t> largest(const GaussianCloud& cloud, std::size_t most) {
  const auto weight = [&](std::size_t i) {
    const vec3 s = cloud.scale_m[i];
    return cloud.opacity[i] * (s.x * s.y * s.z) / std::min({s.x, s.y, s.z});
  };
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (order.size() <= most) return order;
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(),
                   [&](std::size_t a, std::size_t b) { return weight(a) > weight(b); });
  order.resize(most);
  return order;
}

u8vec3 meanColor(const GaussianCloud& cloud, std::size_t i) {
  const float* sh = cloud.color.of(i);
  const vec3 c = 0.5f + kShC0 * vec3(sh[0], sh[1], sh[2]);
  return u8vec3(glm::clamp(c, vec3(0), vec3(1)) * 255.0f + 0.5f);
}

// Grey where the joint has no say.
u8vec3 influenceColor(float share) {
  constexpr float kLeast = 0.005f;
  return share < kLeast ? u8vec3(70, 74, 80) : falseColor(share);
}

// Neighbours in the list get colours far apart: steps of the golden angle around the colour circle.
vec3 jointColor(std::size_t joint) {
  constexpr float kGoldenTurn = 0.618034f;
  const float turn = 2 * kPi * std::fmod(kGoldenTurn * static_cast<float>(joint), 1.0f);
  return 0.55f + 0.4f * vec3(std::cos(turn), std::cos(turn - 2 * kPi / 3), std::cos(turn + 2 * kPi / 3));
}

}  // namespace

Frustum frustumOf(const Camera& camera, double length_m) {
  const Rigid3 world_from_camera = inverse(camera.camera_from_world);
  const double w = camera.width, h = camera.height;
  const auto at = [&](double x, double y) {
    return vec3(world_from_camera * (length_m * rayOf(camera.intrinsics, {x, y})));
  };
  return {vec3(world_from_camera.translation_m), at(0, 0), at(w, 0), at(w, h), at(0, h), at(w / 2, -h / 6)};
}

PolyData frustaOf(const std::vector<View>& views, double length_m, int marked) {
  Builder builder;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (marked >= 0 && static_cast<int>(i) != marked) continue;
    const u8vec3 by_split = views[i].split == Split::Test ? kTestColor : kTrainColor;
    std::array<vtkIdType, 6> ids{};
    const Frustum frustum = frustumOf(views[i].camera, length_m);
    for (std::size_t k = 0; k < ids.size(); ++k)
      ids[k] = builder.point(frustum[k], marked >= 0 ? kMarkColor : by_split);
    for (const auto& [a, b] : kFrustumEdges) builder.line(ids[a], ids[b]);
  }
  return builder.build();
}

PolyData pointsOf(const PointCloud& cloud) {
  Builder builder;
  for (std::size_t i = 0; i < cloud.position_m.size(); ++i) {
    builder.vertex(builder.point(cloud.position_m[i], cloud.color.empty() ? u8vec3(200) : cloud.color[i]));
  }
  return builder.build();
}

PolyData meshOf(const Mesh& mesh) {
  std::vector<vec3> normals(mesh.vertices.size(), vec3(0));
  for (const auto& [a, b, c] : mesh.triangles) {
    // Not normalised: larger triangles say more.
    const vec3 n = glm::cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    for (const std::uint32_t v : {a, b, c}) normals[v] += n;
  }
  Builder builder;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    builder.point(mesh.vertices[i], u8vec3(186, 190, 198));
    builder.normal(normals[i] / std::max(glm::length(normals[i]), 1e-20f));
  }
  for (const auto& [a, b, c] : mesh.triangles) builder.triangle(a, b, c);
  return builder.build();
}

PolyData ellipsoidsOf(const GaussianCloud& cloud, std::size_t most, float sigmas,
                      const std::vector<float>& influence, int splits) {
  const Mesh sphere = unitSphere(splits);
  Builder builder;
  for (const std::size_t i : largest(cloud, most)) {
    const u8vec3 color = influence.empty() ? meanColor(cloud, i) : influenceColor(influence[i]);
    const vec3 radii = sigmas * cloud.scale_m[i];
    vtkIdType first = -1;
    for (const vec3& v : sphere.vertices) {
      const vtkIdType id = builder.point(cloud.position_m[i] + cloud.rotation[i] * (radii * v), color);
      if (first < 0) first = id;
      builder.normal(glm::normalize(cloud.rotation[i] * (v / radii)));
    }
    for (const auto& [a, b, c] : sphere.triangles) builder.triangle(first + a, first + b, first + c);
  }
  return builder.build();
}

PolyData jointsOf(const JointTrails& trails, int picked, bool others) {
  constexpr float kFaint = 0.45f;
  Builder builder;
  if (trails.empty()) return builder.build();
  for (std::size_t j = 0; j < trails.back().size(); ++j) {
    const bool other = picked >= 0 && static_cast<int>(j) != picked;
    if (other ? !others : picked >= 0 && trails.size() == 1) continue;  // the view draws a ring around it
    const vec3 color = picked < 0 ? jointColor(j) : other ? kFaint * jointColor(j) : vec3(1);
    vtkIdType before = -1;
    for (std::size_t t = other ? trails.size() - 1 : 0; t < trails.size(); ++t) {
      const float age = static_cast<float>(t + 1) / static_cast<float>(trails.size());
      const vtkIdType here = builder.point(trails[t][j], u8vec3(255.0f * color * (0.25f + 0.75f * age)));
      if (before >= 0) builder.line(before, here);
      before = here;
    }
    if (picked < 0 || other) builder.vertex(before);
  }
  return builder.build();
}

PolyData gridAndAxes(float extent_m, float cell_m) {
  Builder builder;
  const int cells = static_cast<int>(extent_m / cell_m + 0.5f);
  for (int i = -cells; i <= cells; ++i) {
    const float at = cell_m * static_cast<float>(i);
    builder.line(vec3(at, 0, -extent_m), vec3(at, 0, extent_m), u8vec3(62, 66, 72));
    builder.line(vec3(-extent_m, 0, at), vec3(extent_m, 0, at), u8vec3(62, 66, 72));
  }
  const float axis = 0.5f * extent_m;
  builder.line(vec3(0), vec3(axis, 0, 0), u8vec3(230, 92, 84));
  builder.line(vec3(0), vec3(0, axis, 0), u8vec3(112, 200, 96));
  builder.line(vec3(0), vec3(0, 0, axis), u8vec3(96, 140, 245));
  return builder.build();
}

}  // namespace beam
