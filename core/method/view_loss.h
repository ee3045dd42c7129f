// SPDX-License-Identifier: Apache-2.0
// The loss of one view: its photograph on a background, E_color of BEAM eq. 8 with the mask term of methods
// 3.8, and E_normal where it is asked for. In three steps, so that more than Gaussians can learn from a
// picture: `draw` gives it, `compare` its loss and dL/d(picture), `backward` dL/d(Gaussians). What stands
// between the Gaussians and the photograph (a colour matrix, a curve) changes `images()` after `draw`, and
// `upstream()` by its transpose after `compare`.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/method/training_views.h"
#include "core/render/device.h"

namespace beam {

struct ViewLossOptions {
  double ssim_weight = 0.2;           // lambda of eq. 8
  double mask_weight = 0.1;           // methods 3.8
  double normal_weight = 0.03;        // lambda_normal, BEAM 3.1
  double expected_depth_share = 0.4;  // of E_normal (methods 2.7)
  int seed = 1;                       // of the order of views and of the backgrounds
};

// Means over the crop, weighted; all >= 0 but E_normal's, which may fall below by rounding.
struct PictureLoss {
  double photometric = 0;  // (1 - lambda) L1 + lambda (1 - SSIM), sRGB values in [0, 1]
  double mask = 0;
  double normal = 0;  // 0 without geometry
  double total() const { return photometric + mask + normal; }
};

// What a step is trained on.
struct ViewDraw {
  std::size_t view = 0;
  vec3 background{0};  // sRGB-encoded, in [0, 1)
};

class ViewLoss {
 public:
  static constexpr std::uint32_t kStepBackgrounds = 0xbac6u;  // stream of the backgrounds of a fit's steps

  // Works on the crops of the views (cropToMasks), all of one size; at least one. `geometry`: with E_normal.
  ViewLoss(std::span<const FrameView> views, const ViewLossOptions& options, bool geometry,
           ComputeDevice& device);

  std::size_t size() const { return views_.size(); }
  std::span<const Camera> cameras() const { return cameras_; }  // of the crops
  TrainingOps& ops() { return *ops_; }

  // Views without replacement, one shuffle an epoch, each on a random background; the same for equal
  // arguments.
  ViewDraw drawOf(int step, std::uint32_t stream = kStepBackgrounds) const;

  // Renders the view; a view without a mask stands on black, whatever the background. The Gaussians (physical
  // values) must live unchanged until `backward`.
  void draw(const GaussianBuffers& gaussians, ViewDraw what, int sh_degree);
  // Of the last drawn picture: its loss; fills `upstream()` anew.
  PictureLoss compare();
  // dL/d(physical values of the Gaussians) from `upstream()`; overwrites `gradients`.
  void backward(GaussianBuffers& gradients) { raster_->backward(upstream_, gradients); }

  // What was drawn, in pixels of the crop: color 3, alpha 1; with geometry depth 1, median_depth 1, normal 3.
  RasterImages& images() { return images_; }
  // dL/d(images) of the last comparison, planes of the same shapes; empty planes are zero.
  RasterImages& upstream() { return upstream_; }

  // The three steps in a row.
  PictureLoss gradient(const GaussianBuffers& gaussians, ViewDraw what, int sh_degree,
                       GaussianBuffers& gradients);

 private:
  ViewLossOptions options_;
  bool geometry_;
  std::vector<TrainingView> views_;
  std::vector<Camera> cameras_;
  std::unique_ptr<TrainingOps> ops_;
  std::unique_ptr<Rasterizer> raster_;
  std::size_t drawn_ = 0;  // the view of images_
  Planes target_;
  RasterImages images_, upstream_;
};

}  // namespace beam
