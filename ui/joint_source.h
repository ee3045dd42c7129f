// SPDX-License-Identifier: Apache-2.0
// Joints of the shown frame with their way over the last frames, and the influence of one on the skin; read
// from the sequence on a background thread.
#pragma once

#include <QObject>

#include <memory>
#include <vector>

#include "core/scene/skin_binding.h"
#include "ui/project_model.h"

namespace beam {

using JointPositions = std::vector<vec3>;

// Shares of `joint` in every skin Gaussian, 0 where it is none of its anchors.
std::vector<float> influenceOf(const SkinBinding& binding, std::uint32_t joint);

struct JointsShown {
  // Oldest first, the last is the frame's; empty: none. All of them are the same joints.
  std::vector<JointPositions> trails;
  QString hint;                                         // why there are none
  std::shared_ptr<const std::vector<float>> influence;  // of the picked joint; null: none
};

class JointSource final : public QObject {
  Q_OBJECT

 public:
  explicit JointSource(const ProjectModel& model, QObject* parent = nullptr);

  // For the model's frame; answers with changed().
  void refresh();
  void pick(int joint);  // -1: none
  int picked() const { return picked_; }
  const JointsShown& shown() const { return shown_; }
  bool settled() const { return seen_ == ticket_; }

 Q_SIGNALS:
  void changed();

 private:
  struct Wish;
  struct Memory;  // what the worker keeps between answers
  static JointsShown trailsAt(const Wish& wish, Memory& memory);
  static std::shared_ptr<const std::vector<float>> influenceAt(const Wish& wish, Memory& memory);

  const ProjectModel& model_;
  int picked_ = -1;
  JointsShown shown_;
  std::uint64_t ticket_ = 0, seen_ = 0;
  std::shared_ptr<Memory> memory_;  // used by worker_ alone
  LatestWorker worker_;             // last: it stops first
};

}  // namespace beam
