// SPDX-License-Identifier: Apache-2.0
// SceneDocument: several performances, meshes and a ground under one look, by reference. What it is at one
// time, with the data, is a RenderScene (scene/render_scene.h). World axes, metres, seconds.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "core/base/file_reference.h"
#include "core/math/similarity3.h"
#include "core/math/types.h"
#include "core/scene/look.h"

namespace beam {

// A subject: frames of a project, put somewhere in space and time.
struct Performance {
  FileReference project = {};  // its folder
  std::string frames = "all";  // a LIST as on the command line: "0-7", "1-9x2" (scene/frame_list.h)
  Similarity3 scene_from_performance = {};
  double time_offset_s = 0;    // when its first listed frame is due
  double speed = 1;            // times the rate it was taken at; 0 stands still
  std::string unknown = "{}";  // members of a later version, kept as they are (a JSON object)

  bool operator==(const Performance&) const = default;
};
void describe(Fields& f, Performance& performance);  // every scalar but the similarity

struct SceneMesh {
  FileReference file = {};
  Similarity3 scene_from_mesh = {};
  // Where the file has no textures of its own.
  dvec3 base_color = dvec3(0.5);  // scene-linear Rec.709, 0 to 1
  double roughness = 0.5;         // 0.04 to 1; GGX alpha = roughness^2
  std::string unknown = "{}";

  bool operator==(const SceneMesh&) const = default;
};
void describe(Fields& f, SceneMesh& mesh);  // every scalar but the similarity

// A level plane without end that shadows fall on.
struct Ground {
  bool enabled = false;
  double height_m = 0;
  dvec3 base_color = dvec3(0.5);  // as of a mesh
  double roughness = 0.8;
  std::string unknown = "{}";

  bool operator==(const Ground&) const = default;
};
void describe(Fields& f, Ground& ground);

struct SceneDocument {
  std::vector<Performance> performances;
  std::vector<SceneMesh> meshes;
  Ground ground;
  Look look;
  std::string unknown = "{}";

  bool operator==(const SceneDocument&) const = default;
};

inline constexpr std::size_t kMostPerformances = 256, kMostMeshes = 4096;

// Throws Error{Data} that names the place: too many, a number out of range, a rotation that is none, a scale
// that is not over 0, a look that is not valid. Whether what it refers to is there is another question.
void validate(const SceneDocument& document);

}  // namespace beam
