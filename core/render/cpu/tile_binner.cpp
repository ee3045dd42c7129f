// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/render/cpu/raster_state.h"

namespace beam {
namespace {

constexpr std::size_t kPiece = 2048;  // Gaussians

}  // namespace

void ellipseSpan(const ScreenSplat& s, float ya, float yb, float& low, float& high) {
  const auto right = [&](float y) {  // largest x with a x^2 + b x y + c y^2 = -limit
    const float by = s.b * y;
    const float discriminant = by * by - 4 * s.a * (s.c * y * y + s.limit);
    return (by + std::sqrt(std::max(discriminant, 0.0f))) * s.inverse_2a;
  };
  high = right(std::min(std::max(s.rightmost_y, ya), yb));
  low = -right(std::min(std::max(s.rightmost_y, -yb), -ya));
}

void TileBinner::run(RasterState& state) {
  sortByDepth(state);
  state.order.assign(order_.begin(), order_.end());
  listTiles(state);
  scatter(state);
}

// Stable radix sort, 3 x 11 bits, of the bits of the positive depths.
void TileBinner::sortByDepth(const RasterState& state) {
  const std::size_t n = state.splats.size();
  order_.resize(n), keys_.resize(n), order_swap_.resize(n), keys_swap_.resize(n);
  std::uint32_t histogram[3][2048] = {};
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = std::bit_cast<std::uint32_t>(state.splats[i].z);
    keys_[i] = k;
    order_[i] = static_cast<std::uint32_t>(i);
    ++histogram[0][k & 2047], ++histogram[1][(k >> 11) & 2047], ++histogram[2][k >> 22];
  }
  for (int pass = 0; pass < 3; ++pass) {
    std::uint32_t sum = 0;
    for (std::uint32_t& h : histogram[pass]) sum += std::exchange(h, sum);
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t to = histogram[pass][(keys_[i] >> (11 * pass)) & 2047]++;
      keys_swap_[to] = keys_[i];
      order_swap_[to] = order_[i];
    }
    keys_.swap(keys_swap_);
    order_.swap(order_swap_);
  }
}

// The tiles that each ellipse touches, Gaussian after Gaussian.
void TileBinner::listTiles(RasterState& state) {
  const std::size_t n = state.splats.size(), count = (n + kPiece - 1) / kPiece;
  if (pieces_.size() < count) pieces_.resize(count);
  state.first_slot.resize(n + 1);
  parallelFor(n, kPiece, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t>& tiles = pieces_[begin / kPiece].tiles;
    tiles.clear();
    for (std::size_t i = begin; i < end; ++i) {
      state.first_slot[i] = static_cast<std::uint32_t>(tiles.size());
      const ScreenSplat& s = state.splats[i];
      if (s.z <= 0) continue;
      const int row0 = std::max(0, static_cast<int>(std::floor((s.y - s.half_height) / kTile)));
      const int row1 =
          std::min(state.tiles_y - 1, static_cast<int>(std::floor((s.y + s.half_height) / kTile)));
      for (int row = row0; row <= row1; ++row) {
        const float top = static_cast<float>(row * kTile) + 0.5f - s.y;
        float low = 0, high = 0;
        ellipseSpan(s, std::max(top, -s.half_height), std::min(top + (kTile - 1), s.half_height), low, high);
        // Pixel centres lie at +0.5.
        const int c0 = std::max(0, static_cast<int>(std::ceil(s.x + low - 0.5f)) >> 4);
        const int c1 = std::min(state.tiles_x - 1, static_cast<int>(std::floor(s.x + high - 0.5f)) >> 4);
        for (int c = c0; c <= c1; ++c) tiles.push_back(static_cast<std::uint32_t>(row * state.tiles_x + c));
      }
    }
  });
  std::uint32_t total = 0;
  for (std::size_t p = 0; p < count; ++p) {
    const std::size_t end = std::min(n, (p + 1) * kPiece);
    for (std::size_t i = p * kPiece; i < end; ++i) state.first_slot[i] += total;
    total += static_cast<std::uint32_t>(pieces_[p].tiles.size());
  }
  state.first_slot[n] = total;
  slot_tile_.resize(total);
  parallelFor(count, 1, [&](std::size_t p, std::size_t) {
    const std::vector<std::uint32_t>& tiles = pieces_[p].tiles;
    if (!tiles.empty())
      std::copy(tiles.begin(), tiles.end(), slot_tile_.begin() + state.first_slot[p * kPiece]);
  });
}

void TileBinner::scatter(RasterState& state) {
  const std::size_t tiles = static_cast<std::size_t>(state.tiles_x) * state.tiles_y;
  state.tile_start.assign(tiles + 1, 0);
  for (const std::uint32_t t : slot_tile_) ++state.tile_start[t + 1];
  for (std::size_t t = 0; t < tiles; ++t) state.tile_start[t + 1] += state.tile_start[t];
  cursor_.assign(state.tile_start.begin(), state.tile_start.end() - 1);
  state.entries.resize(slot_tile_.size());
  for (const std::uint32_t i : state.order) {
    for (std::uint32_t slot = state.first_slot[i]; slot < state.first_slot[i + 1]; ++slot) {
      state.entries[cursor_[slot_tile_[slot]]++] = {i, slot};
    }
  }
}

}  // namespace beam
