// SPDX-License-Identifier: Apache-2.0
// Front-to-back blending of one 16x16 tile in 4x4 blocks, its gradients, and its weights
// (methods 1.5-1.7, 2.4-2.5).
#define BEAM_KERNELS_SIMD
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/render/cpu/blend_simd.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include <algorithm>
#include <bit>

#include "core/render/cpu/raster_state.h"
#include "core/render/kernels/blend.h"

HWY_BEFORE_NAMESPACE();
namespace beam {
namespace HWY_NAMESPACE {

constexpr int kMaxExtra = 16;  // of the backward pass

struct TilePlace {
  int x0, y0;  // first pixel
  int width, height;
};
TilePlace placeOf(const RasterState& s, int tile) {
  return {tile % s.tiles_x * kTile, tile / s.tiles_x * kTile, s.camera.width, s.camera.height};
}

// Calls body(pixel offset in the plane, block, lane) for the tile's pixels inside the picture.
template <class Body>
HWY_INLINE void forEachPixel(const TilePlace& t, Body&& body) {
  const int rows = std::min(kTile, t.height - t.y0), columns = std::min(kTile, t.width - t.x0);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      body(static_cast<std::size_t>(t.y0 + y) * t.width + t.x0 + x, (y >> 2) * 4 + (x >> 2),
           (y & 3) * 4 + (x & 3));
    }
  }
}

using BlockArray = float[16][16];  // [block][lane]

void scatterBlocks(const TilePlace& t, const BlockArray& from, float* plane) {
  forEachPixel(t, [&](std::size_t p, int block, int lane) { plane[p] = from[block][lane]; });
}
void gatherBlocks(const TilePlace& t, const Planes* planes, int channel, BlockArray& to) {
  std::fill_n(&to[0][0], 256, 0.0f);
  if (!planes || planes->empty()) return;
  const float* plane = planes->plane(channel);
  forEachPixel(t, [&](std::size_t p, int block, int lane) { to[block][lane] = plane[p]; });
}

// `kExtra`: room for extra channels.
template <bool kGeometry, int kExtra>
TileCounts forwardTile(RasterState& state, int tile, const PassImages& out) {
  const TilePlace place = placeOf(state, tile);
  alignas(64) BlockArray color[3] = {}, normal[3] = {}, depth = {}, median = {}, transmittance;
  alignas(64) BlockArray extra[kExtra > 0 ? kExtra : 1] = {};
  std::fill_n(&transmittance[0][0], 256, 1.0f);
  TileCounts counts;
  unsigned live = 0xffff;
  const float tx = static_cast<float>(place.x0) + 0.5f, ty = static_cast<float>(place.y0) + 0.5f;
  const std::uint32_t end = state.tile_start[tile + 1];
  const bool keeps = !state.met_blocks.empty();
  std::uint32_t k = state.tile_start[tile];
  for (; k < end && live; ++k) {
    const std::uint32_t index = state.entries[k].splat;
    const ScreenSplat& s = state.splats[index];
    const float x = s.x - tx, y = s.y - ty;
    __builtin_prefetch(&state.splats[state.entries[std::min(k + 8, end - 1)].splat]);
    unsigned met = 0;
    for (unsigned blocks = touchedBlocks(s, x, y) & live; blocks; blocks &= blocks - 1) {
      const int b = std::countr_zero(blocks);
      Lanes t = load(transmittance[b]);
      const Lanes before = t;
      BlockResponse r = respond(s, x - 4 * (b & 3), y - 4 * (b >> 2), t);
      counts.evaluated += 16;
      if (!any(r.hit)) continue;
      met |= 1u << b;
      const Lanes w = weigh(r, t);
      store(t, transmittance[b]);
      store(fma(w, Lanes(s.red), load(color[0][b])), color[0][b]);
      store(fma(w, Lanes(s.green), load(color[1][b])), color[1][b]);
      store(fma(w, Lanes(s.blue), load(color[2][b])), color[2][b]);
      if constexpr (kGeometry) {
        const SurfaceSplat& f = state.surfaces[index];
        const Lanes z = depthAt(s, f, r).z;
        store(fma(w, Lanes(f.nx), load(normal[0][b])), normal[0][b]);
        store(fma(w, Lanes(f.ny), load(normal[1][b])), normal[1][b]);
        store(fma(w, Lanes(f.nz), load(normal[2][b])), normal[2][b]);
        store(fma(w, z, load(depth[b])), depth[b]);
        const Mask crossing = r.hit & (before > Lanes(0.5f)) & (t <= Lanes(0.5f));
        store(select(crossing, z, load(median[b])), median[b]);
      }
      if constexpr (kExtra > 0) {
        for (int e = 0; e < state.extra_channels; ++e) {
          const Lanes value(out.extra_values[e][index]);
          store(fma(w, value, load(extra[e][b])), extra[e][b]);
        }
      }
      counts.blended += static_cast<unsigned>(std::popcount(bitsOf(r.hit)));
      if (!any(t > Lanes(0.0f))) live &= ~(1u << b);
    }
    if (keeps) state.met_blocks[k] = static_cast<std::uint16_t>(met);
  }
  if (keeps) std::fill(state.met_blocks.begin() + k, state.met_blocks.begin() + end, std::uint16_t{0});
  std::copy_n(&transmittance[0][0], 256, &state.transmittance[static_cast<std::size_t>(tile) * 256]);
  for (int b = 0; b < 16; ++b) {
    const Lanes t = abs(load(transmittance[b])), coverage = Lanes(1.0f) - t;
    for (int c = 0; c < 3; ++c) store(fma(t, Lanes(out.background[c]), load(color[c][b])), color[c][b]);
    const Mask covered = coverage > Lanes(1e-6f);
    store(select(covered, load(depth[b]) / max(coverage, Lanes(1e-6f)), Lanes(0.0f)), depth[b]);
    store(coverage, transmittance[b]);
  }
  for (int c = 0; c < 3; ++c) scatterBlocks(place, color[c], out.color->plane(c));
  scatterBlocks(place, transmittance, out.alpha->plane(0));
  if constexpr (kGeometry) {
    for (int c = 0; c < 3; ++c) scatterBlocks(place, normal[c], out.normal->plane(c));
    scatterBlocks(place, depth, out.depth->plane(0));
    scatterBlocks(place, median, out.median_depth->plane(0));
  }
  if constexpr (kExtra > 0) {
    for (int e = 0; e < state.extra_channels; ++e) scatterBlocks(place, extra[e], out.extra->plane(e));
  }
  return counts;
}

