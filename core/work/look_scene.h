// SPDX-License-Identifier: Apache-2.0
// What a look is drawn of at one time: the take of the project, or the performances, meshes and ground of a
// scene file.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/pipeline/project.h"
#include "core/scene/gaussian_sequence.h"
#include "core/scene/render_scene.h"
#include "core/scene/scene_document.h"

namespace beam {

struct ChosenLook {
  Look look;                           // with a name that is one
  std::filesystem::path folder;        // that its references are relative to
  std::optional<SceneDocument> scene;  // of whose performances it is; none: of the project's take
};
// `words`: the name of a look of the project, else a file of a look or of a scene; one without a name takes
// the file's. Throws Error{Usage} where it is neither, and what parseLook and parseSceneDocument throw.
ChosenLook chosenLook(const Project& project, const std::string& words);

class LookScene {
 public:
  // `project`: with the settings that its frames are taken from; of which `sequence` is. Opens the look's
  // panorama, and the projects and meshes of a scene. Throws Error{Data} where one of them is gone, and what
  // opening them throws.
  LookScene(const ChosenLook& chosen, const Project& project,
            std::shared_ptr<const GaussianSequence> sequence, const Progress& progress);

  // Of the project's take `frame` is seen, which has Gaussians; of a scene's performances those of their
  // frames that have some.
  RenderScene at(double time_s, FrameIndex frame) const;
  const std::shared_ptr<const Environment>& panorama() const { return panorama_; }

  // Throws Error{Usage} where nothing ever shines.
  void requireLight() const;

 private:
  void openScene(const SceneDocument& document, const Progress& progress);

  Look look_;
  std::shared_ptr<const GaussianSequence> sequence_;
  std::shared_ptr<const Environment> panorama_;
  std::optional<SceneDocument> scene_;  // whose performances name the frames that are solved
  // Of its performances and meshes, in their order.
  std::vector<std::shared_ptr<const GaussianSequence>> takes_;
  std::vector<std::shared_ptr<const Mesh>> meshes_;
};

}  // namespace beam
