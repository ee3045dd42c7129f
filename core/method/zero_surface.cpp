// SPDX-License-Identifier: Apache-2.0
#include "core/method/zero_surface.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace beam {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;
constexpr int kPadded = kBlock + 1, kPaddedVoxels = kPadded * kPadded * kPadded;

// Corner c of a cell stands at (c & 1, c >> 1 & 1, c >> 2 & 1). Every edge leads upwards from its lower end.
constexpr int kTetrahedra[6][4] = {{0, 5, 1, 7}, {0, 1, 3, 7}, {0, 3, 2, 7},
                                   {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}};

ivec3 cornerOf(int c) { return {c & 1, (c >> 1) & 1, (c >> 2) & 1}; }
int paddedIndex(ivec3 v) { return (v.z * kPadded + v.y) * kPadded + v.x; }

// The voxels of a block and those that its cells share with the next ones.
struct PaddedBlock {
  std::array<float, kPaddedVoxels> distance = {};
  std::array<bool, kPaddedVoxels> known = {};
};

}  // namespace

struct ZeroSurface::Cell {
  ivec3 in_block, voxel;  // of corner 0
  float voxel_m;
  std::array<float, 8> distance;
  std::vector<Cut>& cuts;

  // The lower end of an edge has the fewer bits.
  Cut cut(int a, int b) const {
    const int low = a & b, high = a | b;
    const ivec3 step = cornerOf(high ^ low), at = in_block + cornerOf(low);
    const int neighbour = (at.x / kBlock) | (at.y / kBlock) << 1 | (at.z / kBlock) << 2;
    const int edge = (neighbour * kBlockVoxels + indexInBlock(at % kBlock)) * kEdges + ((high ^ low) - 1);
    const float t = distance[low] / (distance[low] - distance[high]);
    return {static_cast<std::uint16_t>(edge), voxel_m * (vec3(voxel + cornerOf(low)) + t * vec3(step))};
  }

  // Wound so that it faces from the inside corner to the outside one.
  void triangle(const Cut& a, Cut b, Cut c, int in, int out) {
    const vec3 n = glm::cross(b.position_m - a.position_m, c.position_m - a.position_m);
    if (glm::dot(n, vec3(cornerOf(out) - cornerOf(in))) < 0) std::swap(b, c);
    cuts.insert(cuts.end(), {a, b, c});
  }

  void tetrahedron(const int (&corners)[4]) {
    std::array<int, 4> in = {}, out = {};
    int inside = 0, outside = 0;
    for (const int c : corners) (distance[c] < 0 ? in[inside++] : out[outside++]) = c;
    if (inside == 0 || outside == 0) return;
    if (inside == 2) {
      const Cut a = cut(in[0], out[0]), b = cut(in[0], out[1]);
      const Cut d = cut(in[1], out[0]), e = cut(in[1], out[1]);
      triangle(a, b, d, in[0], out[0]);
      triangle(d, b, e, in[0], out[0]);
      return;
    }
    const bool alone_inside = inside == 1;
    const int tip = alone_inside ? in[0] : out[0];
    const std::array<int, 4>& others = alone_inside ? out : in;
    triangle(cut(tip, others[0]), cut(tip, others[1]), cut(tip, others[2]), alone_inside ? tip : others[0],
             alone_inside ? others[0] : tip);
  }
};

ZeroSurface::ZeroSurface(float voxel_m, std::size_t triangles) : voxel_m_(voxel_m) {
  mesh_.triangles.reserve(triangles);
  mesh_.vertices.reserve(triangles / 2);
}

ZeroSurface::Neighbours ZeroSurface::neighboursOf(const TsdfBlock& block) const {
  Neighbours found;
  for (int n = 0; n < 8; ++n) {
    const std::uint64_t key = keyOf(block.index + cornerOf(n));
    const auto at = std::lower_bound(blocks_.begin(), blocks_.end(), key,
                                     [](const TsdfBlock& b, std::uint64_t k) { return keyOf(b.index) < k; });
    const bool there = at != blocks_.end() && keyOf(at->index) == key;
    found[n] = there ? static_cast<int>(at - blocks_.begin()) : -1;
  }
  return found;
}

