// SPDX-License-Identifier: Apache-2.0
#include "core/stages/render_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/image/planes.h"
#include "core/io/image_file.h"
#include "core/io/mesh_ply.h"
#include "core/math/color.h"
#include "core/render/deferred.h"
#include "core/scene/transform.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

Image<u8vec3> bytesOf(const Image<vec3>& image, bool encode) {
  Image<u8vec3> out(image.width, image.height, u8vec3(0), Encoding::Srgb);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    const vec3 c = glm::clamp(image.pixels[i], 0.0f, 1.0f);
    for (int k = 0; k < 3; ++k) out.pixels[i][k] = byteOf(encode ? srgbFromLinear(c[k]) : c[k]);
  }
  return out;
}

// A turn leaves lengths as they are.
Planes inUnit(Planes lengths_m, const Similarity3& frame_from_world) {
  if (frame_from_world.scale == 1) return lengths_m;
  for (float& v : lengths_m.values) v = static_cast<float>(frame_from_world.scale * v);
  return lengths_m;
}

bool needsMaterials(const std::string& channel) {
  return channel == "relight" || channel == "base_color" || channel == "ao" || channel == "roughness";
}

class ChannelWriter {
 public:
  ChannelWriter(const GaussianSequence& sequence, const RenderRequest& request, ComputeDevice& device)
      : sequence_(sequence), request_(request), device_(device), renderer_(device) {
    if (!request.world_frame) frame_from_world_ = sequence.captureFromWorld();
    if (!wants("relight")) return;
    for (const fs::path& file : request.environments) {
      lights_.push_back({file.stem().string(), PreparedLight(makeEnvironment(readRadiance(file)))});
    }
  }

  void frame(FrameIndex frame, Progress& progress) {
    const std::string& name = nameOf(sequence_, frame);
    if (wants("mesh")) mesh(frame, name);
    const bool pictures = std::any_of(request_.channels.begin(), request_.channels.end(),
                                      [](const auto& c) { return c != "mesh"; });
    if (!pictures) return progress.step(static_cast<std::int64_t>(request_.views.size()));
    const std::shared_ptr<const GaussianFrame> result = sequence_.load(frame);
    if (!result)
      throw Error(Error::Kind::Data, fmt::format("frame {} is not solved yet: run it first", name));
    if (result->interpolated) logInfo("frame {} is interpolated", name);
    for (const std::string& channel : request_.channels) {
      if (!needsMaterials(channel) || result->materials) continue;
      throw Error(
          Error::Kind::Data,
          fmt::format("frame {} has no materials yet, which {} needs: run Materials first", name, channel));
    }
    if (request_.views.empty()) return;
    const auto resident = residentOf(device_, *result);
    for (const View& view : request_.views) {
      picture(*resident, view, name);
      progress.step();
    }
  }

 private:
  bool wants(const std::string& channel) const {
    return std::find(request_.channels.begin(), request_.channels.end(), channel) != request_.channels.end();
  }

  fs::path file(const std::string& channel, const std::string& camera, const std::string& name) const {
    const fs::path folder = request_.out / channel / camera;
    fs::create_directories(folder);
    return folder / name;
  }

  void mesh(FrameIndex frame, const std::string& name) const {
    const std::shared_ptr<const Mesh> m = sequence_.mesh(frame);
    if (!m && sequence_.content(frame).interpolated)
      return logInfo("frame {} is interpolated: it has no mesh", name);
    if (!m) throw Error(Error::Kind::Data, fmt::format("frame {} has no mesh yet: run Surface first", name));
    fs::create_directories(request_.out / "mesh");
    writeMeshPly(request_.out / "mesh" / (name + ".ply"), transformed(*m, frame_from_world_));
  }

  void picture(const ResidentScene& scene, const View& view, const std::string& name) {
    const GBuffer g = renderer_.render(scene, view.camera);
    const std::string &camera = view.name, png = name + ".png", exr = name + ".exr";
    if (wants("rgb")) writePng(file("rgb", camera, png), bytesOf(g.radiance, false));
    if (wants("base_color")) {
      writeExr(file("base_color", camera, exr), planesOf(g.base_color, dmat3(1.0)), {"R", "G", "B"},
               ExrPrecision::Half);
    }
    if (wants("ao"))
      writeExr(file("ao", camera, exr), planesOf(g.ambient_occlusion), {"Y"}, ExrPrecision::Half);
    if (wants("roughness"))
      writeExr(file("roughness", camera, exr), planesOf(g.roughness), {"Y"}, ExrPrecision::Half);
    if (wants("normal")) {
      writeExr(file("normal", camera, exr), planesOf(g.normal_world, frame_from_world_.rotation),
               {"R", "G", "B"}, ExrPrecision::Half);
    }
    if (wants("depth")) {
      writeExr(file("depth", camera, exr), inUnit(planesOf(g.depth_m), frame_from_world_), {"Y"},
               ExrPrecision::Float);
    }
    if (wants("alpha")) {
      Image<std::uint8_t> alpha(g.alpha.width, g.alpha.height);
      for (std::size_t i = 0; i < alpha.pixels.size(); ++i) alpha.pixels[i] = byteOf(g.alpha.pixels[i]);
      writePng(file("alpha", camera, png), alpha);
    }
    for (const Light& light : lights_) {
      writePng(file("relight_" + light.name, camera, png),
               bytesOf(shade(g, view.camera, light.prepared, {}), true));
    }
  }

  struct Light {
    std::string name;
    PreparedLight prepared;
  };

  const GaussianSequence& sequence_;
  const RenderRequest& request_;
  ComputeDevice& device_;
  GBufferRenderer renderer_;
  Similarity3 frame_from_world_;
  std::vector<Light> lights_;
};

}  // namespace

const std::vector<std::string>& renderChannelNames() {
  static const std::vector<std::string> kNames = {"rgb",    "relight", "base_color", "ao",  "roughness",
                                                  "normal", "depth",   "alpha",      "mesh"};
  return kNames;
}

void renderChannels(const GaussianSequence& sequence, const RenderRequest& request, ComputeDevice& device,
                    Progress& progress) {
  for (const std::string& c : request.channels) {
    const auto& known = renderChannelNames();
    if (std::find(known.begin(), known.end(), c) == known.end()) {
      throw Error(Error::Kind::Usage,
                  fmt::format("unknown channel \"{}\": expected some of {}", c, fmt::join(known, ", ")));
    }
    if (c == "relight" && request.environments.empty()) {
      throw Error(Error::Kind::Usage, "the channel relight needs a panorama: give --environment FILE");
    }
  }
  progress.expect(static_cast<std::int64_t>(request.frames.size() * request.views.size()));
  ChannelWriter writer(sequence, request, device);
  for (const FrameIndex f : request.frames) writer.frame(f, progress);
}

}  // namespace beam
