// SPDX-License-Identifier: Apache-2.0
#include "core/scene/frame_views.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/base/parallel.h"

namespace beam {
namespace {

// Mean of factor x factor blocks, rounded; pixels beyond the last whole block are dropped.
template <class T, class Sum>
Image<T> shrink(const Image<T>& in, int factor) {
  Image<T> out(in.width / factor, in.height / factor, T{}, in.encoding);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      Sum sum{};
      for (int j = 0; j < factor; ++j) {
        for (int i = 0; i < factor; ++i) sum += Sum(in(x * factor + i, y * factor + j));
      }
      out(x, y) = T((sum + Sum(factor * factor / 2)) / Sum(factor * factor));
    }
  }
  return out;
}

}  // namespace

FrameView shrunk(const FrameView& view, int factor) {
  if (factor <= 1) return view;
  return {view.name, scaledDown(view.camera, factor), shrink<u8vec3, ivec3>(view.photo, factor),
          view.mask.empty() ? Image<std::uint8_t>() : shrink<std::uint8_t, int>(view.mask, factor)};
}

FrameView loadFrameView(const CaptureSet& capture, ViewIndex view, FrameIndex frame, int downscale,
                        const Progress& progress) {
  if (progress.stopRequested()) return {};
  const View& v = capture.views[static_cast<std::size_t>(view.value)];
  FrameView full{v.name, v.camera, capture.source->photo(view, frame), {}};
  if (progress.stopRequested()) return {};
  full.mask = capture.source->mask(view, frame);
  return downscale <= 1 ? std::move(full) : shrunk(full, downscale);
}

void judgeFrameViews(const CaptureSet& capture, FrameIndex frame, Split split,
                     const std::vector<std::string>& problems, std::size_t readable) {
  const std::string& name = capture.frames[static_cast<std::size_t>(frame.value)];
  for (std::size_t i = 0; i < problems.size(); ++i) {
    if (!problems[i].empty())
      logWarning("{}; camera {} is left out of frame {}", problems[i], capture.views[i].name, name);
  }
  if (readable < kLeastTrainingCameras && split == Split::Train) {
    throw Error(Error::Kind::Data, fmt::format("expected at least {} readable training pictures of frame {}, "
                                               "found {}; beam check says what is wrong "
                                               "with them",
                                               kLeastTrainingCameras, name, readable));
  }
}

std::vector<FrameView> loadFrameViews(const CaptureSet& capture, FrameIndex frame, Split split, int downscale,
                                      const Progress& progress) {
  std::vector<FrameView> loaded(capture.views.size());
  std::vector<std::string> problems(capture.views.size());
  parallelFor(capture.views.size(), 1, [&](std::size_t i, std::size_t) {
    const ViewIndex index{static_cast<std::int32_t>(i)};
    if (progress.stopRequested() || capture.views[i].split != split || !capture.source->has(index, frame))
      return;
    try {
      loaded[i] = loadFrameView(capture, index, frame, downscale, progress);
    } catch (const Error& e) {
      requireData(e);
      problems[i] = e.what();
    }
  });
  progress.check();
  std::vector<FrameView> views;
  for (FrameView& view : loaded) {
    if (!view.photo.empty()) views.push_back(std::move(view));
  }
  judgeFrameViews(capture, frame, split, problems, views.size());
  return views;
}

}  // namespace beam
