// SPDX-License-Identifier: Apache-2.0
#include "core/stages/render_channels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/image_file.h"
#include "core/io/mesh_ply.h"
#include "core/math/color.h"
#include "core/scene/channel.h"
#include "core/scene/environment.h"
#include "core/scene/transform.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

Image<u8vec3> bytesOf(const Planes& color, bool encode) {
  Image<u8vec3> out(color.width, color.height, u8vec3(0), Encoding::Srgb);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const float c = std::clamp(color.plane(k)[i], 0.0f, 1.0f);
      out.pixels[i][k] = byteOf(encode ? srgbFromLinear(c) : c);
    }
  }
  return out;
}

Image<std::uint8_t> bytesOf(const Planes& shares) {
  Image<std::uint8_t> out(shares.width, shares.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) out.pixels[i] = byteOf(shares.values[i]);
  return out;
}

// Values of world axes and metres as the frame of the files has them. A turn leaves lengths as they are.
Planes inFrame(const ChannelInfo& channel, const Planes& values, const Similarity3& frame_from_world) {
  Planes out = values;
  if (channel.quantity == Quantity::Direction) {
    for (std::size_t i = 0; i < out.planeSize(); ++i) {
      const dvec3 v =
          frame_from_world.rotation * dvec3(values.plane(0)[i], values.plane(1)[i], values.plane(2)[i]);
      for (int c = 0; c < 3; ++c) out.plane(c)[i] = static_cast<float>(v[c]);
    }
  } else if (channel.quantity == Quantity::Length && frame_from_world.scale != 1) {
    for (float& v : out.values) v = static_cast<float>(frame_from_world.scale * v);
  }
  return out;
}

fs::path channelFile(const std::string& folder, const std::string& camera, const std::string& frame,
                     const ChannelInfo& channel) {
  const std::string name = fmt::format("{}.{}", frame, extensionOf(channel.file));
  return channel.id == kMeshChannel ? fs::path(folder) / name : fs::path(folder) / camera / name;
}

std::string relitFolder(const fs::path& environment) {
  return std::string(kRelightChannel) + "_" + environment.stem().string();
}

std::vector<std::string> relitFolders(const RenderRequest& request) {
  std::vector<std::string> folders;
  for (const fs::path& environment : request.environments) folders.push_back(relitFolder(environment));
  return folders;
}

std::string colorStateOf(const ChannelInfo& channel) {
  if (channel.quantity != Quantity::Color) return "data";
  return channel.file == FileForm::Png ? "sRGB" : "scene-linear Rec.709";
}

void writeChannel(const fs::path& file, const ChannelInfo& channel, const Planes& values,
                  const Similarity3& frame_from_world, const FileNotes& notes) {
  const bool three = componentsOf(channel) == 3;
  if (channel.file == FileForm::Png) {
    if (three)
      writePng(file, bytesOf(values, channel.encoding == Encoding::Linear), notes);
    else
      writePng(file, bytesOf(values), notes);
    return;
  }
  const bool half = channel.file == FileForm::HalfExr;
  writeExr(file, inFrame(channel, values, frame_from_world),
           three ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"},
           half ? ExrPrecision::Half : ExrPrecision::Float, notes);
}

class ChannelWriter {
 public:
  ChannelWriter(const GaussianSequence& sequence, const RenderRequest& request, SceneRenderer& renderer)
      : sequence_(sequence), request_(request), renderer_(renderer) {
    if (!request.world_frame) frame_from_world_ = sequence.captureFromWorld();
    for (const std::string& id : request.channels) {
      if (id == kMeshChannel)
        mesh_ = true;
      else if (id == kRelightChannel)
        relit_ = &channelOf(id);
      else
        drawn_.push_back(channelOf(id));
    }
    if (const std::string lost = roundingWarning(frame_from_world_); mesh_ && !lost.empty())
      logWarning("{}", lost);
    if (!relit_) return;
    for (const fs::path& file : request.environments) {
      lights_.push_back(
          {relitFolder(file), std::make_shared<const Environment>(makeEnvironment(readRadiance(file)))});
    }
  }

  void frame(FrameIndex frame, Progress& progress) {
    const std::string& name = nameOf(sequence_, frame);
    if (mesh_) mesh(frame, name, progress);
    if (drawn_.empty() && lights_.empty())
      return progress.step(static_cast<std::int64_t>(request_.views.size()));
    const std::shared_ptr<const GaussianFrame> result = solvedFrame(sequence_, frame);
    if (result->interpolated) logInfo("frame {} is interpolated", name);
    RenderScene scene;
    scene.instances = {instanceOf(result, sequence_.renderMode())};
    requireWhatIsNeeded(scene, name);
    for (const View& view : request_.views) {
      pictures(scene, view, name, progress);
      progress.step();
    }
  }

 private:
  // The light is the request's.
  void requireWhatIsNeeded(const RenderScene& scene, const std::string& name) const {
    for (const std::string& id : request_.channels) {
      const ChannelInfo& channel = channelOf(id);
      const Lack lack = lackOf(channel, scene);
      if (lack == Lack::Materials) {
        throw Error(
            Error::Kind::Data,
            fmt::format("frame {} has no materials yet, which {} needs: run Materials first", name, id));
      }
      if (lack == Lack::Attribute) {
        throw Error(Error::Kind::Data, fmt::format("the Gaussians of frame {} have no \"{}\", which {} shows",
                                                   name, channel.attribute, id));
      }
    }
  }

