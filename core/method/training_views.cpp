// SPDX-License-Identifier: Apache-2.0
#include "core/method/training_views.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/image/metrics.h"

namespace beam {
namespace {

constexpr int kMargin_px = 12;  // SSIM's window reaches 5 pixels out
constexpr int kRound = 16;

PixelRect subjectRect(const FrameView& v) {
  const bool any =
      std::any_of(v.mask.pixels.begin(), v.mask.pixels.end(), [](std::uint8_t m) { return m > 0; });
  if (!any) return {0, 0, v.photo.width, v.photo.height};
  const PixelRect r = maskBounds(v.mask);
  return {std::max(0, r.x0 - kMargin_px), std::max(0, r.y0 - kMargin_px),
          std::min(v.photo.width, r.x1 + kMargin_px), std::min(v.photo.height, r.y1 + kMargin_px)};
}

// Where a span of `size` pixels that covers [begin, end) starts inside [0, limit).
int placed(int begin, int end, int size, int limit) {
  return std::clamp((begin + end - size) / 2, 0, std::max(0, limit - size));
}

template <class T>
Image<T> cropped(const Image<T>& in, int x0, int y0, int width, int height) {
  if (in.empty()) return {};
  Image<T> out(width, height, T{}, in.encoding);
  for (int y = 0; y < std::min(height, in.height - y0); ++y) {
    const int w = std::min(width, in.width - x0);
    std::copy_n(&in.pixels[in.index(x0, y0 + y)], w, &out.pixels[out.index(0, y)]);
  }
  return out;
}

bool isPremultiplied(const FrameView& v) {
  if (v.mask.empty()) return false;
  std::size_t outside = 0, black = 0;
  for (std::size_t i = 0; i < v.mask.pixels.size(); ++i) {
    if (v.mask.pixels[i] != 0) continue;
    ++outside;
    const u8vec3 p = v.photo.pixels[i];
    black += std::max({p.x, p.y, p.z}) <= 2;
  }
  return outside > 0 && black >= outside - outside / 100;
}

}  // namespace

std::vector<TrainingView> cropToMasks(std::span<const FrameView> views) {
  std::vector<PixelRect> rects;
  int width = 0, height = 0, most_width = 0, most_height = 0;
  for (const FrameView& v : views) {
    rects.push_back(subjectRect(v));
    width = std::max(width, rects.back().x1 - rects.back().x0);
    height = std::max(height, rects.back().y1 - rects.back().y0);
    most_width = std::max(most_width, v.photo.width);
    most_height = std::max(most_height, v.photo.height);
  }
  width = std::min((width + kRound - 1) / kRound * kRound, most_width);
  height = std::min((height + kRound - 1) / kRound * kRound, most_height);
  std::vector<TrainingView> crops;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const FrameView& v = views[i];
    const int x0 = placed(rects[i].x0, rects[i].x1, width, v.photo.width);
    const int y0 = placed(rects[i].y0, rects[i].y1, height, v.photo.height);
    TrainingView t{
        v.camera,           cropped(v.photo, x0, y0, width, height), cropped(v.mask, x0, y0, width, height),
        isPremultiplied(v), std::min(width, v.photo.width - x0),     std::min(height, v.photo.height - y0)};
    t.camera.width = width;
    t.camera.height = height;
    t.camera.intrinsics.cx -= x0;
    t.camera.intrinsics.cy -= y0;
    crops.push_back(std::move(t));
  }
  return crops;
}

void compose(const TrainingView& view, vec3 background, Planes& target) {
  const int w = view.photo.width, h = view.photo.height;
  if (target.width != w || target.height != h || target.channels != 3) target = Planes(w, h, 3);
  parallelFor(static_cast<std::size_t>(h), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * w; i < end * w; ++i) {
      const float a = view.mask.empty() ? 1.0f : view.mask.pixels[i] / 255.0f;
      const vec3 p = vec3(view.photo.pixels[i]) / 255.0f;
      const float keep = view.premultiplied ? 1.0f : a;
      for (int c = 0; c < 3; ++c) target.plane(c)[i] = keep * p[c] + (1 - a) * background[c];
    }
  });
}

void acceptUnknown(const TrainingView& view, const Planes& rendered, Planes& target) {
  if (view.whole()) return;
  for (std::size_t i = 0; i < target.planeSize(); ++i) {
    if (view.knows(i)) continue;
    for (int c = 0; c < 3; ++c) target.plane(c)[i] = rendered.plane(c)[i];
  }
}

double maskLoss(const Planes& alpha, const TrainingView& view, double weight, Planes& gradient) {
  const std::size_t pixels = alpha.planeSize();
  if (gradient.planeSize() != pixels) gradient = Planes(alpha.width, alpha.height, 1);
  if (view.mask.empty()) {
    std::fill(gradient.values.begin(), gradient.values.end(), 0.0f);
    return 0;
  }
  const auto unit = static_cast<float>(weight / static_cast<double>(pixels));
  double sum = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const bool known = view.whole() || view.knows(i);
    const float difference = known ? alpha.values[i] - view.mask.pixels[i] / 255.0f : 0.0f;
    gradient.values[i] = difference > 0 ? unit : difference < 0 ? -unit : 0.0f;
    sum += std::abs(difference);
  }
  return sum * weight / static_cast<double>(pixels);
}

double pixelAtSubject(std::span<const Camera> cameras, std::span<const vec3> points_m) {
  dvec3 middle(0);
  for (const vec3& p : points_m) middle += dvec3(p);
  middle = dvec3(vec3(middle / static_cast<double>(points_m.size())));
  double size = 0;
  for (const Camera& c : cameras) {
    size += glm::length(centerOf(c) - middle) / c.intrinsics.fx / static_cast<double>(cameras.size());
  }
  return size;
}

}  // namespace beam
