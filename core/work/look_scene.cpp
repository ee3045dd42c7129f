// SPDX-License-Identifier: Apache-2.0
#include "core/work/look_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <mutex>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/file_reference.h"
#include "core/io/file.h"
#include "core/io/look_json.h"
#include "core/io/mesh_ply.h"
#include "core/io/scene_document_json.h"
#include "core/stages/panorama_file.h"
#include "core/stages/project_sequence.h"
#include "core/work/last_solved.h"
#include "core/work/referred_file.h"
#include "core/work/selection.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

std::string namesOfLooks(const Project& project) {
  std::vector<std::string> names;
  for (const Look& look : project.looks()) names.push_back("\"" + look.name + "\"");
  return names.empty() ? "it has none" : fmt::format("it has {}", fmt::join(names, ", "));
}

// The frame that was asked for last is kept: picture after picture shows it.
class KeptFrame final : public GaussianSequence {
 public:
  explicit KeptFrame(std::shared_ptr<const GaussianSequence> of) : of_(std::move(of)) {}
  std::string id() const override { return of_->id(); }
  const std::vector<FrameLabel>& frames() const override { return of_->frames(); }
  double rate() const override { return of_->rate(); }
  std::optional<Digest> stamp(FrameIndex frame) const override { return of_->stamp(frame); }
  FrameContent content(FrameIndex frame) const override { return of_->content(frame); }
  RenderMode renderMode() const override { return of_->renderMode(); }
  std::shared_ptr<const GaussianFrame> load(FrameIndex frame) const override {
    const std::lock_guard lock(mutex_);
    if (!kept_ || frame_ != frame) kept_ = of_->load(frame);
    frame_ = frame;
    return kept_;
  }

 private:
  std::shared_ptr<const GaussianSequence> of_;
  mutable std::mutex mutex_;
  mutable FrameIndex frame_;
  mutable std::shared_ptr<const GaussianFrame> kept_;
};

std::shared_ptr<const Environment> panoramaOf(const ChosenLook& chosen, const Project& project,
                                              const Progress& progress) {
  const EnvironmentLight& light = chosen.look.lighting.environment;
  const bool ever = light.enabled || chosen.look.curves.contains("environment.enabled");
  if (!ever) return nullptr;
  if (light.file.empty()) {
    const std::optional<fs::path> file = project.environmentFile();
    return file ? openPanorama(*file, progress) : nullptr;
  }
  return openPanorama(referredFile(light.file, chosen.folder,
                                   fmt::format("the panorama of the look \"{}\"", chosen.look.name),
                                   "name another in the look"),
                      progress);
}

// What a scene refers to.
fs::path found(const FileReference& reference, const fs::path& folder, const char* what) {
  return referredFile(reference, folder, fmt::format("a {} of the scene", what),
                      fmt::format("take the {} out of the scene", what));
}

}  // namespace

ChosenLook chosenLook(const Project& project, const std::string& words) {
  if (const Look* look = project.look(words)) return {*look, project.folder(), {}};
  const fs::path file(words);
  if (!isThere(file)) {
    throw Error(Error::Kind::Usage,
                fmt::format("--look expects the name of a look of the project or a file, found \"{}\": {}",
                            words, namesOfLooks(project)));
  }
  const std::string text = readTextFile(file);
  ChosenLook chosen;
  chosen.folder = fs::absolute(file).parent_path();
  if (isSceneDocument(text)) {
    chosen.scene = parseSceneDocument(text, file.string());
    chosen.look = chosen.scene->look;
  } else {
    chosen.look = parseLook(text, file.string());
  }
  if (chosen.look.name.empty()) chosen.look.name = file.stem().string();
  if (!isLookName(chosen.look.name)) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\": \"{}\" is no name of a look; give it another",
                                               file.string(), chosen.look.name));
  }
  return chosen;
}

LookScene::LookScene(const ChosenLook& chosen, const Project& project,
                     std::shared_ptr<const GaussianSequence> sequence, const Progress& progress)
    : look_(chosen.look),
      sequence_(std::make_shared<KeptFrame>(std::move(sequence))),
      panorama_(panoramaOf(chosen, project, progress)),
      scene_(chosen.scene) {
  if (!scene_) return;
  if (scene_->performances.empty() && scene_->meshes.empty() && !scene_->ground.enabled)
    throw Error(Error::Kind::Data, "the scene is empty: expected performances, meshes or a ground in it");
  for (Performance& performance : scene_->performances) {
    const fs::path folder = found(performance.project, chosen.folder, "project");
    const LastSolved last =
        lastSolved(Project::open(folder, project.sharedSetup()),
                   {.frames = performance.frames, .between = true, .materials = true}, progress);
    last.tell();
    auto take = std::make_shared<KeptFrame>(sequenceOf(last.project, Shows::Between));
    std::vector<std::string> names;
    for (const FrameIndex frame : selectSolvedFrames(performance.frames, *take, progress))
      names.push_back(nameOf(*take, frame));
    performance.frames = fmt::format("{}", fmt::join(names, ","));
    takes_.push_back(std::move(take));
  }
  for (const SceneMesh& mesh : scene_->meshes)
    meshes_.push_back(std::make_shared<const Mesh>(readMeshPly(found(mesh.file, chosen.folder, "mesh"))));
}

RenderScene LookScene::at(double time_s, FrameIndex frame) const {
  if (scene_) {
    const auto place = [](const auto& all, const auto& one) {
      return static_cast<std::size_t>(&one - all.data());
    };
    return sceneAt(*scene_, time_s,
                   {.sequence = [&](const Performance& p) { return takes_[place(scene_->performances, p)]; },
                    .mesh = [&](const SceneMesh& m) { return OpenedMesh{meshes_[place(scene_->meshes, m)]}; },
                    .environment = [&](const EnvironmentLight&) { return panorama_; }});
  }
  RenderScene scene;
  scene.instances = {instanceOf(solvedFrame(*sequence_, frame), sequence_->renderMode())};
  scene.lighting = beam::at(look_, time_s).lighting;
  scene.environment = panorama_;
  if (scene.lighting.environment.enabled && !panorama_)
    scene.missing.push_back("panorama of the capture: it is not there");
  return scene;
}

void LookScene::requireLight() const {
  if (panorama_) return;
  RenderScene scene;
  scene.lighting = look_.lighting;
  for (Light& light : scene.lighting.lights)  // a curve may switch it on
    light.enabled |= look_.curves.contains("lights." + light.id + ".enabled");
  if (isLit(scene)) return;
  throw Error(Error::Kind::Usage,
              fmt::format("nothing shines in the look \"{}\": it has no lamp that is drawn, and no panorama "
                          "(its own, or that of the project, which {} --environment FILE sets)",
                          look_.name, "beam run"));
}

}  // namespace beam
