// SPDX-License-Identifier: Apache-2.0
// The loss of a training step: one photograph on a random background, E_color of BEAM eq. 8 with the mask
// term of methods 3.8, and E_normal where it is asked for.
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

class ViewLoss {
 public:
  // Works on the crops of the views. `geometry`: with E_normal.
  ViewLoss(std::span<const FrameView> views, const ViewLossOptions& options, bool geometry,
           ComputeDevice& device);

  std::span<const Camera> cameras() const { return cameras_; }  // of the crops
  TrainingOps& ops() { return *ops_; }

  // The view of `step`; `gradients` receives dL/d(physical).
  void gradient(const GaussianBuffers& gaussians, int step, int sh_degree, GaussianBuffers& gradients);

 private:
  ViewLossOptions options_;
  bool geometry_;
  std::vector<TrainingView> views_;
  std::vector<Camera> cameras_;
  std::unique_ptr<TrainingOps> ops_;
  std::unique_ptr<Rasterizer> raster_;
  Planes target_;
  RasterImages images_, upstream_;
};

}  // namespace beam
