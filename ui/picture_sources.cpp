// SPDX-License-Identifier: Apache-2.0
#include "ui/picture_sources.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/base/error.h"
#include "core/io/image_file.h"
#include "core/render/deferred.h"
#include "core/stages/result_files.h"
#include "core/stages/step_ids.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

constexpr float kVisible = 1 / 255.0f;

// value x alpha -> value, 0 where nothing is.
template <class T>
Image<T> surfaceValues(Image<T> image, const Image<float>& alpha) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = alpha.pixels[i] < kVisible ? T(0) : image.pixels[i] / alpha.pixels[i];
  }
  return image;
}

Picture channelOf(const GBuffer& g, const Image<vec3>& lit, Channel channel, std::string label) {
  switch (channel) {
    case Channel::Lit:
      return pictureOf(lit, std::move(label));
    case Channel::Radiance:
      return pictureOf(g.radiance, std::move(label));
    case Channel::BaseColor:
      return pictureOf(g.base_color, std::move(label));
    case Channel::AmbientOcclusion:
      return pictureOf(surfaceValues(g.ambient_occlusion, g.alpha), std::move(label));
    case Channel::Normal: {
      Picture p = pictureOf(g.normal_world, std::move(label));
      p.encoding = Encoding::Data;
      return p;
    }
    case Channel::Roughness: {
      Picture p = pictureOf(surfaceValues(g.roughness, g.alpha), std::move(label));
      p.false_color = true;
      return p;
    }
    case Channel::Depth: {
      Picture p = pictureOf(g.depth_m, std::move(label));
      p.false_color = true;
      p.unit = std::string("m");
      return p;
    }
  }
  return {};
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
  std::shared_ptr<ComputeDevice> device;
};

Picture renderedOf(const Render& r, Channel channel) {
  const char* title = infoOf(channel).title;
  const bool of_materials = channel == Channel::Lit || channel == Channel::BaseColor ||
                            channel == Channel::AmbientOcclusion || channel == Channel::Roughness;
  if (!r.values.cloud) {
    refuse(fmt::format("frame {} is not solved: there is nothing to render. Press Run to compute it.",
                       r.shot.frame_name));
  }
  if (of_materials && !r.values.materials) {
    refuse(fmt::format("{} needs materials, which frame {} does not have yet. Run until Materials.", title,
                       r.shot.frame_name));
  }
  if (channel == Channel::Lit && !r.light.light) {
    refuse(r.light.reading ? "reading the light"
                           : "No light chosen. Choose or open a panorama under Display.");
  }
  GBufferRenderer renderer(*r.device);
  const Camera& camera = r.shot.capture->views[r.shot.view.value].camera;
  const GBuffer g =
      renderer.render(*residentOf(*r.device, *r.values.cloud, r.values.materials.get()), camera);
  Image<vec3> lit;
  if (channel == Channel::Lit) lit = shade(g, camera, *r.light.light, {.yaw_rad = r.light.yaw_rad});
  // A figure of a difference says nothing unless the light is that of the photograph.
  const std::string light = channel == Channel::Lit
                                ? " · " + lightWords(r.light.name, r.light.yaw_rad).toStdString()
                                : std::string();
  return channelOf(g, lit, channel, fmt::format("Rendered {}{} · {}", title, light, r.shot.where));
}

void addRenders(std::vector<PictureSource>& sources, const Shot& shot, const ProjectModel& model,
                const PictureLight& light) {
  const FrameValues& values = model.values();
  const Render render{shot, values, light, model.services().view_device};
  for (int c = 0; c < kChannelCount; ++c) {
    const auto channel = static_cast<Channel>(c);
    const ChannelInfo& info = infoOf(channel);
    PictureIngredients made_of{
        .values = {shot.capture, values.cloud, values.materials}, .view = shot.view, .frame = shot.frame};
    if (channel == Channel::Lit) {
      made_of.values.push_back(light.light);
      made_of.yaw_rad = light.yaw_rad;
      made_of.reading = light.reading;
    }
    sources.push_back({QString("render.") + info.name, QString("Rendered: ") + info.title, made_of,
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
