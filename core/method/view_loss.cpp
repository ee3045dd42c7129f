// SPDX-License-Identifier: Apache-2.0
#include "core/method/view_loss.h"

#include <algorithm>

#include "core/base/rng.h"
#include "core/optim/normal_loss.h"
#include "core/optim/schedule.h"

namespace beam {

ViewLoss::ViewLoss(std::span<const FrameView> views, const ViewLossOptions& options, bool geometry,
                   ComputeDevice& device)
    : options_(options), geometry_(geometry), views_(cropToMasks(views)), ops_(device.newTrainingOps()) {
  for (const TrainingView& v : views_) cameras_.push_back(v.camera);
  raster_ = device.newRasterizer(
      {.width = cameras_[0].width, .height = cameras_[0].height, .geometry = geometry, .gradients = true});
}

ViewDraw ViewLoss::drawOf(int step, std::uint32_t stream) const {
  const RandomStream random(options_.seed, step, stream);
  return {viewOfStep(step, views_.size(), options_.seed),
          vec3(random.uniform(0), random.uniform(1), random.uniform(2))};
}

void ViewLoss::draw(const GaussianBuffers& gaussians, ViewDraw what, int sh_degree) {
  drawn_ = what.view;
  const TrainingView& view = views_[drawn_];
  const vec3 background = view.mask.empty() ? vec3(0) : what.background;
  compose(view, background, target_);
  raster_->forward(gaussians, view.camera, sh_degree, background, images_);
}

PictureLoss ViewLoss::compare() {
  const TrainingView& view = views_[drawn_];
  acceptUnknown(view, images_.color, target_);
  PictureLoss loss;
  loss.photometric =
      ops_->photometric(images_.color, target_, static_cast<float>(options_.ssim_weight), upstream_.color)
          .total;
  loss.mask = maskLoss(images_.alpha, view, options_.mask_weight, upstream_.alpha);
  if (!geometry_) return loss;
  for (Planes* p : {&upstream_.normal, &upstream_.depth, &upstream_.median_depth}) {
    std::fill(p->values.begin(), p->values.end(), 0.0f);
  }
  loss.normal = normalLoss(images_, view.camera.intrinsics,
                           {.weight = static_cast<float>(options_.normal_weight),
                            .expected_share = static_cast<float>(options_.expected_depth_share)},
                           upstream_);
  return loss;
}

PictureLoss ViewLoss::gradient(const GaussianBuffers& gaussians, ViewDraw what, int sh_degree,
                               GaussianBuffers& gradients) {
  draw(gaussians, what, sh_degree);
  const PictureLoss loss = compare();
  backward(gradients);
  return loss;
}

}  // namespace beam
