// SPDX-License-Identifier: Apache-2.0
// OpenGL 3.3 core of the current context, and the surface format that every view of the program asks for.
#pragma once

#include <QOpenGLFunctions_3_3_Core>
#include <QSurfaceFormat>

namespace beam {

// Set it as the default before QApplication is made: all views, VTK's too, then share contexts.
QSurfaceFormat surfaceFormat();

// Throws Error{Refused} when this display gives no OpenGL 3.3 core context. Call it once before a window is
// made.
void requireOpenGl();

// Throws Error{Refused} when the current context is older than 3.3 core.
QOpenGLFunctions_3_3_Core& currentGl();

}  // namespace beam
