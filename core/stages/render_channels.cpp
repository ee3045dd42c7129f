// SPDX-License-Identifier: Apache-2.0
#include "core/stages/render_channels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/base/word_list.h"
#include "core/io/file.h"
#include "core/io/file_notes.h"
#include "core/io/image_file.h"
#include "core/io/mesh_ply.h"
#include "core/pipeline/file_digest.h"
#include "core/scene/channel.h"
#include "core/scene/environment.h"
#include "core/scene/frame_list.h"
#include "core/scene/transform.h"
#include "core/stages/panorama_file.h"
#include "core/stages/picture_files.h"
#include "core/stages/picture_source.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

fs::path pictureFile(const std::string& folder, const std::string& camera, const std::string& frame,
                     FileForm form) {
  return fs::path(folder) / camera / fmt::format("{}.{}", frame, extensionOf(form));
}

fs::path meshFile(const std::string& frame) {
  return fs::path(kMeshChannel) / fmt::format("{}.{}", frame, extensionOf(FileForm::Ply));
}

std::string relitName(const fs::path& environment) {
  return std::string(kRelightChannel) + "_" + environment.stem().string();
}

bool needsLight(const ChannelInfo& channel) { return channel.needs == ChannelNeeds::MaterialsAndLight; }

bool isLit(const RenderRequest& request) {
  return std::any_of(request.channels.begin(), request.channels.end(),
                     [](const std::string& id) { return needsLight(channelOf(id)); });
}

bool byOcclusion(const RenderRequest& request, const RendererAbilities& abilities) {
  return abilities.occlusion && request.lighting.environment.shadows == kOcclusionAlone;
}

// Which way of light is in a picture, in words.
std::string litBy(const RenderRequest& request, const RendererAbilities& abilities) {
  std::string text = abilities.id;
  if (!abilities.settings.empty()) text += ", " + abilities.settings;
  if (byOcclusion(request, abilities)) text += ", ambient occlusion alone";
  return text;
}

// Of every channel that is a picture, in order of the request: channel and name; relit ones once a panorama.
std::vector<DrawnChannel> picturesOf(const RenderRequest& request) {
  std::vector<DrawnChannel> pictures;
  for (const std::string& id : request.channels) {
    const ChannelInfo& channel = channelOf(id);
    if (id == kMeshChannel) continue;
    if (id != kRelightChannel) pictures.push_back({channel, id, nullptr});
    if (id != kRelightChannel) continue;
    for (const fs::path& environment : request.environments)
      pictures.push_back({channel, relitName(environment), nullptr});
  }
  return pictures;
}

// The layers of a file. Colour brings its coverage along, as a nameless alpha where none is asked for.
std::vector<DrawnChannel> layersOf(const RenderRequest& request, const RendererAbilities& abilities) {
  std::vector<DrawnChannel> layers = picturesOf(request);
  const auto holds = [&](const char* id) {
    return std::any_of(layers.begin(), layers.end(),
                       [&](const DrawnChannel& d) { return d.channel.id == id; });
  };
  const ChannelInfo& alpha = channelOf(kAlphaChannel);
  if (holds(kRgbChannel) && !holds(kAlphaChannel) && draws(abilities, alpha))
    layers.push_back({alpha, {}, nullptr});
  return layers;
}

// A file of pictures of one camera and frame: one channel, or the layers.
struct PictureFile {
  std::string folder;
  FileForm form = FileForm::HalfExr;
  std::vector<DrawnChannel> channels;  // without values
};

std::vector<PictureFile> pictureFilesOf(const RenderRequest& request, const RendererAbilities& abilities) {
  std::vector<PictureFile> files;
  if (request.layers) {
    files.push_back({kLayersFolder, FileForm::HalfExr, layersOf(request, abilities)});
    if (files[0].channels.empty()) files.clear();
    return files;
  }
  for (DrawnChannel& d : picturesOf(request)) files.push_back({d.name, d.channel.file, {d}});
  return files;
}