// Upstream gradients of a tile and the running "rest": what the Gaussians behind contribute to the loss's
// gradient.
struct TileUpstream {
  alignas(64) BlockArray color[3], normal[3], depth_share, depth_mean, median, rest, transmittance;
  alignas(64) BlockArray extra[kMaxExtra];
};

// depth_share: dL/dD / W of the expected depth. rest starts as the whole blend's q plus the background's
// part.
template <bool kGeometry, bool kExtra>
void loadUpstream(const RasterState& state, int tile, const TilePlace& place, const PassGradients& in,
                  TileUpstream& u) {
  alignas(64) BlockArray image, alpha;
  gatherBlocks(place, in.alpha, 0, alpha);
  std::fill_n(&u.rest[0][0], 256, 0.0f);
  const auto addProduct = [&](const BlockArray& gradient) HWY_ATTR {
    for (int b = 0; b < 16; ++b) store(fma(load(gradient[b]), load(image[b]), load(u.rest[b])), u.rest[b]);
  };
  for (int c = 0; c < 3; ++c) {
    gatherBlocks(place, in.color, c, u.color[c]);
    gatherBlocks(place, in.image_color, c, image);
    addProduct(u.color[c]);
  }
  if constexpr (kGeometry) {
    for (int c = 0; c < 3; ++c) {
      gatherBlocks(place, in.normal, c, u.normal[c]);
      gatherBlocks(place, in.image_normal, c, image);
      addProduct(u.normal[c]);
    }
    gatherBlocks(place, in.depth, 0, u.depth_share);
    gatherBlocks(place, in.median_depth, 0, u.median);
    gatherBlocks(place, in.image_depth, 0, u.depth_mean);
  }
  if constexpr (kExtra) {
    for (int e = 0; e < state.extra_channels; ++e) {
      gatherBlocks(place, in.extra, e, u.extra[e]);
      gatherBlocks(place, in.image_extra, e, image);
      addProduct(u.extra[e]);
    }
  }
  const float* final_t = &state.transmittance[static_cast<std::size_t>(tile) * 256];
  for (int b = 0; b < 16; ++b) {
    const Lanes t = abs(load(final_t + 16 * b)), coverage = Lanes(1.0f) - t;
    store(nfma(load(alpha[b]), t, load(u.rest[b])), u.rest[b]);
    if constexpr (kGeometry) {
      const Mask covered = coverage > Lanes(1e-6f);
      store(keepIf(covered, load(u.depth_share[b]) / max(coverage, Lanes(1e-6f))), u.depth_share[b]);
    }
    store(Lanes(1.0f), u.transmittance[b]);
  }
}

