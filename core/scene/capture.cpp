// SPDX-License-Identifier: Apache-2.0
#include "core/scene/capture.h"

namespace beam {

std::string toText(UpAxis up) {
  switch (up) {
    case UpAxis::PlusY:
      return "+Y";
    case UpAxis::PlusZ:
      return "+Z";
    case UpAxis::MinusY:
      return "-Y";
  }
  return "+Y";
}

dmat3 worldFromCapture(UpAxis up) {
  switch (up) {
    case UpAxis::PlusY:
      return dmat3(1.0);
    // x_world = y, y_world = z, z_world = x of the capture; columns are the images of the capture's axes.
    case UpAxis::PlusZ:
      return dmat3(dvec3(0, 0, 1), dvec3(1, 0, 0), dvec3(0, 1, 0));
    case UpAxis::MinusY:
      return dmat3(dvec3(1, 0, 0), dvec3(0, -1, 0), dvec3(0, 0, -1));
  }
  return dmat3(1.0);
}

}  // namespace beam
