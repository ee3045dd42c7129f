// SPDX-License-Identifier: Apache-2.0
// The look of the program: Qt's Fusion style under resources/theme/studio.qss. Call it once, before any
// window.
#pragma once

class QApplication;

namespace beam {

void applyTheme(QApplication& application);

}  // namespace beam
