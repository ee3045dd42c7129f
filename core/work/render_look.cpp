// SPDX-License-Identifier: Apache-2.0
#include "core/work/render_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/look_json.h"
#include "core/io/movie_file.h"
#include "core/io/scene_document_json.h"
#include "core/io/written_by.h"
#include "core/pipeline/output_target.h"
#include "core/scene/channel.h"
#include "core/stages/look_picture.h"
#include "core/stages/project_sequence.h"
#include "core/stages/render_channels.h"
#include "core/work/last_solved.h"
#include "core/work/selection.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCommand = "render";
constexpr float kFaint = 0.1f;  // opacity of Gaussians that tell nothing of where the subject is

// Of all Gaussians: strays do not move it.
dvec3 middleOf(const RenderScene& scene) {
  std::array<std::vector<float>, 3> along;
  for (const RenderInstance& i : scene.instances) {
    for (std::size_t g = 0; g < i.cloud->size(); ++g) {
      if (i.cloud->opacity[g] < kFaint) continue;
      const dvec3 x_m = i.world_from_cloud * dvec3(i.cloud->position_m[g]);
      for (int k = 0; k < 3; ++k) along[k].push_back(static_cast<float>(x_m[k]));
    }
  }
  dvec3 middle(0);
  for (int k = 0; k < 3; ++k) {
    if (along[k].empty()) continue;
    const auto half = along[k].begin() + std::ssize(along[k]) / 2;
    std::nth_element(along[k].begin(), half, along[k].end());
    middle[k] = *half;
  }
  return middle;
}

class LookWriter {
 public:
  LookWriter(const RenderLookRequest& request, const GaussianSequence& sequence, LookScene& scenes,
             SceneRenderer& renderer)
      : request_(request),
        look_(request.look.look),
        sequence_(sequence),
        scenes_(scenes),
        renderer_(renderer) {}

  // The picture as it was written.
  LookPicture write(const LookShot& shot, Progress& progress) {
    const Look now = at(look_, shot.time_s);
    const RenderScene scene = scenes_.at(shot.time_s, shot.frame);
    requireWhatIsNeeded(channelOf(kRelightChannel), scene, nameOf(sequence_, shot.frame));
    tell(renderer_.load(scene, progress));
    if (lacksVisibility(scene, renderer_.abilities()))
      tell({fmt::format("Gaussians without visibility, of materials that were made before it was baked: {}",
                        renderer_.abilities().without_visibility)});
    const auto [relit, alpha] = drawn(shot.camera, scene, progress);
    LookPicture picture = lookPicture(relit, alpha, now, {shot.camera, scenes_.panorama().get()});
    const fs::path place = request_.out / shot.file;
    fs::create_directories(place.parent_path());
    writeLookPicture(place, picture, notesOf(shot, now));
    return picture;
  }

 private:
  struct Drawn {
    Planes relit, alpha;
  };
  Drawn drawn(const Camera& camera, const RenderScene& scene, Progress& progress) {
    const ChannelInfo channels[] = {channelOf(kRelightChannel), channelOf(kAlphaChannel)};
    Drawn out;
    if (isLit(scene)) {
      renderer_.draw(camera, channels, progress, [&](const RenderedPicture& p) {
        if (p.final) out = {*p.channels[0].values, *p.channels[1].values};
      });
    } else {  // all of its light is off at this time
      renderer_.draw(camera, {channels + 1, 1}, progress,
                     [&](const RenderedPicture& p) { out.alpha = *p.channels[0].values; });
      out.relit = Planes(out.alpha.width, out.alpha.height, 3);
    }
    return out;
  }

  FileNotes notesOf(const LookShot& shot, const Look& now) const {
    return {{"Software", writerOf(kCommand)},
            {"channel", shot.file.begin()->string()},
            {"frame", nameOf(sequence_, shot.frame)},
            {"camera", shot.camera_name},
            {"renderer", renderer_.abilities().id},
            {"color_state",
             now.view_transform == kRawTransform ? "scene-linear Rec.709, premultiplied" : "sRGB"}};
  }

  // Each once.
  void tell(const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences)
      if (told_.insert(sentence).second) logWarning("{}", sentence);
  }

  const RenderLookRequest& request_;
  const Look& look_;
  const GaussianSequence& sequence_;
  LookScene& scenes_;
  SceneRenderer& renderer_;
  std::set<std::string> told_;
};

