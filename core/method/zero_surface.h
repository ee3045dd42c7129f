// SPDX-License-Identifier: Apache-2.0
// The zero surface of signed distances as triangles, a slab of blocks at a time: memory is that of the slab
// and of the triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/checkpoint.h"
#include "core/base/progress.h"
#include "core/method/voxel_blocks.h"
#include "core/scene/mesh.h"

namespace beam {

// Marching tetrahedra: six around the diagonal of every cell, shared edges give shared vertices. The same for
// any cut into slabs and any number of threads.
class ZeroSurface {
 public:
  // Room is set aside for as many triangles, which takes memory as it is filled: a large mesh that moved as
  // it grew would take twice its memory, and seconds in which nothing can stop.
  ZeroSurface(float voxel_m, std::size_t triangles);

  // Whole layers of rising x; `last`: none follow. The last layer is kept until it is known what it meets.
  void add(std::vector<TsdfBlock> layers, bool last, const Progress& progress);
  const Mesh& soFar() const { return mesh_; }
  // Between two slabs: all it needs to go on. What is lent stands until the next add().
  void keepIn(CheckpointWriter& checkpoint) const;
  // In place of what it has, which stays where Error{Data} is thrown.
  void takeUp(CheckpointReader& checkpoint);
  Mesh take() { return std::move(mesh_); }

 private:
  static constexpr int kEdges = 7;  // towards the other corners of a voxel's cell
  using EdgeVertices = std::vector<std::uint32_t>;
  // A corner of a triangle: the edge that it cuts, and where.
  struct Cut {
    std::uint16_t edge;  // (neighbour * kBlockVoxels + voxel) * kEdges + direction, of the edge's lower end
    vec3 position_m;
  };
  struct Cell;
  using Neighbours = std::array<int, 8>;  // places in blocks_ by +x, +y, +z as bits; -1: there is none

  Neighbours neighboursOf(const TsdfBlock& block) const;
  std::vector<Cut> cutsOf(int place) const;
  void join(const std::vector<Cut>& cuts, const Neighbours& neighbours);

  float voxel_m_;
  std::vector<TsdfBlock> blocks_;       // in order
  std::vector<EdgeVertices> vertices_;  // of the edges of each block; empty: none so far
  Mesh mesh_;
};

}  // namespace beam
