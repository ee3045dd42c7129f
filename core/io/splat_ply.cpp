// SPDX-License-Identifier: Apache-2.0
#include "core/io/splat_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/io/ply_file.h"
#include "core/scene/thin_axis.h"

namespace beam {
namespace {

constexpr int kRest = kShCount - 1;

std::vector<std::string> standardColumns() {
  std::vector<std::string> c = {"x", "y", "z", "nx", "ny", "nz"};
  for (int i = 0; i < 3; ++i) c.push_back(fmt::format("f_dc_{}", i));
  for (int i = 0; i < 3 * kRest; ++i) c.push_back(fmt::format("f_rest_{}", i));
  c.insert(c.end(), {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"});
  return c;
}

std::vector<std::string> materialColumns() {
  std::vector<std::string> c = {"roughness", "metallic"};
  for (int i = 0; i < 3; ++i) c.push_back(fmt::format("base_color_dc_{}", i));
  for (int i = 0; i < 3 * kRest; ++i) c.push_back(fmt::format("base_color_rest_{}", i));
  c.push_back("ao_dc_0");
  for (int i = 0; i < kRest; ++i) c.push_back(fmt::format("ao_rest_{}", i));
  return c;
}

// dc of every channel, then the rest channel after channel.
float* putSh(float* out, const float* sh, int channels) {
  for (int c = 0; c < channels; ++c) *out++ = sh[c];
  for (int c = 0; c < channels; ++c) {
    for (int k = 1; k < kShCount; ++k) *out++ = sh[k * channels + c];
  }
  return out;
}

// Rows of a splat table by the names of their columns.
class Columns {
 public:
  Columns(const PlyElement& e, const std::filesystem::path& path) : element_(e), path_(path) {}
  bool has(const std::string& name) const { return element_.column(name).has_value(); }
  std::size_t operator[](const std::string& name) const {
    if (const auto c = element_.column(name)) return *c;
    bad(fmt::format("expected a splat PLY, its column \"{}\" is missing", name));
  }
  template <int N>
  std::array<std::size_t, N> numbered(const std::string& stem) const {
    std::array<std::size_t, N> c;
    for (int k = 0; k < N; ++k) c[k] = (*this)[fmt::format("{}{}", stem, k)];
    return c;
  }
  int count(const std::string& stem) const {
    int n = 0;
    while (has(fmt::format("{}{}", stem, n))) ++n;
    return n;
  }
  [[noreturn]] void bad(const std::string& what) const {
    throw Error(Error::Kind::Data, fmt::format("\"{}\": {}", path_.string(), what));
  }

 private:
  const PlyElement& element_;
  const std::filesystem::path& path_;
};

// Where the coefficients of a block stand in a row: from[k * channels + channel]; those of bands that are
// not stored are kNone.
struct ShColumns {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  int degree = -1, channels = 3;
  std::array<std::size_t, 3 * kShCount> from;

  ShColumns(const Columns& columns, const std::string& stem, int channel_count) : channels(channel_count) {
    const std::string rest = stem + "rest_";
    const int stored = columns.count(rest), per_channel = stored / channels;
    for (int d = 0; d <= 3; ++d) {
      if (shCount(d) - 1 == per_channel && stored % channels == 0) degree = d;
    }
    if (degree < 0) {
      columns.bad(
          fmt::format("expected 0, 3, 8 or 15 columns \"{}N\" a channel, found {} in all", rest, stored));
    }
    from.fill(kNone);
    for (int c = 0; c < channels; ++c) {
      from[c] = columns[fmt::format("{}dc_{}", stem, c)];
      for (int k = 0; k < per_channel; ++k) {
        from[(k + 1) * channels + c] = columns[fmt::format("{}{}", rest, c * per_channel + k)];
      }
    }
  }
  void copy(const float* row, float* out) const {
    for (int k = 0; k < kShCount * channels; ++k) out[k] = from[k] == kNone ? 0 : row[from[k]];
  }
};

Materials materialsOf(const PlyElement& vertex, const Columns& columns) {
  const std::size_t n = vertex.count, roughness = columns["roughness"];
  const ShColumns base_color(columns, "base_color_", 3), occlusion(columns, "ao_", 1);
  Materials m;
  m.roughness.resize(n);
  m.base_color = ShBlock(n, 3);
  m.ambient_occlusion = ShBlock(n, 1);
  for (std::size_t i = 0; i < n; ++i) {
    const float* row = vertex.row(i);
    m.roughness[i] = std::clamp(row[roughness], 0.04f, 1.0f);
    base_color.copy(row, m.base_color.of(i));
    occlusion.copy(row, m.ambient_occlusion.of(i));
  }
  return m;
}

}  // namespace

void writeSplatPly(const std::filesystem::path& path, const GaussianCloud& cloud, const Materials* materials,
                   const FileNotes& notes, std::span<const float> normal_sides) {
  requireRowsWithin(cloud.size(), kMostPlyRows, "vertex", path);
  std::vector<std::string> columns = standardColumns();
  if (materials) {
    const std::vector<std::string> more = materialColumns();
    columns.insert(columns.end(), more.begin(), more.end());
  }
  std::string out = "ply\nformat binary_little_endian 1.0\n" + plyComments(notes);
  if (materials) out += "comment beam materials 1: linear base colour, ambient occlusion, value = 0.5 + SH\n";
  out += fmt::format("element vertex {}\n", cloud.size());
  for (const std::string& c : columns) out += "property float " + c + "\n";
  out += "end_header\n";
  const std::size_t header = out.size();
  out.resize(header + cloud.size() * columns.size() * 4);
  const vec3 center = normal_sides.empty() ? centerOf(cloud) : vec3(0);
  std::vector<float> row(columns.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    float* v = row.data();
    const vec3 normal =
        normal_sides.empty() ? outwardAxis(cloud, i, center) : normal_sides[i] * thinAxis(cloud, i);
    for (int k = 0; k < 3; ++k) *v++ = cloud.position_m[i][k];
    for (int k = 0; k < 3; ++k) *v++ = normal[k];
    v = putSh(v, cloud.color.of(i), 3);
    *v++ = std::log(cloud.opacity[i] / (1 - cloud.opacity[i]));
    for (int k = 0; k < 3; ++k) *v++ = std::log(cloud.scale_m[i][k]);
    const quat& q = cloud.rotation[i];
    for (const float k : {q.w, q.x, q.y, q.z}) *v++ = k;
    if (materials) {
      *v++ = materials->roughness[i];
      *v++ = 0;
      v = putSh(v, materials->base_color.of(i), 3);
      putSh(v, materials->ambient_occlusion.of(i), 1);
    }
    std::memcpy(out.data() + header + i * row.size() * 4, row.data(), row.size() * 4);
  }
  writeFileAtomically(path, out);
}

SplatFile readSplatPly(const std::filesystem::path& path) {
  const std::vector<PlyElement> elements = readPly(path);
  const PlyElement* vertex = findElement(elements, "vertex");
  if (!vertex)
    throw Error(Error::Kind::Data, fmt::format("\"{}\": expected an element \"vertex\"", path.string()));
  const std::size_t n = vertex->count;
  const Columns columns(*vertex, path);
  const std::array<std::size_t, 3> position = {columns["x"], columns["y"], columns["z"]};
  const auto scale = columns.numbered<3>("scale_");
  const auto rotation = columns.numbered<4>("rot_");
  const std::size_t opacity = columns["opacity"];
  const ShColumns color(columns, "f_", 3);
  SplatFile file;
  file.sh_degree = color.degree;
  GaussianCloud& c = file.cloud;
  c.position_m.resize(n), c.rotation.resize(n), c.scale_m.resize(n), c.opacity.resize(n);
  c.color = ShBlock(n, 3);
  for (std::size_t i = 0; i < n; ++i) {
    const float* row = vertex->row(i);
    for (int k = 0; k < 3; ++k) c.position_m[i][k] = row[position[k]];
    for (int k = 0; k < 3; ++k) c.scale_m[i][k] = std::exp(row[scale[k]]);
    c.opacity[i] = std::clamp(1 / (1 + std::exp(-row[opacity])), 1e-7f, 1 - 1e-7f);
    const quat q(row[rotation[0]], row[rotation[1]], row[rotation[2]], row[rotation[3]]);
    const float norm = std::sqrt(glm::dot(q, q));
    c.rotation[i] = norm > 0 && std::isfinite(norm) ? q / norm : quat(1, 0, 0, 0);
    color.copy(row, c.color.of(i));
  }
  if (columns.has("roughness") && columns.has("base_color_dc_0") && columns.has("ao_dc_0")) {
    file.materials = materialsOf(*vertex, columns);
  }
  try {
    validate(c);
    if (file.materials) validate(*file.materials, c);
  } catch (const Error& e) {
    columns.bad(e.what());
  }
  return file;
}

}  // namespace beam
