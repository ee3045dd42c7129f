// SPDX-License-Identifier: Apache-2.0
// main of tests that open windows: one QApplication with the surface format of the program.
#include <gtest/gtest.h>

#include <QApplication>
#include <QSurfaceFormat>

#include "viewers/gl/functions.h"

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  QSurfaceFormat::setDefaultFormat(beam::surfaceFormat());
  QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
