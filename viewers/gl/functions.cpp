// SPDX-License-Identifier: Apache-2.0
#include "viewers/gl/functions.h"

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QtGlobal>
#if QT_VERSION_MAJOR >= 6
#include <QOpenGLVersionFunctionsFactory>
#endif

#include "core/base/error.h"

namespace beam {
namespace {

Error tooOld() {
  return Error(Error::Kind::Refused,
               "the views need OpenGL 3.3, which this display does not give; start the program with "
               "LIBGL_ALWAYS_SOFTWARE=1, or install libgl1-mesa-dri");
}

}  // namespace

QSurfaceFormat surfaceFormat() {
  QSurfaceFormat format;
  format.setRenderableType(QSurfaceFormat::OpenGL);
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  format.setStencilBufferSize(8);
  format.setAlphaBufferSize(8);
  return format;
}

void requireOpenGl() {
  QOpenGLContext context;
  QOffscreenSurface surface;
  surface.create();
  if (!context.create() || !context.makeCurrent(&surface)) throw tooOld();
  currentGl();
}

QOpenGLFunctions_3_3_Core& currentGl() {
#if QT_VERSION_MAJOR >= 6
  auto* gl = QOpenGLVersionFunctionsFactory::get<QOpenGLFunctions_3_3_Core>(QOpenGLContext::currentContext());
#else
  auto* gl = QOpenGLContext::currentContext()->versionFunctions<QOpenGLFunctions_3_3_Core>();
#endif
  if (gl == nullptr || !gl->initializeOpenGLFunctions()) throw tooOld();
  return *gl;
}

}  // namespace beam