template <bool kGeometry, bool kExtra>
void backwardTile(RasterState& state, const GaussianBuffers& g, int tile, const PassGradients& in) {
  const std::uint32_t begin = state.tile_start[tile], end = state.tile_start[tile + 1];
  if (begin == end) return;
  const TilePlace place = placeOf(state, tile);
  TileUpstream u;
  loadUpstream<kGeometry, kExtra>(state, tile, place, in, u);
  constexpr int kSums = 12 + (kGeometry ? 12 : 0) + (kExtra ? kMaxExtra : 0);
  const float tx = static_cast<float>(place.x0) + 0.5f, ty = static_cast<float>(place.y0) + 0.5f;
  for (std::uint32_t k = begin; k < end; ++k) {
    const TileEntry entry = state.entries[k];
    float* slot = &state.slot_gradients[static_cast<std::size_t>(entry.slot) * state.slot_floats];
    unsigned blocks = state.met_blocks[k];
    if (!blocks) {
      std::fill_n(slot, state.slot_floats, 0.0f);
      continue;
    }
    const ScreenSplat& s = state.splats[entry.splat];
    const float x = s.x - tx, y = s.y - ty;
    __builtin_prefetch(&state.splats[state.entries[std::min(k + 8, end - 1)].splat]);
    Lanes sum[kSums];
    for (Lanes& v : sum) v = Lanes(0.0f);
    for (; blocks; blocks &= blocks - 1) {
      const int b = std::countr_zero(blocks);
      Lanes t = load(u.transmittance[b]);
      const Lanes before = t;
      BlockResponse r = respond(s, x - 4 * (b & 3), y - 4 * (b >> 2), t);
      const Lanes w = weigh(r, t);
      store(t, u.transmittance[b]);
      const Lanes gr = load(u.color[0][b]), gg = load(u.color[1][b]), gb = load(u.color[2][b]);
      Lanes blended = fma(gb, Lanes(s.blue), fma(gg, Lanes(s.green), gr * Lanes(s.red))), q = blended;
      sum[0] = fma(w, gr, sum[0]), sum[1] = fma(w, gg, sum[1]), sum[2] = fma(w, gb, sum[2]);
      if constexpr (kGeometry) {
        const SurfaceSplat& f = state.surfaces[entry.splat];
        const Lanes g0 = load(u.normal[0][b]), g1 = load(u.normal[1][b]), g2 = load(u.normal[2][b]);
        blended = fma(g2, Lanes(f.nz), fma(g1, Lanes(f.ny), fma(g0, Lanes(f.nx), blended)));
        sum[9] = fma(w, g0, sum[9]), sum[10] = fma(w, g1, sum[10]), sum[11] = fma(w, g2, sum[11]);
        const BlockDepth d = depthAt(s, f, r);
        const Lanes share = load(u.depth_share[b]);
        q = fma(share, d.z - load(u.depth_mean[b]), blended);
        const Mask crossing = r.hit & (before > Lanes(0.5f)) & (t <= Lanes(0.5f));
        const Lanes g_z = fma(w, share, keepIf(crossing, load(u.median[b])));
        const Lanes h = keepIf(d.inside, g_z * Lanes(f.inverse_kappa) * d.inverse_d), zh = d.z * h;
        const Lanes zx = zh * r.dx, zy = zh * r.dy;
        sum[12] = sum[12] + h, sum[13] = fma(h, r.dx, sum[13]), sum[14] = fma(h, r.dy, sum[14]);
        sum[15] = sum[15] + zh, sum[16] = sum[16] + zx, sum[17] = sum[17] + zy;
        sum[18] = fma(zx, r.dx, sum[18]), sum[19] = fma(zx, r.dy, sum[19]), sum[20] = fma(zy, r.dy, sum[20]);
      }
      if constexpr (kExtra) {
        constexpr int kFirst = kGeometry ? 21 : 9;
        for (int e = 0; e < state.extra_channels; ++e) {
          const Lanes ge = load(u.extra[e][b]);
          const Lanes part = ge * Lanes(g.plane(PlaneLayout::kExtra + e)[entry.splat]);
          blended = blended + part, q = q + part;
          sum[kFirst + e] = fma(w, ge, sum[kFirst + e]);
        }
      }
      if constexpr (!kGeometry) q = blended;
      const Lanes rest = nfma(w, q, load(u.rest[b]));
      store(rest, u.rest[b]);
      // dL/dalpha = T q - rest / (1 - alpha); no gradient through the clamp at 0.99.
      const Lanes d_alpha = fma(before, q, -(rest / (Lanes(1.0f) - r.alpha)));
      const Lanes v = keepIf(r.hit & (r.alpha < Lanes(kMaxAlpha)), d_alpha * r.response);
      const Lanes vx = v * r.dx, vy = v * r.dy;
      sum[3] = sum[3] + v, sum[4] = sum[4] + vx, sum[5] = sum[5] + vy;
      sum[6] = fma(vx, r.dx, sum[6]), sum[7] = fma(vx, r.dy, sum[7]), sum[8] = fma(vy, r.dy, sum[8]);
    }
    for (int c = 0; c < state.slot_floats; c += 4) sum4(sum[c], sum[c + 1], sum[c + 2], sum[c + 3], slot + c);
  }
}

