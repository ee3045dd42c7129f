// SPDX-License-Identifier: Apache-2.0
#include "ui/picture_sources.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/base/error.h"
#include "core/io/image_file.h"
#include "core/render/scene_renderer.h"
#include "core/scene/gbuffer.h"
#include "core/stages/result_files.h"
#include "core/stages/step_ids.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

// A channel as a picture: of what is blended the surface's own value, of colours what is seen.
Picture pictureOf(const ChannelInfo& channel, const Planes& values, const Planes& alpha, std::string label) {
  Picture p;
  p.label = std::move(label);
  p.values = values;
  p.encoding = channel.encoding;
  p.false_color = channel.false_color;
  p.unit = channel.unit;
  if (channel.quantity == Quantity::Color || !channel.times_alpha) return p;
  for (std::size_t i = 0; i < p.values.values.size(); ++i) {
    const float cover = alpha.values[i % alpha.planeSize()];
    p.values.values[i] = cover < kVisibleAlpha ? 0 : values.values[i] / cover;
  }
  return p;
}

struct Shot {
  std::shared_ptr<const CaptureSet> capture;
  ViewIndex view;
  FrameIndex frame;
  std::string camera, frame_name, where;  // "C03", "000002", "camera C03 · frame 000002"
};

[[noreturn]] void refuse(const std::string& why) { throw Error(Error::Kind::Data, why); }

Image<std::uint8_t> maskOf(const Shot& shot) {
  Image<std::uint8_t> mask = shot.capture->source->mask(shot.view, shot.frame);
  if (mask.empty()) refuse(fmt::format("camera {} has no mask of frame {}", shot.camera, shot.frame_name));
  return mask;
}

Picture photographOf(const Shot& shot) {
  const auto& source = shot.capture->source;
  if (!source || !source->has(shot.view, shot.frame))
    refuse(fmt::format("camera {} has no photograph of frame {}", shot.camera, shot.frame_name));
  Picture p = pictureOf(source->photo(shot.view, shot.frame), fmt::format("Photograph · {}", shot.where));
  if (shot.capture->masks != MaskKind::None) p.mask = [shot] { return maskOf(shot); };
  return p;
}

void addPhotograph(std::vector<PictureSource>& sources, const Shot& shot) {
  const PictureIngredients made_of{.values = {shot.capture}, .view = shot.view, .frame = shot.frame};
  sources.push_back({"photo", "Photograph", made_of, [shot] { return photographOf(shot); }});
  if (!shot.capture->source || shot.capture->masks == MaskKind::None) return;
  sources.push_back({"mask", "Mask", made_of,
                     [shot] { return pictureOf(maskOf(shot), fmt::format("Mask · {}", shot.where)); }});
}

// What a rendered channel is made of, and what it lacks.
struct Render {
  Shot shot;
  FrameValues values;
  PictureLight light;
  SceneRendererFactory new_renderer;
};

void refuseWhatIsNotThere(const Render& r, const ChannelInfo& channel, Lack lack) {
  switch (lack) {
    case Lack::None:
      return;
    case Lack::Materials:
      refuse(fmt::format("{} needs materials, which frame {} does not have yet. Run until Materials.",
                         channel.title, r.shot.frame_name));
    case Lack::Light:
      refuse(r.light.reading ? "reading the light"
                             : "No light chosen. Choose or open a panorama under Display.");
    case Lack::Attribute:
      refuse(fmt::format("{} is not in the Gaussians of frame {}.", channel.title, r.shot.frame_name));
  }
}

