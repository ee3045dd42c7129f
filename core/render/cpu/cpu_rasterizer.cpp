// SPDX-License-Identifier: Apache-2.0
#include "core/render/cpu/cpu_rasterizer.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/render/cpu/cpu_resident_scene.h"
#include "core/render/cpu/raster_state.h"

namespace beam {
namespace {

constexpr std::size_t kGaussianGrain = 2048;
constexpr std::size_t kTileGrain = 2;

void size(Planes& p, int width, int height, int channels) {
  if (p.width != width || p.height != height || p.channels != channels) p = Planes(width, height, channels);
}

RasterCameraConstants constantsOf(const Camera& camera, float dilation_px2) {
  const dmat3 r = glm::mat3_cast(camera.camera_from_world.rotation);
  const dvec3 center = centerOf(camera);
  RasterCameraConstants c{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) c.rotation[3 * row + column] = r[column][row];
    c.translation[row] = camera.camera_from_world.translation_m[row];
    c.center[row] = center[row];
  }
  c.intrinsics = camera.intrinsics;
  c.width = camera.width;
  c.height = camera.height;
  c.dilation_px2 = dilation_px2;
  return c;
}

class CpuRasterizer final : public Rasterizer {
 public:
  explicit CpuRasterizer(const RasterDesc& desc) : Rasterizer(desc) {
    state_.tiles_x = (desc.width + kTile - 1) / kTile;
    state_.tiles_y = (desc.height + kTile - 1) / kTile;
    state_.color = desc.color;
    state_.geometry = desc.geometry;
    state_.extra_channels = desc.extra_channels;
    const int sums = (desc.geometry ? 21 : 9) + desc.extra_channels;
    state_.slot_floats = (sums + 3) / 4 * 4;
    state_.transmittance.resize(tiles() * 256);
    counts_.resize(tiles());
  }

  const AlignedVector<float>& screenRadius() const override { return state_.radius; }

  RasterCounts counts() const override {
    RasterCounts c;
    c.keys = state_.entries.size();
    for (const TileCounts& t : counts_) c.pairs_evaluated += t.evaluated, c.pairs_blended += t.blended;
    return c;
  }