void weightsTile(const RasterState& state, int tile, std::vector<std::vector<WeightEntry>>& lists) {
  const TilePlace place = placeOf(state, tile);
  alignas(64) BlockArray transmittance;
  std::fill_n(&transmittance[0][0], 256, 1.0f);
  unsigned live = 0xffff;
  const float tx = static_cast<float>(place.x0) + 0.5f, ty = static_cast<float>(place.y0) + 0.5f;
  for (std::uint32_t k = state.tile_start[tile]; k < state.tile_start[tile + 1] && live; ++k) {
    const std::uint32_t index = state.entries[k].splat;
    const ScreenSplat& s = state.splats[index];
    const float x = s.x - tx, y = s.y - ty;
    for (unsigned blocks = touchedBlocks(s, x, y) & live; blocks; blocks &= blocks - 1) {
      const int b = std::countr_zero(blocks);
      Lanes t = load(transmittance[b]);
      BlockResponse r = respond(s, x - 4 * (b & 3), y - 4 * (b >> 2), t);
      alignas(64) float w[16];
      store(weigh(r, t), w);
      store(t, transmittance[b]);
      for (unsigned hits = bitsOf(r.hit); hits; hits &= hits - 1) {
        const int lane = std::countr_zero(hits);
        lists[16 * b + lane].push_back({index, w[lane]});
      }
      if (!any(t > Lanes(0.0f))) live &= ~(1u << b);
    }
  }
}

template <bool kGeometry>
TileCounts forwardOf(RasterState& state, int tile, const PassImages& out) {
  constexpr int kFew = 8;  // base colour, occlusion and roughness are five
  if (state.extra_channels == 0) return forwardTile<kGeometry, 0>(state, tile, out);
  return state.extra_channels <= kFew ? forwardTile<kGeometry, kFew>(state, tile, out)
                                      : forwardTile<kGeometry, kMostExtra>(state, tile, out);
}

TileCounts forwardAny(RasterState& state, int tile, const PassImages& out) {
  return state.geometry ? forwardOf<true>(state, tile, out) : forwardOf<false>(state, tile, out);
}

void backwardAny(RasterState& state, const GaussianBuffers& g, int tile, const PassGradients& in) {
  if (state.extra_channels > 0) {
    return state.geometry ? backwardTile<true, true>(state, g, tile, in)
                          : backwardTile<false, true>(state, g, tile, in);
  }
  return state.geometry ? backwardTile<true, false>(state, g, tile, in)
                        : backwardTile<false, false>(state, g, tile, in);
}

}  // namespace HWY_NAMESPACE
}  // namespace beam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beam {

HWY_EXPORT(forwardAny);
HWY_EXPORT(backwardAny);
HWY_EXPORT(weightsTile);

TileCounts blendTileForward(RasterState& state, int tile, const PassImages& images) {
  return HWY_DYNAMIC_DISPATCH(forwardAny)(state, tile, images);
}

void blendTileBackward(RasterState& state, const GaussianBuffers& gaussians, int tile,
                       const PassGradients& images) {
  HWY_DYNAMIC_DISPATCH(backwardAny)(state, gaussians, tile, images);
}

void blendTileWeights(const RasterState& state, int tile, std::vector<std::vector<WeightEntry>>& lists) {
  HWY_DYNAMIC_DISPATCH(weightsTile)(state, tile, lists);
}

}  // namespace beam
#endif
