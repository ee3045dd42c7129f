// SPDX-License-Identifier: Apache-2.0
#include "core/work/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include "core/io/image_file.h"
#include "core/math/color.h"
#include "core/method/training_views.h"
#include "core/render/deferred.h"
#include "core/scene/frame_views.h"

namespace beam {
namespace {

constexpr int kSide_px = 320;  // of the whole picture; the crop is smaller
constexpr int kQuality = 85;
constexpr float kDifferenceGain = 4;

template <class Value>
std::vector<std::byte> jpeg(int width, int height, Value&& value) {
  Image<u8vec3> image(width, height, u8vec3(0), Encoding::Srgb);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const vec3 v = value(i);
    image.pixels[i] = u8vec3(byteOf(v.x), byteOf(v.y), byteOf(v.z));
  }
  return encodeJpeg(image, kQuality);
}

vec3 encoded(vec3 v) {
  return {srgbFromLinear(std::clamp(v.x, 0.0f, 1.0f)), srgbFromLinear(std::clamp(v.y, 0.0f, 1.0f)),
          srgbFromLinear(std::clamp(v.z, 0.0f, 1.0f))};
}

void fill(const TrainingView& view, const ResidentScene& scene, bool materials, GBufferRenderer& renderer,
          ContactRow& row) {
  const int w = view.photo.width, h = view.photo.height;
  Planes target;
  compose(view, vec3(0), target);
  const GBuffer g = renderer.render(scene, view.camera);
  const auto photo = [&](std::size_t i) {
    return vec3(target.plane(0)[i], target.plane(1)[i], target.plane(2)[i]);
  };
  const auto add = [&](const char* title, auto&& value) { row.cells.emplace_back(title, jpeg(w, h, value)); };
  add("photograph", photo);
  add("render", [&](std::size_t i) { return g.radiance.pixels[i]; });
  add("difference × 4", [&](std::size_t i) {
    return kDifferenceGain * glm::abs(glm::clamp(g.radiance.pixels[i], 0.0f, 1.0f) - photo(i));
  });
  if (materials) {
    add("base colour", [&](std::size_t i) { return encoded(g.base_color.pixels[i]); });
    add("ambient occlusion", [&](std::size_t i) { return vec3(g.ambient_occlusion.pixels[i]); });
  }
  add("normal", [&](std::size_t i) {
    const vec3 n = g.normal_world.pixels[i];
    return (glm::length(n) < 0.5f ? vec3(0) : 0.5f * n + 0.5f) * g.alpha.pixels[i];
  });
}

// The chosen cameras' pictures of a frame, in the capture's order.
std::vector<std::pair<FrameView, bool>> chosenViews(const CaptureSet& capture, FrameIndex frame,
                                                    const std::vector<std::string>& cameras,
                                                    const Progress& progress) {
  int side = 1;
  for (const View& v : capture.views) side = std::max({side, v.camera.width, v.camera.height});
  const int downscale = std::max(1, side / kSide_px);
  std::vector<std::pair<FrameView, bool>> chosen;
  for (const Split split : {Split::Train, Split::Test}) {
    for (FrameView& v : loadFrameViews(capture, frame, split, downscale, progress)) {
      if (std::find(cameras.begin(), cameras.end(), v.name) == cameras.end()) continue;
      chosen.emplace_back(std::move(v), split == Split::Test);
    }
  }
  return chosen;
}

}  // namespace

std::vector<ContactRow> contactSheet(const GaussianSequence& sequence, const CaptureSet& capture,
                                     const std::vector<FrameIndex>& frames,
                                     const std::vector<std::string>& cameras, ComputeDevice& device,
                                     Progress& progress) {
  std::vector<ContactRow> rows;
  GBufferRenderer renderer(device);
  progress.expect(static_cast<std::int64_t>(frames.size()));
  for (const FrameIndex frame : frames) {
    const std::shared_ptr<const GaussianFrame> result = sequence.load(frame);
    if (result) {
      const auto chosen = chosenViews(capture, frame, cameras, progress);
      std::vector<FrameView> views;
      views.reserve(chosen.size());
      for (const auto& [view, held_out] : chosen) views.push_back(view);
      const std::vector<TrainingView> crops = cropToMasks(views);
      const auto resident = residentOf(device, *result);
      for (std::size_t i = 0; i < crops.size(); ++i) {
        progress.check();
        rows.push_back({nameOf(sequence, frame), views[i].name, chosen[i].second, {}});
        fill(crops[i], *resident, result->materials.has_value(), renderer, rows.back());
      }
    }
    progress.step();
  }
  return rows;
}

}  // namespace beam
