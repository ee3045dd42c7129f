// SPDX-License-Identifier: Apache-2.0
// Joint Gaussians follow the performance (BEAM 3.1, Appendix A; methods 3.2, 3.3): fitted on the first frame
// of a take, then only moved, frame by frame, under L1 + lambda E_rigid.
#pragma once

#include <span>

#include "core/base/fields.h"
#include "core/base/progress.h"
#include "core/method/preview.h"
#include "core/optim/learning_rates.h"
#include "core/render/device.h"
#include "core/scene/frame_views.h"
#include "core/scene/pose.h"

namespace beam {

struct TrackJointsOptions {
  int joints = 15000;            // BEAM 3.1
  int first_iterations = 15000;  // on the first frame, with growth by MCMC (methods 3.7)
  int iterations = 5000;         // of a later frame, over all levels (methods 3.7: 5k to 15k)
  int levels = 0;                // coarser levels before the full pictures; each halves the pictures' sides
  double rigid_weight = 0.05;    // lambda of E_rigid, a plain sum
  double rest_weight = 0;        // ours: likewise against the first frame, so that no shape is forgotten
  double rigid_spacings = 1.8;   // length l of the graph's weights in mean spacings of the joints: 0.02 m for
                                 // 15,000 joints on a grown person
  double mask_weight = 0.1;      // methods 3.8
  PoseRates rates = kTrackedJointRates;  // in pixels of the level
  double isotropy_weight = 0.002;        // methods 3.2
  double size_weight = 1;                // methods 3.2
  int recolor_iterations = 0;            // ours: 0 is the paper's way, colours of the first frame for ever
  int seed = 1;
};
void describe(Fields& fields, TrackJointsOptions& options);

// Joints of the first frame, from points on its surface.
GaussianCloud fitFirstJoints(std::span<const FrameView> views, const PointCloud& seeds,
                             const TrackJointsOptions& options, ComputeDevice& device, Progress& progress,
                             const CloudPreview& preview = {});

struct TrackedJoints {
  GaussianCloud joints;
  double residual = 0;  // mean |render - photograph| over the crops of all views, 0 to 1
  double rigid = 0;     // E_rigid against the previous frame, m^2
};

// What the tracker knows of the frames before: all of equal count and order.
struct JointHistory {
  const Pose& rest;                // on the first frame: the graph
  const GaussianCloud& previous;   // frame t - 1
  std::span<const vec3> before_m;  // positions of frame t - 2; empty: none, no velocity
};

// The joints in the next frame. Starts from constant velocity where the coarse pictures agree better with it
// than with standing still. Levels (ours; methods 3.3 gives only advice for fast limbs): at every coarser
// level a quarter of the joints carries the others by the warp of methods 3.5, so that limbs move as wholes
// over more than their own width.
TrackedJoints trackJoints(std::span<const FrameView> views, const JointHistory& history,
                          const TrackJointsOptions& options, ComputeDevice& device, Progress& progress,
                          const CloudPreview& preview = {});

// `residual` of joints as they stand.
double jointResidual(std::span<const FrameView> views, const GaussianCloud& joints, double mask_weight,
                     ComputeDevice& device, const Progress& progress);

}  // namespace beam