class ChannelWriter {
 public:
  ChannelWriter(const GaussianSequence& sequence, const RenderRequest& request, SceneRenderer& renderer)
      : sequence_(sequence),
        request_(request),
        renderer_(renderer),
        files_(pictureFilesOf(request, renderer.abilities())) {
    if (!request.world_frame) frame_from_world_ = sequence.captureFromWorld();
    mesh_ =
        std::find(request.channels.begin(), request.channels.end(), kMeshChannel) != request.channels.end();
    if (const std::string lost = roundingWarning(frame_from_world_); mesh_ && !lost.empty())
      logWarning("{}", lost);
    for (std::size_t e = 0; isLit(request) && e < request.environments.size(); ++e) {
      const fs::path& file = request.environments[e];
      const Light light{openPanorama(file), request.written_by.empty() ? Digest{} : digestOfFile(file)};
      lights_[relitName(file)] = light;
      for (const char* part : {kDirectChannel, kIndirectChannel, kVarianceChannel}) lights_[part] = light;
    }
  }

  void frame(FrameIndex frame, Progress& progress) {
    const std::string& name = nameOf(sequence_, frame);
    stamp_ = request_.written_by.empty() ? Digest{} : sequence_.stamp(frame).value_or(Digest{});
    if (mesh_) mesh(frame, name, progress);
    const std::vector<std::vector<const PictureFile*>> missing = missingFiles(name, progress);
    const bool none = std::all_of(missing.begin(), missing.end(), [](const auto& m) { return m.empty(); });
    if (none && (files_.empty() || request_.skip_existing)) return pass(request_.views.size(), progress);
    const std::shared_ptr<const GaussianFrame> result = solvedFrame(sequence_, frame);
    if (result->interpolated) logInfo("frame {} is interpolated", name);
    RenderScene scene;
    scene.instances = {instanceOf(result, sequence_.renderMode())};
    scene.lighting = request_.lighting;
    for (const std::string& id : request_.channels) requireWhatIsNeeded(channelOf(id), scene, name);
    if (!lights_.empty() && lacksVisibility(scene, renderer_.abilities())) {
      without_visibility_.push_back(name);
      places_without_.push_back(frame.value);
    }
    for (std::size_t v = 0; v < missing.size(); ++v) {
      const View& view = request_.views[v];
      if (!renderer_.abilities().refines) {
        if (!missing[v].empty()) pictures(scene, view, name, missing[v], progress);
        progress.step();
        continue;
      }
      Progress part = progress.part(share(1), fmt::format("frame {}, camera {}", name, view.name));
      if (!missing[v].empty()) pictures(scene, view, name, missing[v], part);
    }
  }

  // Also says what of the wanted light could not be had.
  RenderedFiles done() const {
    if (!without_visibility_.empty()) {
      logWarning("frames {}: no visibility was baked: {}; run Materials to bake it",
                 shortList(frameRanges(without_visibility_, places_without_)),
                 renderer_.abilities().without_visibility);
    }
    return done_;
  }

 private:
  // Of all pictures of all frames. One of a renderer that refines takes long and is told of path by path.
  double share(std::size_t views) const {
    return static_cast<double>(views) / static_cast<double>(request_.views.size() * request_.frames.size());
  }
  void pass(std::size_t views, Progress& progress) const {
    if (renderer_.abilities().refines)
      progress.part(share(views), {});
    else
      progress.step(static_cast<std::int64_t>(views));
  }

  // Of each view.
  std::vector<std::vector<const PictureFile*>> missingFiles(const std::string& name,
                                                            const Progress& progress) {
    std::vector<std::vector<const PictureFile*>> missing(request_.views.size());
    for (std::size_t v = 0; v < missing.size(); ++v) {
      for (const PictureFile& file : files_) {
        progress.check();
        const View& view = request_.views[v];
        if (isKept(pictureFile(file.folder, view.name, name, file.form), sourceOf(file, view, name)))
          ++done_.kept;
        else
          missing[v].push_back(&file);
      }
    }
    return missing;
  }

  bool isKept(const fs::path& file, const std::string& source) const {
    return request_.skip_existing && isMadeFrom(request_.out / file, request_.written_by, source);
  }

  // Its folder is there then.
  fs::path placeOf(const fs::path& file) const {
    const fs::path place = request_.out / file;
    fs::create_directories(place.parent_path());
    return place;
  }

  const char* axes() const { return request_.world_frame ? "world" : "capture"; }