std::vector<ZeroSurface::Cut> ZeroSurface::cutsOf(int place) const {
  const TsdfBlock& block = blocks_[place];
  const Neighbours neighbours = neighboursOf(block);
  PaddedBlock padded;
  for (int z = 0; z < kPadded; ++z) {
    for (int y = 0; y < kPadded; ++y) {
      for (int x = 0; x < kPadded; ++x) {
        const int from = neighbours[(x / kBlock) | (y / kBlock) << 1 | (z / kBlock) << 2];
        if (from < 0) continue;
        const int i = indexInBlock(ivec3(x, y, z) % kBlock), p = paddedIndex({x, y, z});
        padded.distance[p] = blocks_[from].distance[i];
        padded.known[p] = blocks_[from].weight[i] > 0;
      }
    }
  }
  std::vector<Cut> cuts;
  for (int i = 0; i < kBlockVoxels; ++i) {
    const ivec3 at = voxelInBlock(i);
    Cell cell{at, block.index * kBlock + at, voxel_m_, {}, cuts};
    int inside = 0, known = 0;
    for (int c = 0; c < 8; ++c) {
      const int p = paddedIndex(at + cornerOf(c));
      cell.distance[c] = padded.distance[p];
      known += padded.known[p];
      inside += cell.distance[c] < 0;
    }
    if (known < 8 || inside == 0 || inside == 8) continue;
    for (const auto& t : kTetrahedra) cell.tetrahedron(t);
  }
  return cuts;
}

void ZeroSurface::join(const std::vector<Cut>& cuts, const Neighbours& neighbours) {
  for (std::size_t i = 0; i < cuts.size(); i += 3) {
    std::array<std::uint32_t, 3> t;
    for (int k = 0; k < 3; ++k) {
      const Cut& cut = cuts[i + k];
      constexpr int kOfABlock = kBlockVoxels * kEdges;
      EdgeVertices& of_block = vertices_[neighbours[cut.edge / kOfABlock]];
      if (of_block.empty()) of_block.assign(kOfABlock, kNone);
      std::uint32_t& vertex = of_block[cut.edge % kOfABlock];
      if (vertex == kNone) {
        vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
        mesh_.vertices.push_back(cut.position_m);
      }
      t[k] = vertex;
    }
    mesh_.triangles.push_back(t);
  }
}

void ZeroSurface::add(std::vector<TsdfBlock> layers, bool last, const Progress& progress) {
  blocks_.insert(blocks_.end(), std::make_move_iterator(layers.begin()),
                 std::make_move_iterator(layers.end()));
  vertices_.resize(blocks_.size());
  std::size_t ready = blocks_.size();
  if (!last)
    while (ready > 0 && blocks_[ready - 1].index.x == blocks_.back().index.x) --ready;
  std::vector<std::vector<Cut>> cuts(ready);
  parallelFor(ready, 16, [&](std::size_t begin, std::size_t end) {
    if (progress.stopRequested()) return;
    for (std::size_t b = begin; b < end; ++b) cuts[b] = cutsOf(static_cast<int>(b));
  });
  for (std::size_t b = 0; b < ready; ++b) {
    if (b % 256 == 0) progress.check();
    if (!cuts[b].empty()) join(cuts[b], neighboursOf(blocks_[b]));
  }
  const auto cut = static_cast<std::ptrdiff_t>(ready);
  blocks_.erase(blocks_.begin(), blocks_.begin() + cut);
  vertices_.erase(vertices_.begin(), vertices_.begin() + cut);
}

void ZeroSurface::keepIn(CheckpointWriter& checkpoint) const {
  std::vector<std::uint32_t> counts, all;
  for (const EdgeVertices& of_block : vertices_) {
    counts.push_back(static_cast<std::uint32_t>(of_block.size()));
    all.insert(all.end(), of_block.begin(), of_block.end());
  }
  checkpoint.lend(mesh_.vertices);
  checkpoint.lend(mesh_.triangles);
  checkpoint.lend(blocks_);
  checkpoint.give(counts);
  checkpoint.give(all);
}

void ZeroSurface::takeUp(CheckpointReader& checkpoint) {
  const std::vector<vec3> vertices = checkpoint.list<vec3>();
  const auto triangles = checkpoint.list<std::array<std::uint32_t, 3>>();
  std::vector<TsdfBlock> blocks = checkpoint.list<TsdfBlock>();
  const auto counts = checkpoint.list<std::uint32_t>(), all = checkpoint.list<std::uint32_t>();
  if (counts.size() != blocks.size() || std::accumulate(counts.begin(), counts.end(), 0ull) != all.size())
    throw Error(Error::Kind::Data, "the checkpoint's blocks and their vertices do not fit");
  blocks_ = std::move(blocks);
  vertices_.clear();
  auto next = all.begin();
  for (const std::uint32_t count : counts) {
    vertices_.emplace_back(next, next + count);
    next += count;
  }
  mesh_.vertices.assign(vertices.begin(), vertices.end());  // into the room that is set aside
  mesh_.triangles.assign(triangles.begin(), triangles.end());
}

}  // namespace beam
