// SPDX-License-Identifier: Apache-2.0
#include "core/method/left_out.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/count_text.h"
#include "core/scene/frame_list.h"

namespace beam {
namespace {

void add(const ScoredFrame& frame, FitQuality& q) {
  const SplitScore fitted = meanOf(frame.views, false), held_out = meanOf(frame.views, true);
  if (fitted.n > 0) q.fitted += fitted.mean.psnr, ++q.frames;
  if (held_out.n > 0) q.held_out += held_out.mean.psnr, ++q.held_out_frames;
}

void divide(FitQuality& q) {
  q.fitted /= std::max(1, q.frames);
  q.held_out /= std::max(1, q.held_out_frames);
}

std::string figures(const FitQuality& q) {
  std::string text = fmt::format("{:.2f} dB over the fitted views", q.fitted);
  if (q.held_out_frames > 0) text += fmt::format(" and {:.2f} dB over the held-out views", q.held_out);
  return text;
}

}  // namespace

std::vector<LeftOutCamera> collectLeftOut(std::span<const ScreenedFrame> frames) {
  std::map<std::pair<std::string, ScreenKind>, LeftOutCamera> found;
  for (const ScreenedFrame& f : frames) {
    for (const ScreenedView& v : f.left_out) {
      LeftOutCamera& c = found[{v.camera, v.kind}];
      // The least figure of a blurred or black picture is the worst one.
      const bool worse = v.kind == ScreenKind::Outline ? v.figure > c.figure : v.figure < c.figure;
      if (c.frames.empty() || worse) c.text = v.text, c.figure = v.figure;
      c.camera = v.camera, c.kind = v.kind;
      c.frames.push_back(f.name);
      c.indices.push_back(f.index);
    }
  }
  std::vector<LeftOutCamera> list;
  list.reserve(found.size());
  for (auto& [key, camera] : found) list.push_back(std::move(camera));
  return list;
}

std::string toText(const LeftOutCamera& c, std::span<const Defect> defects) {
  std::string why = c.text;
  for (const Defect& d : defects) {
    if (c.kind != ScreenKind::Outline || d.camera != c.camera || d.kind != DefectKind::Late) continue;
    why += fmt::format("; it {}", d.text.substr(0, d.text.find(':')));
  }
  return fmt::format("camera {} in {} {}: {}", c.camera, nounText(c.frames.size(), "frame"),
                     fmt::join(frameRanges(c.frames, c.indices), ", "), why);
}

LeftOutLoss lossOf(std::span<const ScoredFrame> frames) {
  LeftOutLoss loss;
  for (const ScoredFrame& f : frames) {
    int fitted = 0, left_out = f.missing_training;
    for (const ViewScore& v : f.views) {
      left_out += v.left_out;
      fitted += !v.left_out && !v.held_out;
    }
    add(f, left_out > 0 ? loss.incomplete : loss.complete);
    if (left_out == 0 || (loss.of > 0 && fitted >= loss.least_fitted)) continue;
    loss.least_fitted = fitted;
    loss.of = fitted + left_out;
  }
  divide(loss.incomplete);
  divide(loss.complete);
  return loss;
}

std::string toText(const LeftOutLoss& loss) {
  if (loss.of == 0) return {};
  std::string text = fmt::format("{} fitted with cameras left out, from at least {} of {}: mean PSNR {}",
                                 countText(loss.incomplete.frames, "frame was", "frames were"),
                                 loss.least_fitted, countText(loss.of, "view"), figures(loss.incomplete));
  if (loss.complete.frames == 0)
    return text + ". No solved frame is complete, so there is none of this take to compare with.";
  text += fmt::format("; {} with every camera: {}", countText(loss.complete.frames, "frame"),
                      figures(loss.complete));
  if (loss.incomplete.held_out_frames > 0 && loss.complete.held_out_frames > 0) {
    const double gain = std::round(100 * (loss.incomplete.held_out - loss.complete.held_out)) / 100;
    text += gain < 0 ? fmt::format(". The loss shows in the held-out views: {:+.2f} dB", gain)
                     : fmt::format(". The held-out views show no loss: {:+.2f} dB", std::abs(gain));
  } else {
    text += ". Without held-out cameras (--hold-out) the loss where no camera looks is not known";
  }
  return text + "; the frames show other poses, which is a part of the difference.";
}

}  // namespace beam
