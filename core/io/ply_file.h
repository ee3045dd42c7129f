// SPDX-License-Identifier: Apache-2.0
// PLY as a table format: header, elements, properties; ASCII and both byte orders. Splats, meshes and points
// are read through it.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace beam {

struct PlyProperty {
  std::string name;
  std::string type;       // "float", "uchar", ... as canonical names
  std::string list_type;  // type of the count; empty: no list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
  std::vector<std::vector<double>> columns;       // of plain properties, by position
  std::vector<std::vector<std::uint32_t>> lists;  // of the first list property, one a row

  // Column of a property; null when there is none.
  const std::vector<double>* column(const std::string& property) const;
};

// Throws Error{Data} naming the file: no PLY, unknown type, or fewer bytes than the counts need.
std::vector<PlyElement> readPly(const std::filesystem::path& path);
const PlyElement* findElement(const std::vector<PlyElement>& elements, const std::string& name);

}  // namespace beam