  // Its folder is there then.
  fs::path file(const std::string& folder, const std::string& camera, const std::string& name,
                const ChannelInfo& channel) const {
    const fs::path place = request_.out / channelFile(folder, camera, name, channel);
    fs::create_directories(place.parent_path());
    return place;
  }

  FileNotes notesOf(const ChannelInfo& channel, const std::string& folder, const std::string& camera,
                    const std::string& frame) const {
    if (request_.written_by.empty()) return {};
    FileNotes notes = {{"Software", request_.written_by}, {"channel", folder}, {"frame", frame}};
    if (!camera.empty()) notes.emplace_back("camera", camera);
    if (channel.quantity != Quantity::Color || channel.id == kMeshChannel)
      notes.emplace_back("axes", request_.world_frame ? "world" : "capture");
    if (!channel.unit.empty()) notes.emplace_back("unit", lengthUnit(frame_from_world_));
    if (channel.id == kMeshChannel) return notes;
    notes.emplace_back("color_state", colorStateOf(channel));
    if (channel.times_alpha) notes.emplace_back("alpha", "value x alpha, composited on black");
    return notes;
  }

  void mesh(FrameIndex frame, const std::string& name, const Progress& progress) const {
    const std::shared_ptr<const Mesh> m = sequence_.mesh(frame);
    if (!m && sequence_.content(frame).interpolated)
      return logInfo("frame {} is interpolated: it has no mesh", name);
    if (!m) throw Error(Error::Kind::Data, fmt::format("frame {} has no mesh yet: run Surface first", name));
    const ChannelInfo& channel = channelOf(kMeshChannel);
    writeMeshPly(file(kMeshChannel, {}, name, channel), transformed(*m, frame_from_world_),
                 {.progress = &progress, .notes = notesOf(channel, kMeshChannel, {}, name)});
  }

  // One of each channel; `folders` name them.
  void draw(const RenderScene& scene, const View& view, const std::string& name,
            std::span<const ChannelInfo> channels, const std::vector<std::string>& folders,
            Progress& progress) {
    renderer_.load(scene, progress);
    renderer_.draw(view.camera, channels, progress, [&](const RenderedPicture& picture) {
      if (!picture.final) return;
      for (std::size_t i = 0; i < channels.size(); ++i) {
        progress.check();
        writeChannel(file(folders[i], view.name, name, channels[i]), channels[i], *picture.channels[i].values,
                     frame_from_world_, notesOf(channels[i], folders[i], view.name, name));
      }
    });
  }

  void pictures(RenderScene scene, const View& view, const std::string& name, Progress& progress) {
    std::vector<std::string> folders;
    for (const ChannelInfo& c : drawn_) folders.push_back(c.id);
    if (!drawn_.empty()) draw(scene, view, name, drawn_, folders, progress);
    for (const Light& light : lights_) {
      scene.environment = light.environment;
      draw(scene, view, name, {relit_, 1}, {light.folder}, progress);
    }
  }

  struct Light {
    std::string folder;
    std::shared_ptr<const Environment> environment;
  };

  const GaussianSequence& sequence_;
  const RenderRequest& request_;
  SceneRenderer& renderer_;
  Similarity3 frame_from_world_;
  bool mesh_ = false;
  const ChannelInfo* relit_ = nullptr;  // asked for
  std::vector<ChannelInfo> drawn_;      // what does not depend on the light
  std::vector<Light> lights_;
};

void check(const RenderRequest& request, const RendererAbilities& abilities) {
  for (const std::string& id : request.channels) {
    const ChannelInfo& channel = channelOf(id);
    if (id != kMeshChannel && !draws(abilities, channel)) {
      throw Error(Error::Kind::Usage, fmt::format("the renderer {} does not draw {}: it draws {}",
                                                  abilities.id, id, fmt::join(abilities.channels, ", ")));
    }
    if (channel.needs == ChannelNeeds::MaterialsAndLight && request.environments.empty()) {
      throw Error(Error::Kind::Usage,
                  fmt::format("the channel {} needs a panorama: give --environment FILE", id));
    }
  }
  if (abilities.needs_context)
    throw Error(Error::Kind::Bug, "render channels: a renderer that draws textures");
}

}  // namespace

std::vector<fs::path> channelFiles(const GaussianSequence& sequence, const RenderRequest& request) {
  std::vector<fs::path> files;
  const auto add = [&](const std::string& folder, const std::string& camera, const ChannelInfo& channel) {
    for (const FrameIndex frame : request.frames)
      files.push_back(channelFile(folder, camera, nameOf(sequence, frame), channel));
  };
  for (const std::string& id : request.channels) {
    const ChannelInfo& channel = channelOf(id);
    if (id == kMeshChannel) {
      add(id, {}, channel);
      continue;
    }
    std::vector<std::string> folders = {id};
    if (id == kRelightChannel) folders = relitFolders(request);
    for (const std::string& folder : folders) {
      for (const View& view : request.views) add(folder, view.name, channel);
    }
  }
  return files;
}

void renderChannels(const GaussianSequence& sequence, const RenderRequest& request, SceneRenderer& renderer,
                    Progress& progress) {
  check(request, renderer.abilities());
  progress.expect(static_cast<std::int64_t>(request.frames.size() * request.views.size()));
  ChannelWriter writer(sequence, request, renderer);
  for (const FrameIndex f : request.frames) writer.frame(f, progress);
}

}  // namespace beam
