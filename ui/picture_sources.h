// SPDX-License-Identifier: Apache-2.0
// Everything that can be looked at as a picture from one camera: photograph, mask, rendered channels, baked
// maps. What a frame does not have stays in the list, and says so when it is looked at: a choice outlives the
// frames without it.
#pragma once

#include <QString>

#include <vector>

#include "ui/project_model.h"
#include "viewers/image/picture.h"
#include "viewers/view_state.h"

namespace beam {

// Of what a picture is made; equal ingredients give the same picture.
struct PictureIngredients {
  std::vector<std::shared_ptr<const void>> values;
  ViewIndex view;
  FrameIndex frame;
  float yaw_rad = 0;
  Lighting lighting = {};
  bool reading = false;  // a light that is not there yet
  bool operator==(const PictureIngredients&) const = default;
};

struct PictureSource {
  QString id;     // stable: "photo", "mask", "render.relight", "map.ao"
  QString title;  // "Photograph"
  PictureIngredients made_of;
  PictureLoader loader;
  bool of_values = false;  // made of the model's values: what is said of these (stale) is true of it
};

// A light for the rendered "relight" picture; may be null, and then `reading` says whether it is on its way.
struct PictureLight {
  std::shared_ptr<const Environment> light;
  float yaw_rad = 0;
  bool reading = false;
  QString name = {};
  Lighting lighting = {};  // how it falls, but for its turn
  bool operator==(const PictureLight&) const = default;
};

// Of the model's frame; loaders work on a snapshot, so later changes do not reach them.
std::vector<PictureSource> pictureSources(const ProjectModel& model, ViewIndex view,
                                          const PictureLight& light);

}  // namespace beam
