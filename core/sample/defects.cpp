// SPDX-License-Identifier: Apache-2.0
#include "core/sample/defects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace beam {
namespace {

using Kind = SampleDefect::Kind;

constexpr int kLate_frames = 3, kDropEvery = 4, kDropFirst = 2;
constexpr float kBlurOfHeight = 1.0f / 80;

struct KindName {
  Kind kind;
  const char *name, *camera;
};
constexpr KindName kKinds[] = {{Kind::Dropped, "dropped", "cam01"},
                               {Kind::Late, "late", "cam03"},
                               {Kind::Blurred, "blurred", "cam05"},
                               {Kind::Black, "black", "cam07"}};

Image<vec3> blurredRows(const Image<vec3>& in, const std::vector<float>& weight) {
  Image<vec3> out(in.height, in.width, vec3(0), in.encoding);  // transposed
  const int reach = static_cast<int>(weight.size()) - 1;
  for (int y = 0; y < in.height; ++y) {
    for (int x = 0; x < in.width; ++x) {
      for (int k = -reach; k <= reach; ++k)
        out(y, x) += weight[std::abs(k)] * in(std::clamp(x + k, 0, in.width - 1), y);
    }
  }
  return out;
}

}  // namespace

SampleDefect parseDefect(const std::string& text) {
  const std::size_t colon = text.find(':');
  for (const KindName& k : kKinds) {
    if (text.substr(0, colon) != k.name) continue;
    return {k.kind, colon == std::string::npos ? k.camera : text.substr(colon + 1)};
  }
  throw Error(Error::Kind::Usage,
              fmt::format("--defect expects dropped, late, blurred or black, with a camera if wanted "
                          "(late:cam03), found \"{}\"",
                          text));
}

std::string nameOf(const SampleDefect& d) {
  const auto* k =
      std::find_if(std::begin(kKinds), std::end(kKinds), [&](const KindName& n) { return n.kind == d.kind; });
  return fmt::format("{}:{}", k->name, d.camera);
}

bool SampleDefects::has(const std::string& camera, Kind kind) const {
  return std::any_of(list_.begin(), list_.end(),
                     [&](const SampleDefect& d) { return d.kind == kind && d.camera == camera; });
}

std::vector<int> SampleDefects::shownIn(const std::string& camera, int frame) const {
  const int late = has(camera, Kind::Late) ? kLate_frames : 0;
  std::vector<int> out;
  // Before it has anything else to show a late camera shows the first frame.
  for (int f = frame == 0 ? 0 : frame + late; f <= std::min(frame + late, frames_ - 1); ++f) {
    if (has(camera, Kind::Dropped) && f % kDropEvery == kDropFirst) continue;
    out.push_back(f);
  }
  return out;
}

bool SampleDefects::black(const std::string& camera, int frame) const {
  return frame == frames_ / 2 && has(camera, Kind::Black);
}

std::vector<std::string> SampleDefects::names() const {
  std::vector<std::string> out;
  for (const SampleDefect& d : list_) out.push_back(nameOf(d));
  return out;
}

Image<vec3> outOfFocus(const Image<vec3>& linear) {
  const float deviation = kBlurOfHeight * static_cast<float>(linear.height);
  std::vector<float> weight;
  float sum = 0;
  for (int k = 0; k <= static_cast<int>(std::ceil(3 * deviation)); ++k) {
    const float x = static_cast<float>(k) / deviation;
    weight.push_back(std::exp(-0.5f * x * x));
    sum += (k == 0 ? 1 : 2) * weight.back();
  }
  for (float& w : weight) w /= sum;
  return blurredRows(blurredRows(linear, weight), weight);
}

}  // namespace beam
