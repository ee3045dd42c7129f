// SPDX-License-Identifier: Apache-2.0
// What the steps of the CPU rasteriser hand to each other: projected Gaussians, keys sorted by tile and
// depth, and the pictures of a pass. Plain data; the steps are project, sort and bin, blend, gather.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image/image.h"
#include "core/render/aligned.h"
#include "core/render/gaussian_buffers.h"
#include "core/scene/camera.h"

namespace beam {

inline constexpr int kTile = 16;  // pixels a side; 4x4 blocks of 4x4 pixels, one block = 16 lanes
inline constexpr float kMinAlpha = 1 / 255.0f;
inline constexpr float kMaxAlpha = 0.99f;
inline constexpr float kMinTransmittance = 1e-4f;
inline constexpr float kNear_m = 0.05f;

// Screen ellipse and colour. exponent (base 2) at d = pixel - centre: a dx^2 + b dx dy + c dy^2, the Gaussian
// reaches alpha 1/255 where it equals -limit.
struct alignas(64) ScreenSplat {
  float x, y;     // centre, pixels
  float a, b, c;  // scaled conic
  float opacity;
  float red, green, blue;
  float z;            // of the centre, metres; 0: not drawn
  float rightmost_y;  // row of the ellipse's rightmost point, relative to the centre
  float half_height;  // of the ellipse
  float limit;
  float inverse_2a;  // of the span's quadratic: -1 / (2 a)
  float radius;      // bounding radius, pixels
  float unused;
};

// Normal and depth surface (core/render/kernels/project.h, DepthSurface).
struct alignas(64) SurfaceSplat {
  float nx, ny, nz;
  float ax, ay, mxx, mxy, myy;
  float inverse_kappa;
  float unused[7];
};

struct TileEntry {
  std::uint32_t splat;
  std::uint32_t slot;  // of the key, keys counted Gaussian after Gaussian
};

struct RasterCameraConstants {
  double rotation[9];  // camera_from_world, rows
  double translation[3], center[3];
  Intrinsics intrinsics;
  int width, height;
  float dilation_px2;
};

struct RasterState {
  RasterCameraConstants camera;
  int tiles_x = 0, tiles_y = 0;
  int sh_degree = 3;
  bool color = true, geometry = false;
  int extra_channels = 0;
  int slot_floats = 12;  // gradient floats a key

  AlignedVector<ScreenSplat> splats;
  AlignedVector<SurfaceSplat> surfaces;
  AlignedVector<float> radius;

  std::vector<std::uint32_t> order;       // Gaussians by depth
  std::vector<std::uint32_t> first_slot;  // size count + 1
  std::vector<std::uint32_t> tile_start;  // size tiles + 1
  std::vector<TileEntry> entries;         // by tile, then depth

  // After forward: blocks of the entry's tile in which a pixel met it (bit 4 row + column); the backward pass
  // visits no others. Empty when no backward pass will come.
  std::vector<std::uint16_t> met_blocks;  // [entry]
  // Transmittance of every pixel, negative where the pixel was opaque before its last entry.
  AlignedVector<float> transmittance;   // [tile][block][16]
  AlignedVector<float> slot_gradients;  // [slot][slot_floats]
  std::uint64_t pairs_evaluated = 0, pairs_blended = 0;
};

// x-range of the ellipse {exponent >= -limit} within rows [ya, yb] relative to the centre.
void ellipseSpan(const ScreenSplat& s, float ya, float yb, float& low, float& high);

// Orders the splats by depth (ties by index) and lists them tile by tile.
class TileBinner {
 public:
  void run(RasterState& state);

 private:
  void sortByDepth(const RasterState& state);
  void listTiles(RasterState& state);
  void scatter(RasterState& state);

  struct Piece {
    std::vector<std::uint32_t> tiles;  // of its Gaussians' keys
  };
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> order_, keys_, keys_swap_, order_swap_, slot_tile_, cursor_;
};

// SIMD steps (one instruction set chosen at run time; all give the same bits).
void projectSplats(const GaussianBuffers& gaussians, RasterState& state, std::size_t begin, std::size_t end);

inline constexpr int kMostExtra = 32;
struct PassImages {
  Planes *color, *alpha, *depth, *median_depth, *normal, *extra;
  float background[3];
  const float* extra_values[kMostExtra];  // a plane of the Gaussians each
};
struct TileCounts {
  std::uint64_t evaluated = 0, blended = 0;
};
TileCounts blendTileForward(RasterState& state, int tile, const PassImages& images);

struct PassGradients {
  const Planes *color, *alpha, *depth, *median_depth, *normal, *extra;   // upstream; null or empty: zero
  const Planes *image_color, *image_depth, *image_normal, *image_extra;  // of the forward pass
};
void blendTileBackward(RasterState& state, const GaussianBuffers& gaussians, int tile,
                       const PassGradients& images);

// Sums the slots of Gaussians [begin, end) in slot order and chains to the physical values; begin a multiple
// of 16.
void chainGradients(const GaussianBuffers& gaussians, const RasterState& state, std::size_t begin,
                    std::size_t end, GaussianBuffers& gradients);

// Weights of one tile, front to back a pixel: calls per pixel lists of (Gaussian, weight); lists has 256
// entries.
struct WeightEntry {
  std::uint32_t gaussian;
  float weight;
};
void blendTileWeights(const RasterState& state, int tile, std::vector<std::vector<WeightEntry>>& lists);

}  // namespace beam