  PictureSource sourceOf(const std::string& name) const {
    return {.renderer = {},
            .frame_stamp = stamp_,
            .frame = name,
            .frame_from_world = frame_from_world_,
            .axes = axes(),
            .channels = {kMeshChannel}};
  }

  std::string sourceOf(const PictureFile& file, const View& view, const std::string& name) const {
    PictureSource source = sourceOf(name);
    source.renderer = renderer_.abilities().id;
    if (!renderer_.abilities().settings.empty()) source.renderer += ", " + renderer_.abilities().settings;
    source.mode = sequence_.renderMode();
    source.camera = &view.camera;
    source.channels = {file.folder};
    for (const DrawnChannel& d : file.channels) {
      source.channels.push_back(d.name);
      if (const auto light = lights_.find(d.name); light != lights_.end()) {
        source.panoramas.push_back(light->second.digest);
        if (byOcclusion(request_, renderer_.abilities())) source.shadows = kOcclusionAlone;
      }
    }
    return digestText(source);
  }

  // `channel`: empty of layers. Those of the file's own content follow.
  FileNotes beginNotes(const std::string& channel, const std::string& frame,
                       const std::string& camera) const {
    FileNotes notes = {{"Software", request_.written_by}};
    if (!channel.empty()) notes.emplace_back("channel", channel);
    notes.emplace_back("frame", frame);
    if (!camera.empty()) notes.emplace_back("camera", camera);
    return notes;
  }

  FileNotes notesOf(const PictureFile& file, const View& view, const std::string& frame) const {
    if (request_.written_by.empty()) return {};
    FileNotes notes = beginNotes(request_.layers ? std::string() : file.folder, frame, view.name);
    const auto any = [&](auto&& holds) {
      return std::any_of(file.channels.begin(), file.channels.end(),
                         [&](const DrawnChannel& d) { return holds(d.channel); });
    };
    if (any([](const ChannelInfo& c) { return c.quantity != Quantity::Color; }))
      notes.emplace_back("axes", axes());
    if (any([](const ChannelInfo& c) { return c.quantity == Quantity::Length; }))
      notes.emplace_back("unit", lengthUnit(frame_from_world_));
    else if (const std::string& unit = file.channels[0].channel.unit; !unit.empty())
      notes.emplace_back("unit", unit);
    PanoramaDigests panoramas;
    for (const DrawnChannel& d : file.channels) {
      if (const auto light = lights_.find(d.name); light != lights_.end())
        panoramas[d.name] = light->second.digest.hex();
    }
    if (!panoramas.empty()) {
      notes.emplace_back(kPanoramaNote, panoramaText(panoramas));
      notes.emplace_back(kLitByNote, litBy(request_, renderer_.abilities()));
    }
    if (!request_.layers) {
      const ChannelInfo& channel = file.channels[0].channel;
      notes.emplace_back("color_state", colorStateOf(channel));
      if (channel.times_alpha) notes.emplace_back("alpha", "value x alpha, composited on black");
    }
    addSource(sourceOf(file, view, frame), notes);
    return notes;
  }

  FileNotes meshNotes(const std::string& name, const std::string& source) const {
    if (request_.written_by.empty()) return {};
    FileNotes notes = beginNotes(kMeshChannel, name, {});
    notes.emplace_back("axes", axes());
    notes.emplace_back("unit", lengthUnit(frame_from_world_));
    addSource(source, notes);
    return notes;
  }

  static void addSource(const std::string& digest, FileNotes& notes) {
    if (!digest.empty()) notes.emplace_back(kSourceNote, digest);
  }

  void mesh(FrameIndex frame, const std::string& name, const Progress& progress) {
    const std::string source = digestText(sourceOf(name));
    if (isKept(meshFile(name), source)) {
      ++done_.kept;
      return;
    }
    const std::shared_ptr<const Mesh> m = sequence_.mesh(frame);
    if (!m && sequence_.content(frame).interpolated)
      return logInfo("frame {} is interpolated: it has no mesh", name);
    if (!m) throw Error(Error::Kind::Data, fmt::format("frame {} has no mesh yet: run Surface first", name));
    writeMeshPly(placeOf(meshFile(name)), transformed(*m, frame_from_world_),
                 {.progress = &progress, .notes = meshNotes(name, source)});
    ++done_.written;
  }

