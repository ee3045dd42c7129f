// SPDX-License-Identifier: Apache-2.0
// RenderScene: what there is to draw at one time, as plain values over shared data; what every renderer
// takes. Two of them compare by the identity of that data, so that whoever keeps it resident sees cheaply
// what stayed. World axes, metres.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/math/similarity3.h"
#include "core/scene/attribute.h"
#include "core/scene/environment.h"
#include "core/scene/gaussian_cloud.h"
#include "core/scene/gaussian_sequence.h"
#include "core/scene/lighting.h"
#include "core/scene/mesh.h"
#include "core/scene/scene_document.h"

namespace beam {

// Gaussians somewhere. Equal: the same data at the same place, drawn the same way.
struct RenderInstance {
  std::shared_ptr<const GaussianCloud> cloud;                // never null
  std::shared_ptr<const Materials> materials;                // of its length; null: none, it cannot be relit
  std::shared_ptr<const std::vector<Attribute>> attributes;  // never null
  Similarity3 world_from_cloud = {};
  RenderMode mode = {};

  bool operator==(const RenderInstance&) const = default;
};

// A frame where it was captured. `frame` is not null and stays alive with the instance.
RenderInstance instanceOf(const std::shared_ptr<const GaussianFrame>& frame, RenderMode mode = {});

// What a mesh has instead of one colour, by its uv. An empty picture: the colour or roughness of its
// RenderMesh.
struct MeshTextures {
  Image<vec3> base_color;  // scene-linear Rec.709
  Image<float> roughness;
};

struct RenderMesh {
  std::shared_ptr<const Mesh> mesh;              // never null
  std::shared_ptr<const MeshTextures> textures;  // null: none
  vec3 base_color = vec3(0.5f);                  // scene-linear Rec.709, 0 to 1
  float roughness = 0.5f;                        // 0.04 to 1
  Similarity3 world_from_mesh = {};

  bool operator==(const RenderMesh&) const = default;
};

struct RenderScene {
  std::vector<RenderInstance> instances;  // in the order of the document's performances
  std::vector<RenderMesh> meshes;
  Ground ground;
  Lighting lighting;  // what holds at the time; lights that are not enabled or of a later version are in it
  // As it was opened: rotation and gain of `lighting` come on top of its own. Null: no light from all around.
  std::shared_ptr<const Environment> environment;
  std::vector<std::string> missing;  // what should be there and is not, a sentence each

  bool operator==(const RenderScene&) const = default;
};

// Whether a panorama or a light that this version knows shines in it.
bool isLit(const RenderScene& scene);
// Whether there are meshes or the ground.
inline bool hasMeshes(const RenderScene& scene) { return !scene.meshes.empty() || scene.ground.enabled; }

struct OpenedMesh {
  std::shared_ptr<const Mesh> mesh;
  std::shared_ptr<const MeshTextures> textures = nullptr;
};

// Who knows where things are. Each is asked at every time anew and gives the same pointer for the same thing
// where it should count as unchanged. Null, or an Error of kind Data, Storage or Usage: it is not there.
struct SceneSources {
  // In whole: the document's frames are chosen by sceneAt.
  std::function<std::shared_ptr<const GaussianSequence>(const Performance&)> sequence;
  std::function<OpenedMesh(const SceneMesh&)> mesh;
  std::function<std::shared_ptr<const Environment>(const EnvironmentLight&)> environment;
};

// The document at `time_s`. Of what cannot be opened, has no such frames or no Gaussians in the frame, a
// sentence is in `missing`; the rest is there. Reads frames: may take long where its sources do not keep
// them. `document` is valid; a source that is not set counts as one that has nothing.
RenderScene sceneAt(const SceneDocument& document, double time_s, const SceneSources& open);

// The frame that is seen at `time_s`: the performance's clock starts at the first listed frame at its time
// offset and goes on by rate x speed frames of the sequence a second, listed or not; the last listed frame
// that is due is seen. Before its start the first is, after the last frame the last. A time that is a
// multiple of the duration of a frame belongs to that frame, to a millionth of it. Throws Error{Usage} for a
// list that names frames which are not there, Error{Data} when there are none.
FrameIndex frameAt(const Performance& performance, const GaussianSequence& sequence, double time_s);

}  // namespace beam
