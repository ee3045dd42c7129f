// SPDX-License-Identifier: Apache-2.0
#include "core/image/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"

namespace beam {
namespace {

constexpr int kBorder = kSsimWindow_px - 1;
constexpr int kBand = 64;  // rows of windows that are in memory at a time

using Window = std::array<double, kSsimWindow_px>;

Window gaussianWindow() {
  Window k{};
  double sum = 0;
  for (int i = 0; i < kSsimWindow_px; ++i) sum += k[i] = std::exp(-(i - 5) * (i - 5) / 4.5);
  for (double& v : k) v /= sum;
  return k;
}

// Filters a w x h field and keeps the windows that lie inside: (w - kBorder) x (h - kBorder).
std::vector<double> blurInside(const std::vector<double>& in, int w, int h) {
  static const Window k = gaussianWindow();
  const int ow = w - kBorder, oh = h - kBorder;
  std::vector<double> rows(static_cast<std::size_t>(ow) * h), out(static_cast<std::size_t>(ow) * oh);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < ow; ++x) {
      double s = 0;
      for (int i = 0; i < kSsimWindow_px; ++i) s += k[i] * in[static_cast<std::size_t>(y) * w + x + i];
      rows[static_cast<std::size_t>(y) * ow + x] = s;
    }
  }
  for (int y = 0; y < oh; ++y) {
    for (int x = 0; x < ow; ++x) {
      double s = 0;
      for (int i = 0; i < kSsimWindow_px; ++i) s += k[i] * rows[static_cast<std::size_t>(y + i) * ow + x];
      out[static_cast<std::size_t>(y) * ow + x] = s;
    }
  }
  return out;
}

std::vector<double> crop(const Planes& p, int channel, PixelRect r) {
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>(r.x1 - r.x0) * (r.y1 - r.y0));
  for (int y = r.y0; y < r.y1; ++y) {
    const float* row = p.plane(channel) + static_cast<std::size_t>(y) * p.width;
    out.insert(out.end(), row + r.x0, row + r.x1);
  }
  return out;
}

// Adds the windows that start in the rows of `r` that have ten more below them, row by row.
void addSsim(const Planes& p, const Planes& q, int channel, PixelRect r, double& sum) {
  const std::vector<double> a = crop(p, channel, r), b = crop(q, channel, r);
  const int w = r.x1 - r.x0, h = r.y1 - r.y0;
  const auto product = [](const std::vector<double>& u, const std::vector<double>& v) {
    std::vector<double> out(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) out[i] = u[i] * v[i];
    return out;
  };
  const std::vector<double> ma = blurInside(a, w, h), mb = blurInside(b, w, h),
                            aa = blurInside(product(a, a), w, h), bb = blurInside(product(b, b), w, h),
                            ab = blurInside(product(a, b), w, h);
  constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
  for (std::size_t i = 0; i < ma.size(); ++i) {
    const double va = aa[i] - ma[i] * ma[i], vb = bb[i] - mb[i] * mb[i], cab = ab[i] - ma[i] * mb[i];
    sum +=
        (2 * ma[i] * mb[i] + c1) * (2 * cab + c2) / ((ma[i] * ma[i] + mb[i] * mb[i] + c1) * (va + vb + c2));
  }
}

// [begin, end) with at least a window's pixels of [0, limit), as many before it as behind.
void growToWindow(int& begin, int& end, int limit) {
  const int size = std::min(std::max(end - begin, kSsimWindow_px), limit);
  begin = std::clamp(begin - (size - (end - begin)) / 2, 0, limit - size);
  end = begin + size;
}

}  // namespace

double psnr(const Planes& a, const Planes& b, PixelRect rect) {
  double sum = 0;
  std::size_t count = 0;
  for (int c = 0; c < a.channels; ++c) {
    const std::vector<double> p = crop(a, c, rect), q = crop(b, c, rect);
    for (std::size_t i = 0; i < p.size(); ++i) sum += (p[i] - q[i]) * (p[i] - q[i]);
    count += p.size();
  }
  const double mse = sum / static_cast<double>(count);
  return mse <= 0 ? 100.0 : std::min(100.0, -10 * std::log10(mse));
}

std::optional<double> ssim(const Planes& a, const Planes& b, PixelRect rect, const Progress& progress) {
  const int rows = rect.y1 - rect.y0 - kBorder, columns = rect.x1 - rect.x0 - kBorder;
  if (rows < 1 || columns < 1) return std::nullopt;
  const double windows = static_cast<double>(rows) * columns;
  double mean = 0;
  for (int c = 0; c < a.channels; ++c) {
    double sum = 0;
    for (int y = 0; y < rows && !progress.stopRequested(); y += kBand) {
      const int end = std::min(rows, y + kBand);
      addSsim(a, b, c, {rect.x0, rect.y0 + y, rect.x1, rect.y0 + end + kBorder}, sum);
    }
    mean += sum / windows;
  }
  return mean / a.channels;
}

PixelRect maskBounds(const Image<std::uint8_t>& mask) {
  PixelRect r{mask.width, mask.height, 0, 0};
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (mask(x, y) == 0) continue;
      r = {std::min(r.x0, x), std::min(r.y0, y), std::max(r.x1, x + 1), std::max(r.y1, y + 1)};
    }
  }
  if (r.x1 <= r.x0)
    throw Error(Error::Kind::Data, "the ground-truth mask is empty: there is nothing to score");
  growToWindow(r.x0, r.x1, mask.width);
  growToWindow(r.y0, r.y1, mask.height);
  return r;
}

}  // namespace beam
