// SPDX-License-Identifier: Apache-2.0
// Everything that can be looked at as a picture from one camera: photograph, mask, rendered channels, baked
// maps.
#pragma once

#include <QString>

#include <vector>

#include "core/render/deferred.h"
#include "ui/project_model.h"
#include "viewers/image/picture.h"
#include "viewers/view_state.h"

namespace beam {

struct PictureSource {
  QString id;     // stable: "photo", "mask", "render.lit", "map.ao"
  QString title;  // "Photograph"
  PictureLoader loader;
};

// A light for the rendered "lit" picture; may be null.
struct PictureLight {
  std::shared_ptr<const PreparedLight> light;
  float yaw_rad = 0;
};

// What exists for the model's frame; loaders work on a snapshot, so later changes do not reach them.
std::vector<PictureSource> pictureSources(const ProjectModel& model, ViewIndex view,
                                          const PictureLight& light);

}  // namespace beam