Picture renderedOf(const Render& r, const ChannelInfo& channel) {
  RenderScene scene;
  scene.instances = instancesOf(r.values);
  scene.environment = r.light.light;
  scene.lighting = r.light.lighting;
  scene.lighting.environment.rotation_deg = glm::degrees(static_cast<double>(r.light.yaw_rad));
  if (scene.instances.empty()) {
    refuse(fmt::format("frame {} is not solved: there is nothing to render. Press Run to compute it.",
                       r.shot.frame_name));
  }
  refuseWhatIsNotThere(r, channel, lackOf(channel, scene));
  // A figure of a difference says nothing unless the light is that of the photograph.
  const std::string light = channel.needs == ChannelNeeds::MaterialsAndLight
                                ? " · " + lightWords(r.light.name, r.light.yaw_rad).toStdString()
                                : std::string();
  const auto renderer = r.new_renderer();
  renderer->load(scene);
  Picture picture;
  Progress progress;
  const ChannelInfo asked[] = {channel, channelOf(kAlphaChannel)};
  renderer->draw(r.shot.capture->views[r.shot.view.value].camera, asked, progress,
                 [&](const RenderedPicture& drawn) {
                   picture = pictureOf(channel, *drawn.channels[0].values, *drawn.channels[1].values,
                                       fmt::format("Rendered {}{} · {}", channel.title, light, r.shot.where));
                 });
  return picture;
}

void addRenders(std::vector<PictureSource>& sources, const Shot& shot, const ProjectModel& model,
                const PictureLight& light) {
  const FrameValues& values = model.values();
  const Render render{shot, values, light, model.services().new_renderer};
  for (const ChannelInfo& channel : shownChannels()) {
    PictureIngredients made_of{
        .values = {shot.capture, values.cloud, values.materials}, .view = shot.view, .frame = shot.frame};
    if (channel.needs == ChannelNeeds::MaterialsAndLight) {
      made_of.values.push_back(light.light);
      made_of.yaw_rad = light.yaw_rad;
      made_of.lighting = light.lighting;
      made_of.reading = light.reading;
    }
    sources.push_back({QString::fromStdString("render." + channel.id),
                       QString("Rendered: ") + QString::fromStdString(channel.title), made_of,
                       [render, channel] { return renderedOf(render, channel); }, true});
  }
}

struct Map {
  const char *file, *title;
  bool color;
};
constexpr Map kMaps[] = {{"ao", "Ambient occlusion", false},
                         {"base_color", "Base colour", true},
                         {"ao_weight", "Weight of ambient occlusion", false},
                         {"base_color_weight", "Weight of base colour", false}};

Picture bakedOf(const Shot& shot, const Map& map, const Project& project) {
  if (shot.capture->views[shot.view.value].split != Split::Train)
    refuse(fmt::format("camera {} is held out for tests: no maps are baked for it", shot.camera));
  const auto folder = project.result(kBakeStep, shot.frame);
  if (!folder) refuse("The maps are not baked with these settings. Run until Materials.");
  const auto file = *folder / kMapsFolder / fmt::format("{}.{}.exr", shot.camera, map.file);
  if (!std::filesystem::exists(file)) {
    refuse(fmt::format("camera {} has no maps of frame {}: it was left out of the fit", shot.camera,
                       shot.frame_name));
  }
  Picture p;
  p.label = fmt::format("Baked {} · {}", map.title, shot.where);
  p.values =
      readExr(file, map.color ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"});
  p.encoding = map.color ? Encoding::Linear : Encoding::Data;
  p.false_color = std::string_view(map.file).ends_with("weight");
  if (p.false_color) p.unit = std::string("weight");
  return p;
}

void addMaps(std::vector<PictureSource>& sources, const Shot& shot, const ProjectModel& model) {
  // The survey is new whenever something was computed.
  const PictureIngredients made_of{
      .values = {shot.capture, model.survey()}, .view = shot.view, .frame = shot.frame};
  for (const Map& map : kMaps) {
    sources.push_back({QString("map.") + map.file, QString("Baked map: ") + map.title, made_of,
                       [shot, map, project = model.project()] { return bakedOf(shot, map, project); }});
  }
}

}  // namespace

std::vector<PictureSource> pictureSources(const ProjectModel& model, ViewIndex view,
                                          const PictureLight& light) {
  std::vector<PictureSource> sources;
  const std::shared_ptr<const CaptureSet> capture = model.capture();
  if (!capture) return sources;
  const std::string &camera = capture->views[view.value].name, frame = model.frameName().toStdString();
  const Shot shot{capture, view,  model.frame(),
                  camera,  frame, fmt::format("camera {} · frame {}", camera, frame)};
  addPhotograph(sources, shot);
  addRenders(sources, shot, model, light);
  addMaps(sources, shot, model);
  return sources;
}

}  // namespace beam
