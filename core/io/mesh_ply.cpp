// SPDX-License-Identifier: Apache-2.0
#include "core/io/mesh_ply.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "core/io/content_seal.h"
#include "core/io/file.h"
#include "core/io/ply_file.h"

namespace beam {
namespace {

// Appends the bytes of a value (little-endian hosts only, as all that the house builds for).
template <class T>
void append(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::vector<vec3> positionsOf(const PlyElement& vertex, const std::filesystem::path& path) {
  const auto x = vertex.column("x"), y = vertex.column("y"), z = vertex.column("z");
  if (!x || !y || !z) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\": expected vertices with x, y and z", path.string()));
  }
  std::vector<vec3> out(vertex.count);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float* row = vertex.row(i);
    out[i] = {row[*x], row[*y], row[*z]};
    if (!(std::isfinite(out[i].x) && std::isfinite(out[i].y) && std::isfinite(out[i].z))) {
      throw Error(Error::Kind::Data, fmt::format("\"{}\": vertex {} is not finite", path.string(), i));
    }
  }
  return out;
}

// Of an element that has some; positionsOf has looked at it.
std::vector<dvec3> widePositionsOf(const PlyElement& vertex) {
  const std::size_t columns[3] = {vertex.column("x").value(), vertex.column("y").value(),
                                  vertex.column("z").value()};
  std::vector<dvec3> out(vertex.count);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (int k = 0; k < 3; ++k) out[i][k] = vertex.wide[i * vertex.columns + columns[k]];
  }
  return out;
}

const PlyElement& vertexOf(const std::vector<PlyElement>& elements, const std::filesystem::path& path) {
  if (const PlyElement* v = findElement(elements, "vertex")) return *v;
  throw Error(Error::Kind::Data, fmt::format("\"{}\": expected an element \"vertex\"", path.string()));
}

std::vector<vec3> normalsOf(const PlyElement& vertex) {
  const auto x = vertex.column("nx"), y = vertex.column("ny"), z = vertex.column("nz");
  if (!x || !y || !z) return {};
  std::vector<vec3> out(vertex.count);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float* row = vertex.row(i);
    out[i] = {row[*x], row[*y], row[*z]};
  }
  return out;
}

std::vector<vec2> uvOf(const PlyElement& vertex) {
  for (const auto& [s, t] : {std::pair{"s", "t"}, std::pair{"u", "v"}, std::pair{"texture_u", "texture_v"}}) {
    const auto x = vertex.column(s), y = vertex.column(t);
    if (!x || !y) continue;
    std::vector<vec2> out(vertex.count);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = {vertex.row(i)[*x], 1 - vertex.row(i)[*y]};
    return out;
  }
  return {};
}

// The bytes of a mesh's file, a piece at a time.
class MeshPieces {
 public:
  MeshPieces(const Mesh& mesh, const FileNotes& notes, const Progress* progress)
      : mesh_(mesh),
        progress_(progress),
        normals_(!mesh.vertices.empty() && mesh.normals.size() == mesh.vertices.size()),
        uv_(!mesh.vertices.empty() && mesh.uv.size() == mesh.vertices.size()) {
    piece_ = fmt::format(
        "ply\nformat binary_little_endian 1.0\n{}element vertex {}\nproperty float x\nproperty float "
        "y\nproperty float z\n{}{}element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        plyComments(notes), mesh.vertices.size(),
        normals_ ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
        uv_ ? "property float s\nproperty float t\n" : "", mesh.triangles.size());
  }

  // Empty: there are no more.
  std::string_view next() {
    if (progress_) progress_->check();
    if (begun_) piece_.clear();
    begun_ = true;
    for (; vertices_ < mesh_.vertices.size() && piece_.size() < kPiece; ++vertices_) {
      append(piece_, mesh_.vertices[vertices_]);
      if (normals_) append(piece_, mesh_.normals[vertices_]);
      if (uv_) append(piece_, vec2(mesh_.uv[vertices_].x, 1 - mesh_.uv[vertices_].y));
    }
    for (; triangles_ < mesh_.triangles.size() && piece_.size() < kPiece; ++triangles_) {
      append(piece_, std::uint8_t{3});
      append(piece_, mesh_.triangles[triangles_]);
    }
    return piece_;
  }

 private:
  static constexpr std::size_t kPiece = 4u << 20;
  const Mesh& mesh_;
  const Progress* progress_;
  bool normals_, uv_, begun_ = false;
  std::size_t vertices_ = 0, triangles_ = 0;
  std::string piece_;
};

