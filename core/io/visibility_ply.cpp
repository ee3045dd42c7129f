// SPDX-License-Identifier: Apache-2.0
#include "core/io/visibility_ply.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/io/ply_file.h"

namespace beam {
namespace {

std::vector<std::string> columnNames() {
  std::vector<std::string> names = {"nx", "ny", "nz", "beam_visibility_dc_0"};
  for (int k = 1; k < kShCount; ++k) names.push_back(fmt::format("beam_visibility_rest_{}", k - 1));
  return names;
}

}  // namespace

void writeVisibilityPly(const std::filesystem::path& path, const VisibilityFile& file) {
  const std::size_t n = file.normal.size();
  if (file.visibility.channels != 1 || file.visibility.coefficients.size() != n * kShCount)
    throw Error(Error::Kind::Bug, "visibility: expected one channel of as many Gaussians as normals");
  requireRowsWithin(n, kMostPlyRows, "vertex", path);
  const std::vector<std::string> columns = columnNames();
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment beam visibility 1: value = 0.5 + SH\n";
  out += fmt::format("element vertex {}\n", n);
  for (const std::string& c : columns) out += "property float " + c + "\n";
  out += "end_header\n";
  const std::size_t header = out.size(), bytes = columns.size() * sizeof(float);
  out.resize(header + n * bytes);
  char* row = out.data() + header;
  for (std::size_t i = 0; i < n; ++i, row += bytes) {
    const vec3 normal = file.normal[i];
    std::memcpy(row, &normal, 3 * sizeof(float));
    std::memcpy(row + 3 * sizeof(float), file.visibility.of(i), kShCount * sizeof(float));
  }
  writeFileAtomically(path, out);
}

VisibilityFile readVisibilityPly(const std::filesystem::path& path) {
  const auto bad = [&](const std::string& what) {
    return Error(Error::Kind::Data, fmt::format("\"{}\": {}", path.string(), what));
  };
  const std::vector<PlyElement> elements = readPly(path);
  const PlyElement* vertex = findElement(elements, "vertex");
  if (!vertex) throw bad("expected an element \"vertex\"");
  std::vector<std::size_t> columns;
  for (const std::string& name : columnNames()) {
    const auto column = vertex->column(name);
    if (!column) throw bad(fmt::format("expected visibility, its column \"{}\" is missing", name));
    columns.push_back(*column);
  }
  VisibilityFile file{std::vector<vec3>(vertex->count), ShBlock(vertex->count, 1)};
  for (std::size_t i = 0; i < vertex->count; ++i) {
    const float* row = vertex->row(i);
    for (const std::size_t c : columns)
      if (!std::isfinite(row[c])) throw bad(fmt::format("row {} holds a value that is not finite", i));
    file.normal[i] = {row[columns[0]], row[columns[1]], row[columns[2]]};
    for (int k = 0; k < kShCount; ++k)
      file.visibility.of(i)[k] = row[columns[static_cast<std::size_t>(k) + 3]];
  }
  return file;
}

}  // namespace beam
