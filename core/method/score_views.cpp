// SPDX-License-Identifier: Apache-2.0
#include "core/method/score_views.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/method/training_views.h"
#include "core/render/deferred.h"

namespace beam {
namespace {

constexpr std::size_t kTogether = 8;  // views that are in memory as floats, 24 bytes a pixel

// As it comes back from a PNG.
float rounded(float v) { return static_cast<float>(byteOf(v)) / 255.0f; }

Planes planesOf(const Image<vec3>& image) {
  Planes p(image.width, image.height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) p.plane(c)[i] = rounded(image.pixels[i][c]);
  }
  return p;
}

Image<float> lumaOf(const Planes& p) {
  Image<float> luma(p.width, p.height);
  for (std::size_t i = 0; i < luma.pixels.size(); ++i) {
    luma.pixels[i] = luminance({p.plane(0)[i], p.plane(1)[i], p.plane(2)[i]});
  }
  return luma;
}

double meanInside(const Image<float>& luma, const Image<std::uint8_t>& mask) {
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < luma.pixels.size(); ++i) {
    if (mask.pixels[i] >= kInside) sum += luma.pixels[i], ++n;
  }
  return n > 0 ? sum / n : 0;
}

// Only where all neighbours are inside: the outline is the mask's, not the lens's.
double sharpnessInside(const Image<float>& luma, const Image<std::uint8_t>& mask) {
  double sum = 0, n = 0;
  for (int y = 1; y + 1 < luma.height; ++y) {
    for (int x = 1; x + 1 < luma.width; ++x) {
      if (std::min({mask(x, y), mask(x - 1, y), mask(x + 1, y), mask(x, y - 1), mask(x, y + 1)}) < kInside)
        continue;
      sum += std::abs(4 * luma(x, y) - luma(x - 1, y) - luma(x + 1, y) - luma(x, y - 1) - luma(x, y + 1));
      ++n;
    }
  }
  return n > 0 ? sum / n : 0;
}

// `luma` is the part of a width x height picture that starts at (x0, y0).
Image<std::uint8_t> thumbOf(const Image<float>& luma, int x0, int y0, int width, int height) {
  const int cell = std::max(1, (std::max(width, height) + kThumbSide_px - 1) / kThumbSide_px);
  Image<float> sum(kThumbSide_px, kThumbSide_px);
  for (int y = 0; y < luma.height; ++y) {
    for (int x = 0; x < luma.width; ++x) {
      const int i = (x + x0) / cell, j = (y + y0) / cell;
      if (i < kThumbSide_px && j < kThumbSide_px) sum(i, j) += luma(x, y);
    }
  }
  Image<std::uint8_t> thumb(kThumbSide_px, kThumbSide_px);
  const float scale = 255.0f / static_cast<float>(cell * cell);
  for (std::size_t i = 0; i < thumb.pixels.size(); ++i) {
    thumb.pixels[i] = static_cast<std::uint8_t>(std::min(255.0f, sum.pixels[i] * scale + 0.5f));
  }
  return thumb;
}

Image<std::uint8_t> countedPixels(const TrainingView& view) {
  const bool any =
      std::any_of(view.mask.pixels.begin(), view.mask.pixels.end(), [](std::uint8_t m) { return m > 0; });
  return any ? view.mask : Image<std::uint8_t>(view.photo.width, view.photo.height, 255);
}

// Of no meaning when a stop is requested.
ViewScore scoreOf(const FrameView& whole, const TrainingView& crop, const Planes& photo, const Planes& render,
                  const Progress& progress) {
  const Image<std::uint8_t> mask = countedPixels(crop);
  const Image<float> photo_luma = lumaOf(photo), render_luma = lumaOf(render);
  const Intrinsics &k = whole.camera.intrinsics, &cut = crop.camera.intrinsics;
  const int x0 = static_cast<int>(std::lround(k.cx - cut.cx)),
            y0 = static_cast<int>(std::lround(k.cy - cut.cy));
  ViewScore s;
  s.camera = whole.name;
  s.score = scorePicture(render, photo, mask, progress);
  if (progress.stopRequested()) return s;
  s.photo_luma = meanInside(photo_luma, mask);
  s.render_luma = meanInside(render_luma, mask);
  s.photo_sharpness = sharpnessInside(photo_luma, mask);
  s.render_sharpness = sharpnessInside(render_luma, mask);
  s.photo_thumb = thumbOf(photo_luma, x0, y0, whole.photo.width, whole.photo.height);
  s.render_thumb = thumbOf(render_luma, x0, y0, whole.photo.width, whole.photo.height);
  return s;
}

}  // namespace

std::vector<ViewScore> scoreViews(std::span<const FrameView> views, bool held_out, const GaussianCloud& cloud,
                                  ComputeDevice& device, Progress& progress) {
  if (views.empty()) return {};
  progress.expect(static_cast<std::int64_t>(views.size()), "photographs");
  const std::vector<TrainingView> crops = cropToMasks(views);
  GBufferRenderer renderer(device);
  const auto resident = residentOf(device, cloud, nullptr);
  std::vector<ViewScore> scores(crops.size());
  std::vector<Planes> photos(std::min(kTogether, crops.size())), renders(photos.size());
  for (std::size_t first = 0; first < crops.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, crops.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      compose(crops[first + i], vec3(0), photos[i]);
      renders[i] = planesOf(renderer.render(*resident, crops[first + i].camera).radiance);
      progress.step();
    }
    parallelFor(count, 1, [&](std::size_t i, std::size_t) {
      if (progress.stopRequested()) return;
      for (float& v : photos[i].values) v = rounded(v);
      scores[first + i] = scoreOf(views[first + i], crops[first + i], photos[i], renders[i], progress);
      scores[first + i].held_out = held_out;
    });
    progress.check();
  }
  return scores;
}

SplitScore meanOf(std::span<const ViewScore> scores, bool held_out) {
  SplitScore s;
  std::vector<PictureScore> of_split;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (scores[i].held_out != held_out || scores[i].left_out) continue;
    const PictureScore& p = scores[i].score;
    of_split.push_back(p);
    if (s.n == 0 || p.psnr < scores[s.worst].score.psnr) s.worst = i;
    ++s.n;
  }
  s.mean = meanOf(of_split);
  return s;
}

}  // namespace beam
