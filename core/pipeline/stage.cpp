// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/stage.h"

namespace beam {

bool applies(const StepInfo& step, const Take& take, FrameIndex frame) {
  if (!step.per_frame) return true;
  switch (step.frames) {
    case Frames::Every:
      return true;
    case Frames::FirstOfTake:
      return frame == take.first;
    case Frames::InTakes:
      return take.count() > 1;
  }
  return true;
}

std::vector<Field> fieldsOf(Stage& stage) {
  FieldList list;
  stage.parameters(list);
  return std::move(list.fields);
}

std::vector<StepId> readsOf(const StepInfo& step) {
  std::vector<StepId> all = step.inputs;
  for (const auto* more : {&step.later.inputs, &step.later.previous}) {
    all.insert(all.end(), more->begin(), more->end());
  }
  return all;
}

}  // namespace beam
