// SPDX-License-Identifier: Apache-2.0
// The skin follows the joints (BEAM 3.1, Appendix A; methods 3.5): every skin Gaussian blends the rigid
// motions of its joints since the rest frame. Gaussians are moved and turned, never scaled.
#pragma once

#include "core/optim/anchors.h"

namespace beam {

class JointWarp {
 public:
  // `anchors`: of the skin at rest on the joints at rest.
  JointWarp(Pose skin_at_rest, Pose joints_at_rest, Anchors anchors);

  // x_i = sum_k w_ik (R_k (x0_i - y0_k) + y_k), q_i = normalize(sum_k w_ik s_ik r_k) q0_i with
  // r_k = q_k q0_k^-1, R_k its matrix, and the signs s_ik that bring r_k to the side of the nearest joint's:
  // no flip and no division by zero at half turns. Throws Error{Bug} when the counts differ.
  Pose skin(const Pose& joints) const;

  // Adds the joints' gradient to `gradient` from that of skin(joints).
  void backward(const Pose& joints, const PoseGradient& skin_gradient, PoseGradient& gradient) const;
  // Likewise that of the skin at rest.
  void backwardToRest(const Pose& joints, const PoseGradient& skin_gradient, PoseGradient& gradient) const;

  // Another skin at rest on the same anchors. Throws Error{Bug} for another count.
  void setRestSkin(Pose skin);

  const Pose& restSkin() const { return skin_; }
  const Pose& restJoints() const { return joints_; }
  const Anchors& anchors() const { return anchors_; }

 private:
  std::vector<quat> turns(const Pose& joints) const;                // r_k
  quat blend(const std::vector<quat>& turns, std::size_t i) const;  // before normalising

  Pose skin_, joints_;
  Anchors anchors_;
  AnchorLists lists_;
};

}  // namespace beam