  BlendWeights doBlendWeights(const GaussianBuffers& gaussians, const Camera& camera) override {
    prepare(gaussians, camera, 0);
    BlendWeights out;
    out.width = desc().width;
    out.height = desc().height;
    const std::size_t pixels = static_cast<std::size_t>(out.width) * out.height;
    std::vector<std::vector<std::vector<WeightEntry>>> lists(tiles());
    parallelFor(tiles(), kTileGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        lists[t].resize(kTile * kTile);
        blendTileWeights(state_, static_cast<int>(t), lists[t]);
      }
    });
    out.first.assign(pixels + 1, 0);
    const auto listOf = [&](std::size_t p) -> const std::vector<WeightEntry>& {
      const int x = static_cast<int>(p % out.width), y = static_cast<int>(p / out.width);
      const int block = (y % kTile / 4) * 4 + x % kTile / 4, lane = (y & 3) * 4 + (x & 3);
      return lists[static_cast<std::size_t>(y / kTile) * state_.tiles_x + x / kTile][16 * block + lane];
    };
    for (std::size_t p = 0; p < pixels; ++p) {
      out.first[p + 1] = out.first[p] + static_cast<std::uint32_t>(listOf(p).size());
    }
    out.gaussian.resize(out.first.back());
    out.weight.resize(out.first.back());
    parallelFor(pixels, 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        std::size_t to = out.first[p];
        for (const WeightEntry& e : listOf(p)) out.gaussian[to] = e.gaussian, out.weight[to++] = e.weight;
      }
    });
    return out;
  }

 private:
  std::size_t tiles() const { return static_cast<std::size_t>(state_.tiles_x) * state_.tiles_y; }

  void prepare(const GaussianBuffers& gaussians, const Camera& camera, int sh_degree) {
    const std::size_t n = gaussians.count;
    state_.camera = constantsOf(camera, desc().dilation_px2);
    state_.sh_degree = sh_degree;
    state_.splats.resize(n);
    state_.radius.resize(n);
    if (state_.geometry) state_.surfaces.resize(n);
    parallelFor(n, kGaussianGrain,
                [&](std::size_t begin, std::size_t end) { projectSplats(gaussians, state_, begin, end); });
    binner_.run(state_);
  }

  void doForward(const GaussianBuffers& gaussians, const Camera& camera, int sh_degree, vec3 background,
                 RasterImages& images) override {
    std::vector<const float*> extra;
    for (int e = 0; e < state_.extra_channels; ++e) extra.push_back(gaussians.plane(PlaneLayout::kExtra + e));
    draw(gaussians, extra, camera, sh_degree, background, images);
    if (desc().gradients) keepPictures(images);
  }

  void doForward(const ResidentScene& scene, std::span<const std::string> names, const Camera& camera,
                 vec3 background, RasterImages& images) override {
    const auto* resident = dynamic_cast<const CpuResidentScene*>(&scene);
    if (!resident) throw Error(Error::Kind::Bug, "rasteriser: the scene is resident on another device");
    const std::vector<const float*> extra = resident->seenFrom(vec3(centerOf(camera)), names, extra_seen_);
    draw(resident->gaussians(), extra, camera, 3, background, images);
  }

  void draw(const GaussianBuffers& gaussians, const std::vector<const float*>& extra, const Camera& camera,
            int sh_degree, vec3 background, RasterImages& images) {
    gaussians_ = &gaussians;
    prepare(gaussians, camera, sh_degree);
    const int w = desc().width, h = desc().height;
    size(images.color, w, h, 3);
    size(images.alpha, w, h, 1);
    if (state_.geometry) {
      size(images.depth, w, h, 1);
      size(images.median_depth, w, h, 1);
      size(images.normal, w, h, 3);
    }
    if (state_.extra_channels > 0) size(images.extra, w, h, state_.extra_channels);
    PassImages pass{&images.color,
                    &images.alpha,
                    &images.depth,
                    &images.median_depth,
                    &images.normal,
                    &images.extra,
                    {background.x, background.y, background.z},
                    {}};
    std::copy(extra.begin(), extra.end(), pass.extra_values);
    if (desc().gradients) state_.met_blocks.resize(state_.entries.size());
    parallelFor(tiles(), kTileGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        counts_[t] = blendTileForward(state_, static_cast<int>(t), pass);
      }
    });
  }

  // The backward pass starts from the blended pictures; the caller may reuse its own.
  void keepPictures(const RasterImages& images) {
    color_ = images.color;
    if (state_.geometry) depth_ = images.depth, normal_ = images.normal;
    if (state_.extra_channels > 0) extra_ = images.extra;
  }

  void doBackward(const RasterImages& upstream, GaussianBuffers& gradients) override {
    const GaussianBuffers& g = *gaussians_;
    if (gradients.count != g.count || gradients.extra_channels != g.extra_channels) {
      gradients = GaussianBuffers(g.count, g.extra_channels);
    }
    state_.slot_gradients.resize(state_.entries.size() * state_.slot_floats);
    const PassGradients pass{&upstream.color,  &upstream.alpha, &upstream.depth, &upstream.median_depth,
                             &upstream.normal, &upstream.extra, &color_,         &depth_,
                             &normal_,         &extra_};
    parallelFor(tiles(), kTileGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) blendTileBackward(state_, g, static_cast<int>(t), pass);
    });
    parallelFor(g.count, kGaussianGrain, [&](std::size_t begin, std::size_t end) {
      chainGradients(g, state_, begin, end, gradients);
    });
  }

  RasterState state_;
  TileBinner binner_;
  std::vector<TileCounts> counts_;
  const GaussianBuffers* gaussians_ = nullptr;
  Planes color_, depth_, normal_, extra_;
  AlignedVector<float> extra_seen_;
};

}  // namespace

std::unique_ptr<Rasterizer> makeCpuRasterizer(const RasterDesc& desc) {
  return std::make_unique<CpuRasterizer>(desc);
}

}  // namespace beam
