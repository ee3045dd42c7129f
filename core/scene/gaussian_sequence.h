// SPDX-License-Identifier: Apache-2.0
// Gaussians through time, on a shelf: frames are read when asked for. Pictures, exports, reports and the
// window ask a sequence for frames, names and rate, wherever it comes from: a project, or a file without
// cameras.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/math/similarity3.h"
#include "core/scene/attribute.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/ids.h"
#include "core/scene/mesh.h"
#include "core/scene/pose.h"
#include "core/scene/skin_binding.h"

namespace beam {

// One frame as it was read.
struct GaussianFrame {
  GaussianCloud cloud;
  std::optional<Materials> materials;
  std::vector<Attribute> attributes = {};  // what is not in the materials
  bool refined = false;                    // geometry is final; false: appearance only
  bool interpolated = false;               // between two solved frames, without a result of its own
  bool stale = false;                      // not what the settings in force would give
  std::string stale_note = {};             // what of it is not: "materials made with other settings"
};
// Throws Error{Data} that names what does not fit.
void validate(const GaussianFrame& frame);

struct FrameLabel {
  std::string name;       // as its source calls it
  long long number = -1;  // the name's; -1: it has none
  bool operator==(const FrameLabel&) const = default;
};

// What there is of a frame, told without reading it.
struct FrameContent {
  bool gaussians = false, materials = false, mesh = false;
  bool interpolated = false;  // `gaussians` would be made from the frames beside it
  bool unfinished = false;    // they are of a fit that is still to be refined: its run was cut
};

// How the Gaussians are meant to be drawn.
struct RenderMode {
  float dilation_px2 = 0;  // added to the diagonal of the projected covariance (methods 1.3)
  bool operator==(const RenderMode&) const = default;
};

// The joints of a frame where they were tracked to.
struct FrameJoints {
  Pose pose;               // empty: the frame has none
  bool restarted = false;  // others than those of the frame before
  bool interpolated = false;
};

// A frame's skin as its joints carry it.
struct CarriedPose {
  Pose rest_skin;  // where its Gaussians sit on the joints at rest, with their own residuals
  Pose joints;     // corrected; empty: not known
};

// The take that a frame belongs to: each of its frames builds on the one before.
struct SequenceTake {
  FrameIndex first;
  std::vector<FrameIndex> restarts;  // frames after the first whose joints and Gaussians are others
  Pose rest_joints;                  // of the frame's joints
  SkinBinding binding;               // of the frame's skin at rest to them; empty: it has no skin
};

// Safe to use from several threads. Nothing that is read is kept inside; see FrameCache. Frames are those of
// frames(), without a check.
class GaussianSequence {
 public:
  virtual ~GaussianSequence() = default;
  // Equal for every snapshot of the same source.
  virtual std::string id() const = 0;
  virtual const std::vector<FrameLabel>& frames() const = 0;
  virtual double rate() const = 0;  // frames per second
  // Of what load and mesh give: another value where that may be different. Zero: there is nothing to load.
  // None: not known yet.
  virtual std::optional<Digest> stamp(FrameIndex frame) const = 0;
  virtual FrameContent content(FrameIndex frame) const = 0;
  // Null: there is nothing. Throws what its readers throw.
  virtual std::shared_ptr<const GaussianFrame> load(FrameIndex frame) const = 0;

  // --- What not every source has. ---
  virtual std::shared_ptr<const Mesh> mesh(FrameIndex) const { return nullptr; }
  // The frame of the same take that it builds on; none for the first.
  virtual std::optional<FrameIndex> before(FrameIndex) const { return std::nullopt; }
  virtual FrameJoints joints(FrameIndex) const { return {}; }
  virtual std::optional<CarriedPose> carried(FrameIndex) const { return std::nullopt; }
  // None: no frame builds on another there. Works out the binding, which takes a moment.
  virtual std::optional<SequenceTake> take(FrameIndex) const { return std::nullopt; }
  // Of the axes, unit and origin that the source came in.
  virtual Similarity3 captureFromWorld() const { return {}; }
  virtual RenderMode renderMode() const { return {}; }
};

// The number in a frame's name: its last run of digits ("frame_0012" -> 12); -1 without digits.
long long frameNumber(std::string_view name);
std::vector<FrameLabel> labelled(const std::vector<std::string>& names);
// What load() gives; throws Error{Data} where the frame has no Gaussians.
std::shared_ptr<const GaussianFrame> solvedFrame(const GaussianSequence& sequence, FrameIndex frame);
std::vector<std::string> namesOf(const GaussianSequence& sequence);
inline const std::string& nameOf(const GaussianSequence& sequence, FrameIndex frame) {
  return sequence.frames()[static_cast<std::size_t>(frame.value)].name;
}

}  // namespace beam
