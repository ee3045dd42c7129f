// SPDX-License-Identifier: Apache-2.0
// The keys and the wheel that mean the same in every view of the world.
#pragma once

#include <QKeyEvent>
#include <QWheelEvent>

#include <optional>

#include "viewers/orbit_camera.h"

namespace beam {

// The number pad as in other 3D programs: 1, 3 and 7 look from the front, the right and the top, with Ctrl
// from the other side. Without Num Lock the same keys arrive as End, Page Down and Home.
inline std::optional<ViewPreset> presetOf(const QKeyEvent& event) {
  if (!(event.modifiers() & Qt::KeypadModifier)) return {};
  const bool opposite = event.modifiers() & Qt::ControlModifier;
  switch (event.key()) {
    case Qt::Key_1:
    case Qt::Key_End:
      return opposite ? ViewPreset::Back : ViewPreset::Front;
    case Qt::Key_3:
    case Qt::Key_PageDown:
      return opposite ? ViewPreset::Left : ViewPreset::Right;
    case Qt::Key_7:
    case Qt::Key_Home:
      return opposite ? ViewPreset::Bottom : ViewPreset::Top;
    default:
      return {};
  }
}

// Notches; positive comes closer. Fine wheels send parts of one.
inline float wheelSteps(const QWheelEvent& event) {
  constexpr float kUnitsPerNotch = 120;
  return static_cast<float>(event.angleDelta().y()) / kUnitsPerNotch;
}

}  // namespace beam