Digest digestOfMesh(const Mesh& mesh, const FileNotes& notes, const Progress* progress) {
  MeshPieces pieces(mesh, notes, progress);
  Hasher hasher;
  for (std::string_view piece = pieces.next(); !piece.empty(); piece = pieces.next()) hasher.add(piece);
  return hasher.digest();
}

}  // namespace

void writeMeshPly(const std::filesystem::path& path, const Mesh& mesh, const MeshPlyWriting& how) {
  requireRowsWithin(mesh.vertices.size(), how.most_rows, "vertex", path);
  requireRowsWithin(mesh.triangles.size(), how.most_rows, "face", path);
  FileNotes notes = sealable(how.notes);
  if (!notes.empty()) notes = sealed(notes, digestOfMesh(mesh, notes, how.progress));
  MeshPieces pieces(mesh, notes, how.progress);
  writeFileAtomically(path, [&] { return pieces.next(); });
}

void writePointsPly(const std::filesystem::path& path, const PointCloud& points) {
  requireRowsWithin(points.position_m.size(), kMostPlyRows, "vertex", path);
  const bool colored = points.color.size() == points.position_m.size();
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty "
      "float z\n"
      "{}end_header\n",
      points.position_m.size(),
      colored ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "");
  for (std::size_t i = 0; i < points.position_m.size(); ++i) {
    append(out, points.position_m[i]);
    if (colored) append(out, points.color[i]);
  }
  writeFileAtomically(path, out);
}

Mesh readMeshPly(const std::filesystem::path& path, std::size_t most_rows) {
  const std::vector<PlyElement> elements = readPly(path, most_rows);
  Mesh mesh;
  const PlyElement& vertex = vertexOf(elements, path);
  mesh.vertices = positionsOf(vertex, path);
  mesh.normals = normalsOf(vertex);
  mesh.uv = uvOf(vertex);
  const PlyElement* faces = findElement(elements, "face");
  if (!faces) return mesh;
  for (const std::vector<std::uint32_t>& polygon : faces->lists) {
    for (const std::uint32_t v : polygon) {
      if (v < mesh.vertices.size()) continue;
      throw Error(Error::Kind::Data, fmt::format("\"{}\": a face names vertex {}, there are {}",
                                                 path.string(), v, mesh.vertices.size()));
    }
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      mesh.triangles.push_back({polygon[0], polygon[i], polygon[i + 1]});
    }
  }
  return mesh;
}

PointCloud readPointsPly(const std::filesystem::path& path) {
  const std::vector<PlyElement> elements = readPly(path);
  const PlyElement& vertex = vertexOf(elements, path);
  PointCloud points;
  points.position_m = positionsOf(vertex, path);
  if (!vertex.wide.empty()) points = pointCloudOf(widePositionsOf(vertex), {});
  const auto r = vertex.column("red"), g = vertex.column("green"), b = vertex.column("blue");
  if (!r || !g || !b) return points;
  points.color.resize(points.position_m.size());
  for (std::size_t i = 0; i < points.color.size(); ++i) {
    const float* row = vertex.row(i);
    points.color[i] = u8vec3(glm::clamp(vec3(row[*r], row[*g], row[*b]), 0.0f, 255.0f));
  }
  return points;
}

void writePosePly(const std::filesystem::path& path, const Pose& pose) {
  requireRowsWithin(pose.size(), kMostPlyRows, "vertex", path);
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty "
      "float z\nproperty float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty float "
      "rot_3\nend_header\n",
      pose.size());
  for (std::size_t i = 0; i < pose.size(); ++i) {
    const quat& q = pose.rotation[i];
    append(out, pose.position_m[i]);
    append(out, vec4(q.w, q.x, q.y, q.z));
  }
  writeFileAtomically(path, out);
}

Pose readPosePly(const std::filesystem::path& path) {
  const std::vector<PlyElement> elements = readPly(path);
  const PlyElement& vertex = vertexOf(elements, path);
  Pose pose{positionsOf(vertex, path), {}};
  const auto first = vertex.column("rot_0");
  if (!first || vertex.column("rot_3") != *first + 3)
    throw Error(Error::Kind::Data, fmt::format("\"{}\": expected the columns rot_0 to rot_3", path.string()));
  for (std::size_t i = 0; i < pose.size(); ++i) {
    const float* q = vertex.row(i) + *first;
    pose.rotation.emplace_back(q[0], q[1], q[2], q[3]);
    const float length = glm::length(pose.rotation.back());
    if (!(std::isfinite(length) && length > 0))
      throw Error(Error::Kind::Data, fmt::format("\"{}\": rotation {} is none", path.string(), i));
  }
  return pose;
}

}  // namespace beam