  void write(const PictureFile& file, const View& view, const std::string& name,
             std::span<const DrawnChannel> drawn, const Progress& progress) {
    const fs::path place = placeOf(pictureFile(file.folder, view.name, name, file.form));
    const FileNotes notes = notesOf(file, view, name);
    if (request_.layers)
      writeLayers(place, drawn, frame_from_world_, notes, progress);
    else
      writePicture(place, drawn[0], frame_from_world_, notes);
    ++done_.written;
  }

  // One load and draw: channels that no light touches, or one that a panorama lights.
  void draw(const RenderScene& scene, const View& view, std::span<DrawnChannel* const> drawn,
            Progress& progress) {
    std::vector<ChannelInfo> channels;
    for (const DrawnChannel* d : drawn) channels.push_back(d->channel);
    renderer_.load(scene, progress);
    renderer_.draw(view.camera, channels, progress, [&](const RenderedPicture& picture) {
      if (!picture.final) return;
      for (std::size_t i = 0; i < drawn.size(); ++i) drawn[i]->values = picture.channels[i].values;
    });
  }

  void pictures(RenderScene scene, const View& view, const std::string& name,
                std::span<const PictureFile* const> files, Progress& progress) {
    std::vector<std::vector<DrawnChannel>> drawn;
    for (const PictureFile* file : files) drawn.push_back(file->channels);
    std::vector<DrawnChannel*> unlit, lit;
    for (std::vector<DrawnChannel>& channels : drawn) {
      for (DrawnChannel& d : channels) (needsLight(d.channel) ? lit : unlit).push_back(&d);
    }
    const auto writeDone = [&] {
      for (std::size_t f = 0; f < files.size(); ++f) {
        const auto has = [](const DrawnChannel& d) { return d.values != nullptr; };
        if (drawn[f].empty() || !std::all_of(drawn[f].begin(), drawn[f].end(), has)) continue;
        progress.check();
        write(*files[f], view, name, drawn[f], progress);
        drawn[f].clear();
      }
    };
    if (!unlit.empty()) draw(scene, view, unlit, progress);
    writeDone();
    // What one light gives is drawn together.
    while (!lit.empty()) {
      scene.environment = lights_.at(lit[0]->name).environment;
      const auto others = std::stable_partition(lit.begin(), lit.end(), [&](const DrawnChannel* d) {
        return lights_.at(d->name).environment == scene.environment;
      });
      draw(scene, view, {lit.begin(), others}, progress);
      lit.erase(lit.begin(), others);
      writeDone();
    }
  }

  struct Light {
    std::shared_ptr<const Environment> environment;
    Digest digest;  // of its file; of pictures that say nothing, none
  };

  const GaussianSequence& sequence_;
  const RenderRequest& request_;
  SceneRenderer& renderer_;
  const std::vector<PictureFile> files_;
  Similarity3 frame_from_world_;
  bool mesh_ = false;
  std::map<std::string, Light> lights_;          // by the name of what they light
  Digest stamp_;                                 // of the frame at work
  std::vector<std::string> without_visibility_;  // frames that were relit so, though it was wanted
  std::vector<int> places_without_;              // of these in the capture
  RenderedFiles done_;
};

void requirePanoramas(const RenderRequest& request) {
  for (const std::string& id : request.channels) {
    if (!needsLight(channelOf(id))) continue;
    if (request.environments.empty()) {
      throw Error(Error::Kind::Usage,
                  fmt::format("the channel {} needs a panorama: give --environment FILE", id));
    }
    if (id != kRelightChannel && request.environments.size() > 1)
      throw Error(Error::Kind::Usage, fmt::format("the channel {} is of one panorama at a time", id));
  }
  if (!isLit(request)) return;
  std::map<std::string, fs::path> named;
  for (const fs::path& file : request.environments) {
    const auto [other, fresh] = named.try_emplace(relitName(file), file);
    if (fresh) continue;
    throw Error(
        Error::Kind::Usage,
        fmt::format("the panoramas \"{}\" and \"{}\" would both be written as {}: expected other names; "
                    "rename one, or relight with one after the other into folders of their own",
                    other->second.string(), file.string(), other->first));
  }
}

}  // namespace

