// SPDX-License-Identifier: Apache-2.0
// PLY as a table format: header, elements, properties; ASCII and both byte orders. Splats, meshes and points
// are read through it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/written_by.h"

namespace beam {

enum class PlyType { Char, UChar, Short, UShort, Int, UInt, Float, Double };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Float;
  std::optional<PlyType> count_type = {};  // of a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
  std::size_t columns = 0;                        // plain properties
  std::vector<float> values;                      // [row][column]: the plain properties in their order
  std::vector<double> wide;                       // the same, not rounded, where one is stored as a double
  std::vector<std::vector<std::uint32_t>> lists;  // of the first list property, one a row

  // Position of a plain property in its row; nothing when there is none.
  std::optional<std::size_t> column(const std::string& property) const;
  const float* row(std::size_t i) const { return values.data() + i * columns; }
};

// "comment NAME TEXT" lines for the header.
std::string plyComments(const FileNotes& notes);

// Of one element. Readers refuse more and so do writers.
inline constexpr std::size_t kMostPlyRows = 1u << 26;
// Throws Error{Data} that names the limit where `rows` of `element` are more than `most`.
void requireRowsWithin(std::size_t rows, std::size_t most, const std::string& element,
                       const std::filesystem::path& path);

// Throws Error{Data} naming the file: no PLY, unknown type, fewer bytes than the counts need, or more rows
// than `most_rows`.
std::vector<PlyElement> readPly(const std::filesystem::path& path, std::size_t most_rows = kMostPlyRows);
// Names, counts and properties alone, of a file that may be large; otherwise as above.
std::vector<PlyElement> readPlyHeader(const std::filesystem::path& path);
const PlyElement* findElement(const std::vector<PlyElement>& elements, const std::string& name);

}  // namespace beam
