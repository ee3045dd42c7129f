// SPDX-License-Identifier: Apache-2.0
#include "core/work/render_look.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <set>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/file.h"
#include "core/io/look_json.h"
#include "core/io/written_by.h"
#include "core/pipeline/output_target.h"
#include "core/scene/channel.h"
#include "core/stages/look_picture.h"
#include "core/stages/panorama_file.h"
#include "core/stages/project_sequence.h"
#include "core/stages/render_channels.h"
#include "core/work/last_solved.h"
#include "core/work/selection.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCommand = "render";

std::string namesOfLooks(const Project& project) {
  std::vector<std::string> names;
  for (const Look& look : project.looks()) names.push_back("\"" + look.name + "\"");
  return names.empty() ? "it has none" : fmt::format("it has {}", fmt::join(names, ", "));
}

std::shared_ptr<const Environment> panoramaOf(const RenderLookRequest& request, const Project& project,
                                              const Progress& progress) {
  const EnvironmentLight& light = request.look.look.lighting.environment;
  const bool ever = light.enabled || request.look.look.curves.contains("environment.enabled");
  if (!ever) return nullptr;
  std::optional<fs::path> file;
  if (light.file.empty()) {
    file = project.environmentFile();
  } else {
    file = resolve(light.file, request.look.folder);
    if (!file) {
      throw Error(
          Error::Kind::Data,
          fmt::format("the panorama of the look \"{}\" is gone: expected it at \"{}\"; put it back, "
                      "or name another in the look",
                      request.look.look.name,
                      light.file.absolute.empty() ? (request.look.folder / light.file.relative).string()
                                                  : light.file.absolute));
    }
  }
  return file ? openPanorama(*file, progress) : nullptr;
}

class LookWriter {
 public:
  LookWriter(const RenderLookRequest& request, const Project& project, const GaussianSequence& sequence,
             SceneRenderer& renderer, const Progress& progress)
      : request_(request),
        look_(request.look.look),
        sequence_(sequence),
        renderer_(renderer),
        panorama_(panoramaOf(request, project, progress)) {}

  void picture(FrameIndex frame, const std::shared_ptr<const GaussianFrame>& gaussians, const View& view,
               const fs::path& file, Progress& progress) {
    const std::string& name = nameOf(sequence_, frame);
    const Look now = at(look_, frame.value / sequence_.rate());
    RenderScene scene;
    scene.instances = {instanceOf(gaussians, sequence_.renderMode())};
    scene.lighting = now.lighting;
    scene.environment = panorama_;
    const ChannelInfo channels[] = {channelOf(kRelightChannel), channelOf(kAlphaChannel)};
    requireWhatIsNeeded(channels[0], scene, name);
    tell(renderer_.load(scene, progress));
    Planes relit, alpha;
    if (isLit(scene)) {
      renderer_.draw(view.camera, channels, progress, [&](const RenderedPicture& p) {
        if (!p.final) return;
        relit = *p.channels[0].values;
        alpha = *p.channels[1].values;
      });
    } else {  // all of its light is off at this time
      renderer_.draw(view.camera, {channels + 1, 1}, progress,
                     [&](const RenderedPicture& p) { alpha = *p.channels[0].values; });
      relit = Planes(alpha.width, alpha.height, 3);
    }
    const fs::path place = request_.out / file;
    fs::create_directories(place.parent_path());
    writeLookPicture(
        place, relit, alpha, now, {view.camera, panorama_.get()},
        {{"Software", writerOf(kCommand)},
         {"channel", file.begin()->string()},
         {"frame", name},
         {"camera", view.name},
         {"renderer", renderer_.abilities().id},
         {"color_state",
          now.view_transform == kRawTransform ? "scene-linear Rec.709, premultiplied" : "sRGB"}});
  }