void requireWhatIsNeeded(const ChannelInfo& channel, const RenderScene& scene, const std::string& name) {
  const Lack lack = lackOf(channel, scene);
  if (lack == Lack::Materials) {
    throw Error(
        Error::Kind::Data,
        fmt::format("frame {} has no materials yet, which {} needs: run Materials first", name, channel.id));
  }
  if (lack == Lack::Attribute) {
    throw Error(Error::Kind::Data, fmt::format("the Gaussians of frame {} have no \"{}\", which {} shows",
                                               name, channel.attribute, channel.id));
  }
}

void requireDrawable(const RenderRequest& request, const RendererAbilities& abilities) {
  for (const std::string& id : request.channels) {
    const ChannelInfo& channel = channelOf(id);
    if (id != kMeshChannel && !draws(abilities, channel)) {
      throw Error(Error::Kind::Usage, fmt::format("the renderer {} does not draw {}: it draws {}",
                                                  abilities.id, id, fmt::join(abilities.channels, ", ")));
    }
  }
  requirePanoramas(request);
  if (abilities.needs_context)
    throw Error(Error::Kind::Bug, "render channels: a renderer that draws textures");
  if (!request.layers) return;
  const std::vector<DrawnChannel> layers = layersOf(request, abilities);
  for (const View& view : request.views) {
    if (!layers.empty())
      requireLayers(request.out / kLayersFolder / view.name, layers, view.camera.width, view.camera.height);
  }
}

void requireOneLight(const RenderRequest& request, const RendererAbilities& abilities,
                     std::span<const fs::path> files) {
  const std::set<fs::path> replaced(files.begin(), files.end());
  for (const DrawnChannel& d : picturesOf(request)) {
    if (!needsLight(d.channel)) continue;
    const auto panorama = std::find_if(
        request.environments.begin(), request.environments.end(), [&](const fs::path& environment) {
          return d.channel.id != kRelightChannel || relitName(environment) == d.name;
        });
    const std::string now = digestOfFile(*panorama).hex();
    const fs::path folder = request.out / (request.layers ? kLayersFolder : d.name);
    for (const fs::directory_entry& entry : entriesBelow(folder)) {
      if (replaced.contains(entry.path().lexically_relative(request.out))) continue;
      const FileNotes notes = notesIn(entry.path());
      const PanoramaDigests lit = panoramasOf(noteIn(notes, kPanoramaNote));
      const auto other = lit.find(d.name);
      if (other == lit.end()) continue;
      if (other->second == now) {
        const std::string by = noteIn(notes, kLitByNote), here = litBy(request, abilities);
        if (by.empty() || by == here) break;  // as are those beside it
        throw Error(Error::Kind::Usage,
                    fmt::format("\"{}\" was lit by the renderer {}, and this would be by {}: choose another "
                                "--out, or give --force",
                                entry.path().string(), by, here));
      }
      throw Error(Error::Kind::Usage,
                  fmt::format("\"{}\" was lit by another panorama than \"{}\", and both would be {}: choose "
                              "another --out, rename the panorama, or give --force",
                              entry.path().string(), panorama->string(), d.name));
    }
  }
}

std::vector<fs::path> channelFiles(const GaussianSequence& sequence, const RenderRequest& request) {
  std::vector<fs::path> files;
  const auto add = [&](const std::string& folder, FileForm form) {
    for (const View& view : request.views) {
      for (const FrameIndex frame : request.frames)
        files.push_back(pictureFile(folder, view.name, nameOf(sequence, frame), form));
    }
  };
  for (const std::string& id : request.channels) {
    if (channelOf(id).id != kMeshChannel) continue;
    for (const FrameIndex frame : request.frames) files.push_back(meshFile(nameOf(sequence, frame)));
  }
  for (const PictureFile& file : pictureFilesOf(request, {})) add(file.folder, file.form);
  return files;
}

RenderedFiles renderChannels(const GaussianSequence& sequence, const RenderRequest& request,
                             SceneRenderer& renderer, Progress& progress) {
  requireDrawable(request, renderer.abilities());
  if (!renderer.abilities().refines)
    progress.expect(static_cast<std::int64_t>(request.frames.size() * request.views.size()));
  ChannelWriter writer(sequence, request, renderer);
  for (const FrameIndex f : request.frames) writer.frame(f, progress);
  return writer.done();
}

}  // namespace beam
