// SPDX-License-Identifier: Apache-2.0
#include "core/render/rasterizer.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/render/resident_scene.h"

namespace beam {
namespace {

void require(bool ok, std::string_view what) {
  if (!ok) throw Error(Error::Kind::Bug, fmt::format("rasteriser: {}", what));
}

}  // namespace

Rasterizer::Rasterizer(const RasterDesc& desc) : desc_(desc) {
  require(desc.width > 0 && desc.height > 0, "expected a positive picture size");
  require(desc.width <= 16384 && desc.height <= 16384, "expected at most 16384 pixels a side");
  require(desc.extra_channels >= 0 && desc.extra_channels <= 32, "expected 0 to 32 extra channels");
  require(!desc.gradients || desc.extra_channels <= 16, "expected at most 16 extra channels with gradients");
}

void Rasterizer::requireFitting(const Camera& camera) const {
  require(camera.width == desc_.width && camera.height == desc_.height,
          "the camera has another picture size");
  requirePinhole(camera, "rasteriser");
}

void Rasterizer::forward(const GaussianBuffers& gaussians, const Camera& camera, int sh_degree,
                         vec3 background, RasterImages& images) {
  requireFitting(camera);
  require(gaussians.extra_channels == desc_.extra_channels,
          "the Gaussians have another number of extra channels");
  require(sh_degree >= 0 && sh_degree <= 3, "expected an SH degree of 0 to 3");
  doForward(gaussians, camera, sh_degree, background, images);
  ready_ = desc_.gradients;
}

void Rasterizer::forward(const ResidentScene& scene, std::span<const std::string> extra, const Camera& camera,
                         vec3 background, RasterImages& images) {
  require(!desc_.gradients, "a resident scene has no gradients");
  requireFitting(camera);
  int channels = 0;
  for (const std::string& name : extra) {
    const int own = scene.channelsOf(name);
    require(own > 0, fmt::format("the scene has no attribute \"{}\"", name));
    channels += own;
  }
  require(channels == desc_.extra_channels, "the attributes have another number of channels");
  doForward(scene, extra, camera, background, images);
}

BlendWeights Rasterizer::blendWeights(const GaussianBuffers& gaussians, const Camera& camera) {
  requireFitting(camera);
  return doBlendWeights(gaussians, camera);
}

void Rasterizer::backward(const RasterImages& upstream, GaussianBuffers& gradients) {
  require(ready_, "backward needs a forward with gradients before it");
  doBackward(upstream, gradients);
}

}  // namespace beam
