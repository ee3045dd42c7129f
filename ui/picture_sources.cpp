// SPDX-License-Identifier: Apache-2.0
#include "ui/picture_sources.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/base/error.h"
#include "core/io/image_file.h"
#include "core/render/deferred.h"

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
  std::string camera, where;  // name; "camera C03 · frame 000002"
};

void addPhotograph(std::vector<PictureSource>& sources, const Shot& shot) {
  const auto& source = shot.capture->source;
  if (!source || !source->has(shot.view, shot.frame)) return;
  sources.push_back({"photo", "Photograph", [shot] {
                       return pictureOf(shot.capture->source->photo(shot.view, shot.frame),
                                        fmt::format("Photograph · {}", shot.where));
                     }});
  if (shot.capture->masks == MaskKind::None) return;
  sources.push_back({"mask", "Mask", [shot] {
                       const Image<std::uint8_t> mask = shot.capture->source->mask(shot.view, shot.frame);
                       if (mask.empty()) {
                         throw Error(Error::Kind::Data,
                                     fmt::format("{} has no mask in the capture", shot.where));
                       }
                       return pictureOf(mask, fmt::format("Mask · {}", shot.where));
                     }});
}

void addRenders(std::vector<PictureSource>& sources, const Shot& shot, const ProjectModel& model,
                const PictureLight& light) {
  const FrameValues& values = model.values();
  if (!values.cloud) return;
  for (int c = 0; c < kChannelCount; ++c) {
    const auto channel = static_cast<Channel>(c);
    const bool of_materials = channel == Channel::Lit || channel == Channel::BaseColor ||
                              channel == Channel::AmbientOcclusion || channel == Channel::Roughness;
    if (of_materials && !values.materials) continue;
    if (channel == Channel::Lit && !light.light) continue;
    const ChannelInfo& info = infoOf(channel);
    sources.push_back({QString("render.") + info.name, QString("Rendered: ") + info.title,
                       [shot, values, channel, light, device = model.services().view_device] {
                         GBufferRenderer renderer(*device);
                         const Camera& camera = shot.capture->views[shot.view.value].camera;
                         const GBuffer g = renderer.render(*values.cloud, values.materials.get(), camera);
                         Image<vec3> lit;
                         if (channel == Channel::Lit)
                           lit = shade(g, camera, *light.light, {.yaw_rad = light.yaw_rad});
                         return channelOf(g, lit, channel,
                                          fmt::format("Rendered {} · {}", infoOf(channel).title, shot.where));
                       }});
  }
}

void addMaps(std::vector<PictureSource>& sources, const Shot& shot, const ProjectModel& model) {
  if (shot.capture->views[shot.view.value].split != Split::Train) return;
  bool baked = false;
  for (const StageStatus& stage : model.stages())
    baked = baked || (stage.id == "materials" && stage.state == StepState::Done);
  if (!baked && !model.values().materials) return;
  struct Map {
    const char *file, *title;
    bool color;
  };
  for (const Map& map : {Map{"ao", "Ambient occlusion", false}, Map{"base_color", "Base colour", true},
                         Map{"ao_weight", "Weight of ambient occlusion", false},
                         Map{"base_color_weight", "Weight of base colour", false}}) {
    sources.push_back({QString("map.") + map.file, QString("Baked map: ") + map.title,
                       [shot, map, project = model.project()] {
                         const auto folder = project.result("materials.bake", shot.frame);
                         if (!folder)
                           throw Error(Error::Kind::Data,
                                       "The maps are not baked with these settings. Run until Materials.");
                         const auto file =
                             *folder / kMapsFolder / fmt::format("{}.{}.exr", shot.camera, map.file);
                         if (!std::filesystem::exists(file))
                           throw Error(Error::Kind::Data,
                                       "This camera has no maps of this frame: it was left out of the fit.");
                         Picture p;
                         p.label = fmt::format("Baked {} · {}", map.title, shot.where);
                         p.values = readExr(file, map.color ? std::vector<std::string>{"R", "G", "B"}
                                                            : std::vector<std::string>{"Y"});
                         p.encoding = map.color ? Encoding::Linear : Encoding::Data;
                         p.false_color = std::string_view(map.file).ends_with("weight");
                         if (p.false_color) p.unit = std::string("weight");
                         return p;
                       }});
  }
}

}  // namespace

std::vector<PictureSource> pictureSources(const ProjectModel& model, ViewIndex view,
                                          const PictureLight& light) {
  std::vector<PictureSource> sources;
  const std::shared_ptr<const CaptureSet> capture = model.capture();
  if (!capture) return sources;
  const std::string& camera = capture->views[view.value].name;
  const Shot shot{capture, view, model.frame(), camera,
                  fmt::format("camera {} · frame {}", camera, capture->frames[model.frame().value])};
  addPhotograph(sources, shot);
  addRenders(sources, shot, model, light);
  addMaps(sources, shot, model);
  return sources;
}

}  // namespace beam