// The film beside the pictures; empty: there can be none, which is said.
fs::path filmFile(const ChosenPath& path, const std::string& folder, std::string_view extension) {
  if (extension != "png") {
    logWarning("no film of pictures in OpenEXR, which view_transform raw gives");
    return {};
  }
  if (!canWriteMovies()) {
    logWarning("no film: the program ffmpeg is not installed (package ffmpeg); the pictures are written");
    return {};
  }
  return fs::path(folder) / (path.name + ".mp4");
}

// body(shot, progress) of each, in order.
template <class Body>
void forEachShot(const std::vector<LookShot>& shots, bool refines, Progress& progress, Body&& body) {
  if (!refines) progress.expect(static_cast<std::int64_t>(shots.size()), "pictures");
  for (const LookShot& shot : shots) {
    progress.check();
    if (refines) {  // tells of a picture path by path
      Progress part = progress.part(1.0 / static_cast<double>(shots.size()), shot.file.string());
      body(shot, part);
    } else {
      body(shot, progress);
      progress.step();
    }
  }
}

void tellOfLook(const RenderLookRequest& request, bool moves) {
  const Look& look = request.look.look;
  for (const std::string& remark : remarks(look)) logWarning("look \"{}\": {}", look.name, remark);
  for (const std::string& path :
       request.look.scene ? unknownMembers(*request.look.scene) : unknownMembers(look))
    logWarning("look \"{}\": \"{}\" is nothing that this program knows: it has no effect", look.name, path);
  if (!moves && (request.timing.duration_s || request.timing.rate))
    throw Error(Error::Kind::Usage, "--duration and --rate are of a camera that moves: add --camera-path");
}

}  // namespace

RenderLookOutcome renderLook(const RenderLookRequest& request, SceneRenderer& renderer, Progress& progress) {
  requireOutside(request.out);
  const Look& look = request.look.look;
  const std::string_view extension = lookFileExtension(at(look, 0));
  const std::optional<ChosenPath> path = chosenPath(request.camera_path, look, request.look.folder);
  tellOfLook(request, path.has_value());
  const LastSolved last = lastSolved(
      request.project,
      {.frames = request.frames, .between = true, .materials = true, .strict = request.strict}, progress);
  const Project& project = last.project;
  const auto sequence = sequenceOf(project, Shows::Between);
  const std::vector<View> views = selectViews(request.cameras, project.capture(), request.size);
  const std::vector<FrameIndex> frames = selectSolvedFrames(request.frames, *sequence, progress);
  LookScene scenes(request.look, project, sequence, progress);
  scenes.requireLight();
  RenderLookOutcome outcome{.folder = "look_" + look.name,
                            .cameras = path ? 0 : views.size(),
                            .frames = frames.size(),
                            .interpolated = interpolatedOf(*sequence, frames)};
  Film film;
  if (path) {
    film = filmShots(
        *path, request.timing, views.front(), frames, *sequence,
        [&] { return middleOf(scenes.at(0, frames.front())); }, outcome.folder, extension);
    outcome.film = filmFile(*path, outcome.folder, extension).string();
  } else {
    film.shots = standingShots(views, frames, *sequence, outcome.folder, extension);
  }
  std::vector<fs::path> files;
  for (const LookShot& shot : film.shots) files.push_back(shot.file);
  if (!outcome.film.empty()) files.emplace_back(outcome.film);
  requireFolderTarget(request.out, files, {kCommand, request.force, inputFolders(project)});
  last.tell();
  LookWriter writer(request, *sequence, scenes, renderer);
  std::unique_ptr<MovieWriter> movie;
  if (!outcome.film.empty()) {
    fs::create_directories((request.out / outcome.film).parent_path());
    movie = std::make_unique<MovieWriter>(request.out / outcome.film,
                                          ivec2(views.front().camera.width, views.front().camera.height),
                                          film.rate, FileNotes{{"Software", writerOf(kCommand)}});
  }
  forEachShot(film.shots, renderer.abilities().refines, progress, [&](const LookShot& shot, Progress& part) {
    const LookPicture picture = writer.write(shot, part);
    if (movie) movie->add(onBlack(picture), &progress);
  });
  if (movie) movie->finish(&progress);
  outcome.pictures = film.shots.size();
  return outcome;
}

}  // namespace beam
