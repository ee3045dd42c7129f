// SPDX-License-Identifier: Apache-2.0
// Differentiable, depth-sorted rasteriser of Gaussians (methods 1.3-1.9, 2.2-2.5). The base class checks
// everything once; a backend only schedules. One object serves one picture size and pinhole cameras; forward
// must precede backward.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/render/gaussian_buffers.h"
#include "core/scene/camera.h"

namespace beam {

class ResidentScene;

struct RasterDesc {
  int width = 0, height = 0;  // pixels
  bool color = true;          // spherical harmonics to rgb
  bool geometry = false;      // expected depth, median depth, normal
  int extra_channels = 0;     // further blended floats a Gaussian, [0, 32]; [0, 16] with gradients
  bool gradients = false;     // backward will be called
  float dilation_px2 =
      0;  // k added to the 2D covariance's diagonal (methods 1.3); 0: the 3D filter is in the scales
  bool operator==(const RasterDesc&) const = default;
};

// Pictures of one view. Planes that the description does not ask for stay empty. As upstream gradients the
// same struct holds dL/d(plane); an empty plane is a zero gradient.
struct RasterImages {
  Planes color;         // 3: sum w c + T background, c = max(0, 0.5 + SH)
  Planes alpha;         // 1: sum w = 1 - T
  Planes depth;         // 1: expected z, (sum w z) / (sum w); 0 where nothing
  Planes median_depth;  // 1: z of the Gaussian at which T falls to 0.5; 0 where it stays above
  Planes
      normal;  // 3: sum w n in camera axes, not normalised; n = -normalize(Sigma_c^-1 t), towards the camera
  Planes extra;  // extra_channels: sum w x
};

// What a forward pass did, for benchmarks and gates; independent of the machine.
struct RasterCounts {
  std::uint64_t keys = 0;             // (Gaussian, 16x16 tile) pairs
  std::uint64_t pairs_evaluated = 0;  // (Gaussian, pixel) pairs whose alpha was computed
  std::uint64_t pairs_blended = 0;    // of these with alpha >= 1/255 before the pixel was opaque
};

// Blend weights of one view, pixel after pixel, front to back: pixel p owns entries [first[p], first[p + 1]).
struct BlendWeights {
  int width = 0, height = 0;
  std::vector<std::uint32_t> first;     // width * height + 1
  std::vector<std::uint32_t> gaussian;  // index in the cloud
  std::vector<float> weight;            // alpha * transmittance
};

class Rasterizer {
 public:
  explicit Rasterizer(const RasterDesc& desc);  // throws Error{Bug} on nonsense
  virtual ~Rasterizer() = default;
  const RasterDesc& desc() const { return desc_; }

  // `gaussians` holds physical values; SH above `sh_degree` (0 to 3) is ignored. Images are resized as
  // needed. `background`: what shows through, in the units of the colour.
  void forward(const GaussianBuffers& gaussians, const Camera& camera, int sh_degree, vec3 background,
               RasterImages& images);

  // Gaussians that the device holds, with all their SH; for pictures, never for gradients. `extra`: names of
  // attributes of the scene whose channels, in this order, are the extra ones; SH is seen from the camera,
  // not clamped. Throws Error{Bug} when the scene lacks one, is of another device, or their channels are not
  // as many as described.
  void forward(const ResidentScene& scene, std::span<const std::string> extra, const Camera& camera,
               vec3 background, RasterImages& images);

  // dL/d(physical values), by central-difference-tested chain rule; overwrites `gradients` (same layout as
  // the Gaussians). Uses the state of the last forward, whose Gaussians must still be alive and unchanged.
  void backward(const RasterImages& upstream, GaussianBuffers& gradients);

  // Per-Gaussian facts of the last forward: bounding radius in pixels, 0 = not drawn. size = count.
  virtual const AlignedVector<float>& screenRadius() const = 0;
  virtual RasterCounts counts() const = 0;

  // Runs a forward pass of geometry only and lists every blend weight.
  BlendWeights blendWeights(const GaussianBuffers& gaussians, const Camera& camera);

 private:
  void requireFitting(const Camera& camera) const;
  virtual void doForward(const GaussianBuffers& gaussians, const Camera& camera, int sh_degree,
                         vec3 background, RasterImages& images) = 0;
  virtual void doForward(const ResidentScene& scene, std::span<const std::string> extra, const Camera& camera,
                         vec3 background, RasterImages& images) = 0;
  virtual BlendWeights doBlendWeights(const GaussianBuffers& gaussians, const Camera& camera) = 0;
  virtual void doBackward(const RasterImages& upstream, GaussianBuffers& gradients) = 0;

  RasterDesc desc_;
  bool ready_ = false;  // a forward with gradients was run
};

}  // namespace beam
