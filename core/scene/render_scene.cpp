// SPDX-License-Identifier: Apache-2.0
#include "core/scene/render_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/scene/frame_list.h"

namespace beam {
namespace {

constexpr double kFrameTolerance = 1e-6;  // of a frame: times are often n / rate, which rounds either way

std::string pathOf(const FileReference& file) {
  return file.absolute.empty() ? file.relative : file.absolute;
}

// Runs body() and keeps what is said of a thing that is gone, damaged or not as the document has it.
template <class Body>
void orMissing(RenderScene& scene, const std::string& what, Body&& body) {
  try {
    body();
  } catch (const Error& e) {
    const Error::Kind kind = e.kind();
    if (kind != Error::Kind::Data && kind != Error::Kind::Storage && kind != Error::Kind::Usage) throw;
    scene.missing.push_back(fmt::format("{}: {}", what, e.what()));
  }
}

[[noreturn]] void notThere(const std::string& what) { throw Error(Error::Kind::Data, what); }

RenderInstance instanceAt(const Performance& performance, double time_s, const SceneSources& open) {
  const std::shared_ptr<const GaussianSequence> sequence =
      open.sequence ? open.sequence(performance) : nullptr;
  if (!sequence) notThere("it is not there");
  const FrameIndex index = frameAt(performance, *sequence, time_s);
  const std::shared_ptr<const GaussianFrame> frame = sequence->load(index);
  if (!frame) notThere(fmt::format("frame {} has no Gaussians", nameOf(*sequence, index)));
  RenderInstance instance = instanceOf(frame, sequence->renderMode());
  instance.world_from_cloud = performance.scene_from_performance;
  return instance;
}

RenderMesh meshOf(const SceneMesh& mesh, const SceneSources& open) {
  OpenedMesh opened = open.mesh ? open.mesh(mesh) : OpenedMesh{};
  if (!opened.mesh) notThere("it is not there");
  return {std::move(opened.mesh), std::move(opened.textures), vec3(mesh.base_color),
          static_cast<float>(mesh.roughness), mesh.scene_from_mesh};
}

void addEnvironment(RenderScene& scene, const SceneSources& open) {
  const EnvironmentLight& light = scene.lighting.environment;
  if (!light.enabled) return;
  const std::string what =
      light.file.empty() ? "panorama of the capture" : fmt::format("panorama \"{}\"", pathOf(light.file));
  orMissing(scene, what, [&] {
    scene.environment = open.environment ? open.environment(light) : nullptr;
    if (!scene.environment) notThere("it is not there");
  });
}

}  // namespace

RenderInstance instanceOf(const std::shared_ptr<const GaussianFrame>& frame, RenderMode mode) {
  RenderInstance instance;
  instance.cloud = {frame, &frame->cloud};
  if (frame->materials) instance.materials = {frame, &*frame->materials};
  instance.attributes = {frame, &frame->attributes};
  instance.mode = mode;
  return instance;
}

FrameIndex frameAt(const Performance& performance, const GaussianSequence& sequence, double time_s) {
  const std::vector<FrameIndex> listed = parseFrameList(performance.frames, namesOf(sequence));
  if (listed.empty()) notThere("it has no frames");
  const double passed = std::floor(
      (time_s - performance.time_offset_s) * performance.speed * sequence.rate() + kFrameTolerance);
  const double due = listed.front().value + passed;
  const auto after = std::upper_bound(listed.begin(), listed.end(), due,
                                      [](double frame, FrameIndex f) { return frame < f.value; });
  return after == listed.begin() ? listed.front() : *(after - 1);
}

RenderScene sceneAt(const SceneDocument& document, double time_s, const SceneSources& open) {
  RenderScene scene;
  for (const Performance& performance : document.performances) {
    orMissing(scene, fmt::format("performance \"{}\"", pathOf(performance.project)),
              [&] { scene.instances.push_back(instanceAt(performance, time_s, open)); });
  }
  for (const SceneMesh& mesh : document.meshes) {
    orMissing(scene, fmt::format("mesh \"{}\"", pathOf(mesh.file)),
              [&] { scene.meshes.push_back(meshOf(mesh, open)); });
  }
  scene.ground = document.ground;
  scene.lighting = at(document.look, time_s).lighting;
  addEnvironment(scene, open);
  return scene;
}

bool isLit(const RenderScene& scene) {
  const auto& lights = scene.lighting.lights;
  return (scene.environment && scene.lighting.environment.enabled) ||
         std::any_of(lights.begin(), lights.end(), [](const Light& light) {
           return light.enabled && !std::holds_alternative<UnknownLight>(light.kind);
         });
}

}  // namespace beam