  void requireLight() const {
    if (panorama_) return;
    RenderScene scene;
    scene.lighting = look_.lighting;
    for (Light& light : scene.lighting.lights)  // a curve may switch it on
      light.enabled |= look_.curves.contains("lights." + light.id + ".enabled");
    if (isLit(scene)) return;
    throw Error(
        Error::Kind::Usage,
        fmt::format("nothing shines in the look \"{}\": it has no lamp that is drawn, and no panorama "
                    "(its own, or that of the project, which {} --environment FILE sets)",
                    look_.name, "beam run"));
  }

 private:
  // Each once.
  void tell(const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences)
      if (told_.insert(sentence).second) logWarning("{}", sentence);
  }

  const RenderLookRequest& request_;
  const Look& look_;
  const GaussianSequence& sequence_;
  SceneRenderer& renderer_;
  std::shared_ptr<const Environment> panorama_;
  std::set<std::string> told_;
};

}  // namespace

ChosenLook chosenLook(const Project& project, const std::string& words) {
  if (const Look* look = project.look(words)) return {*look, project.folder()};
  const fs::path file(words);
  if (!isThere(file)) {
    throw Error(Error::Kind::Usage,
                fmt::format("--look expects the name of a look of the project or a file, found \"{}\": {}",
                            words, namesOfLooks(project)));
  }
  ChosenLook chosen{parseLook(readTextFile(file), file.string()), fs::absolute(file).parent_path()};
  if (chosen.look.name.empty()) chosen.look.name = file.stem().string();
  if (!isLookName(chosen.look.name)) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\": \"{}\" is no name of a look; give it another",
                                               file.string(), chosen.look.name));
  }
  return chosen;
}

RenderLookOutcome renderLook(const RenderLookRequest& request, SceneRenderer& renderer, Progress& progress) {
  requireOutside(request.out);
  const Look& look = request.look.look;
  const std::string_view extension = lookFileExtension(look);
  const LastSolved last = lastSolved(
      request.project,
      {.frames = request.frames, .between = true, .materials = true, .strict = request.strict}, progress);
  const Project& project = last.project;
  const auto sequence = sequenceOf(project, Shows::Between);
  const std::vector<View> views = selectViews(request.cameras, project.capture(), request.size);
  const std::vector<FrameIndex> frames = selectSolvedFrames(request.frames, *sequence, progress);
  const std::string folder = "look_" + look.name;
  const auto fileOf = [&](const View& view, FrameIndex frame) {
    return fs::path(folder) / view.name / fmt::format("{}.{}", nameOf(*sequence, frame), extension);
  };
  std::vector<fs::path> files;
  for (const View& view : views)
    for (const FrameIndex frame : frames) files.push_back(fileOf(view, frame));
  LookWriter writer(request, project, *sequence, renderer, progress);
  for (const std::string& remark : remarks(look)) logWarning("look \"{}\": {}", look.name, remark);
  if (look.camera_path.kind != CameraPath{}.kind)
    logWarning("look \"{}\": its camera path is not followed: the cameras stand", look.name);
  writer.requireLight();
  requireFolderTarget(request.out, files, {kCommand, request.force, inputFolders(project)});
  last.tell();
  const bool refines = renderer.abilities().refines;  // tells of a picture path by path
  if (!refines) progress.expect(static_cast<std::int64_t>(files.size()));
  for (const FrameIndex frame : frames) {
    const auto gaussians = solvedFrame(*sequence, frame);
    for (const View& view : views) {
      progress.check();
      if (refines) {
        Progress part =
            progress.part(1.0 / static_cast<double>(files.size()),
                          fmt::format("frame {}, camera {}", nameOf(*sequence, frame), view.name));
        writer.picture(frame, gaussians, view, fileOf(view, frame), part);
      } else {
        writer.picture(frame, gaussians, view, fileOf(view, frame), progress);
        progress.step();
      }
    }
  }
  return {folder, views.size(), frames.size(), interpolatedOf(*sequence, frames)};
}

}  // namespace beam
