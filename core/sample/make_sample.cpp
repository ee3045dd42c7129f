// SPDX-License-Identifier: Apache-2.0
#include "core/sample/make_sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/rng.h"
#include "core/image/planes.h"
#include "core/io/file.h"
#include "core/io/image_file.h"
#include "core/io/mesh_ply.h"
#include "core/math/color.h"
#include "core/sample/look.h"
#include "core/sample/motion.h"
#include "core/sample/path_tracer.h"
#include "core/sample/sample_descriptions.h"
#include "core/sample/skin.h"
#include "core/sample/tracks.h"
#include "core/scene/capture.h"
#include "core/scene/transform.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

constexpr double kFramesPerSecond = 30;
constexpr float kMeshCell_m = 0.007f;
constexpr int kTruthSamples = 2;  // times the photographs' samples
constexpr std::size_t kSeedPoints = 6000;
constexpr std::size_t kTrackPoints = 20000;

Camera lookingAt(dvec3 position, dvec3 target, const SampleOptions& o) {
  const dvec3 forward = glm::normalize(target - position),
              right = glm::normalize(glm::cross(forward, dvec3(0, 0, 1)));
  const dvec3 down = glm::cross(forward, right);
  const dmat3 capture_from_camera(right, down, forward);
  Camera c;
  c.width = o.width;
  c.height = o.height;
  const double focal = 1.3 * o.height;
  c.intrinsics = {focal, focal, 0.5 * o.width, 0.5 * o.height};
  c.camera_from_world.rotation = glm::normalize(glm::quat_cast(glm::transpose(capture_from_camera)));
  c.camera_from_world.translation_m = -(c.camera_from_world.rotation * position);
  return c;
}

std::string trainingName(int camera) { return fmt::format("cam{:02}", camera); }

// Three rings; test cameras stand between them.
std::vector<SampleCamera> rig(const SampleOptions& o) {
  std::vector<SampleCamera> cameras;
  const dvec3 target(0, -0.05, 0.88);
  const auto add = [&](const std::string& name, bool test, double azimuth, double elevation) {
    const double r = 2.85, c = std::cos(elevation);
    const dvec3 position =
        target + r * dvec3(c * std::sin(azimuth), -c * std::cos(azimuth), std::sin(elevation));
    cameras.push_back({name, test, lookingAt(position, target, o)});
  };
  const double tau = 2 * 3.14159265358979;
  constexpr double kRings[3] = {glm::radians(8.0), glm::radians(38.0), glm::radians(-14.0)};
  for (int i = 0; i < o.cameras; ++i) {
    add(trainingName(i), false, tau * (i + 0.25 * (i % 3)) / o.cameras, kRings[i % 3]);
  }
  for (int i = 0; i < o.test_cameras; ++i) {
    add(fmt::format("test{:02}", i), true, tau * (i + 0.37) / std::max(1, o.test_cameras),
        kRings[i % 2] * 0.6 + 0.15);
  }
  return cameras;
}

Image<u8vec3> encoded(const Image<vec3>& linear) {
  Image<u8vec3> out(linear.width, linear.height, u8vec3(0), Encoding::Srgb);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      out.pixels[i][k] = byteOf(srgbFromLinear(glm::clamp(linear.pixels[i][k], 0.0f, 1.0f)));
    }
  }
  return out;
}

Image<std::uint8_t> coverageBytes(const Image<float>& coverage) {
  Image<std::uint8_t> out(coverage.width, coverage.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    out.pixels[i] = byteOf(coverage.pixels[i]);
  }
  return out;
}

class SampleWriter {
 public:
  SampleWriter(const fs::path& folder, const SampleOptions& options)
      : folder_(folder),
        options_(options),
        cameras_(rig(options)),
        defects_(options.defects, options.frames),
        world_from_capture_(worldFromCapture(UpAxis::PlusZ)),
        dome_(domeLight()),
        dome_sampler_(dome_) {}

  void write(Progress& progress) {
    SampleDescription description{
        options_.frames, options_.width, options_.height, kFramesPerSecond, cameras_, {}, lights(), {}};
    description.truth_frames = truthFrames();
    description.defects = defects_.names();
    const auto truths = static_cast<std::int64_t>(description.truth_frames.size() * options_.test_cameras);
    progress.expect(static_cast<std::int64_t>(options_.frames * cameras_.size()) + truths * 3);
    panorama(folder_ / "environment.exr", dome_);
    for (const std::string& l : lights()) panorama(folder_ / "gt/environments" / (l + ".exr"), namedLight(l));
    const Skin skin(moves() ? danceAt(0) : portraitPose(), kMeshCell_m);
    const TrackPoints tracks(skin.first(), kTrackPoints, options_.seed);
    SampleScene scene(skin.figure(), skin.first(), world_from_capture_);
    seedPoints(skin);
    for (int f = 0; f < options_.frames; ++f) {
      const Mesh surface = f == 0 ? skin.first() : skin.posed(danceAt(f * kDanceFrames_s / kFramesPerSecond));
      scene.pose(surface);
      if (moves()) tracks.write(in(fs::path("gt/tracks") / (frameName(f) + ".ply")), surface);
      photographs(scene, f, progress);
      if (std::count(description.truth_frames.begin(), description.truth_frames.end(), f) > 0)
        truth(scene, {surface.vertices, surface.triangles}, f, progress);
    }
    writeSampleDescriptions(folder_, description);
  }

 private:
  static std::vector<std::string> lights() { return {"studio", "sunset"}; }

  bool moves() const { return options_.frames > 1; }

  // Of long takes the first, the middle and the last frame.
  std::vector<int> truthFrames() const {
    const int n = options_.frames;
    if (n < 3) return {n / 2};
    return {0, n / 2, n - 1};
  }

  fs::path in(const fs::path& relative) const {
    fs::path p = folder_ / relative;
    fs::create_directories(p.parent_path());
    return p;
  }

  void panorama(const fs::path& path, const Environment& e) const {
    fs::create_directories(path.parent_path());
    writeExr(path, planesOf(e.radiance, dmat3(1.0)), {"R", "G", "B"}, ExrPrecision::Half);
  }

  TraceSettings settings(int frame, std::size_t camera, int purpose, int factor) const {
    TraceSettings s;
    s.samples = options_.samples * factor;
    s.seed = RandomStream(options_.seed, frame, camera, purpose).bits(0);
    return s;
  }

  void photographs(const SampleScene& scene, int frame, Progress& progress) const {
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      const SampleCamera& camera = cameras_[c];
      if (const std::vector<int> shown = defects_.shownIn(camera.name, frame); !shown.empty()) {
        const SampleScene::Picture p = scene.photograph(transformed(camera.camera, {world_from_capture_}),
                                                        dome_sampler_, settings(frame, c, 0, 1), progress);
        for (const int f : shown) keep(camera, f, p);
      }
      progress.step();
    }
  }

  void keep(const SampleCamera& camera, int frame, const SampleScene::Picture& p) const {
    const fs::path file = fs::path(camera.name) / (frameName(frame) + ".png");
    const bool blurred = defects_.has(camera.name, SampleDefect::Kind::Blurred);
    Image<u8vec3> picture = encoded(blurred ? outOfFocus(p.radiance) : p.radiance);
    if (defects_.black(camera.name, frame))
      std::fill(picture.pixels.begin(), picture.pixels.end(), u8vec3(0));
    writePng(in(fs::path(camera.test ? "gt/rgb" : "images") / file), picture);
    writePng(in(fs::path(camera.test ? "gt/mask" : "masks") / file), coverageBytes(p.coverage));
  }

  void truth(const SampleScene& scene, const Mesh& mesh, int frame, Progress& progress) const {
    const dmat3 capture_from_world = glm::transpose(world_from_capture_);
    fs::create_directories(folder_ / "gt/mesh");
    writeMeshPly(folder_ / "gt/mesh" / (frameName(frame) + ".ply"), mesh);
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      if (!cameras_[c].test) continue;
      const Camera camera = transformed(cameras_[c].camera, {world_from_capture_});
      const fs::path file = fs::path(cameras_[c].name) / (frameName(frame) + ".exr");
      const TracedMaps m = scene.maps(camera, settings(frame, c, 1, kTruthSamples), progress);
      writeExr(in(fs::path("gt/base_color") / file), planesOf(m.base_color, dmat3(1.0)), {"R", "G", "B"},
               ExrPrecision::Half);
      writeExr(in(fs::path("gt/normal") / file), planesOf(m.normal, capture_from_world), {"R", "G", "B"},
               ExrPrecision::Half);
      writeExr(in(fs::path("gt/roughness") / file), planesOf(m.roughness), {"Y"}, ExrPrecision::Half);
      writeExr(in(fs::path("gt/ao") / file), planesOf(m.ambient_occlusion), {"Y"}, ExrPrecision::Half);
      writeExr(in(fs::path("gt/depth") / file), planesOf(m.depth_m), {"Y"}, ExrPrecision::Float);
      progress.step();
      int purpose = 2;
      for (const std::string& l : lights()) {
        const EnvironmentSampler sampler(namedLight(l));
        const SampleScene::Picture p =
            scene.photograph(camera, sampler, settings(frame, c, purpose++, kTruthSamples), progress);
        writeExr(in(fs::path("gt/relight_" + l) / file), planesOf(p.radiance, dmat3(1.0)), {"R", "G", "B"},
                 ExrPrecision::Half);
        writePng(in(fs::path("gt/relight_" + l) / fs::path(file).replace_extension(".png")),
                 encoded(p.radiance));
        progress.step();
      }
    }
  }

  // Points of the surface with the colour of their material: what a feature matcher would have given, without
  // its errors.
  void seedPoints(const Skin& skin) const {
    PointCloud points;
    const Mesh& mesh = skin.first();
    const RandomStream random(options_.seed, 0x5eedu);
    for (std::size_t i = 0; i < kSeedPoints; ++i) {
      const vec3 x = mesh.vertices[random.below(i, mesh.vertices.size())];
      points.position_m.push_back(x);
      points.color.push_back(u8vec3(
          srgbFromLinear(glm::clamp(lookOf(skin.figure().pointAt(x)).base_color, 0.0f, 1.0f)) * 255.0f +
          0.5f));
    }
    writePointsPly(folder_ / "points3D.ply", points);
  }

  fs::path folder_;
  SampleOptions options_;
  std::vector<SampleCamera> cameras_;
  SampleDefects defects_;
  dmat3 world_from_capture_;
  Environment dome_;
  EnvironmentSampler dome_sampler_;
};

}  // namespace

std::string frameName(int frame) { return fmt::format("{:06}", frame); }

namespace {

void requireCameras(const SampleOptions& options) {
  for (const SampleDefect& d : options.defects) {
    bool known = false;
    for (int i = 0; i < options.cameras; ++i) known = known || d.camera == trainingName(i);
    if (known) continue;
    throw Error(Error::Kind::Usage, fmt::format("--defect {}: expected a camera from {} to {}", nameOf(d),
                                                trainingName(0), trainingName(options.cameras - 1)));
  }
}

}  // namespace

void makeSample(const fs::path& folder, const SampleOptions& options, Progress& progress) {
  requireCameras(options);
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder))) {
    throw Error(Error::Kind::Usage,
                fmt::format("\"{}\" exists and is not empty; name a new folder", folder.string()));
  }
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed)
    throw Error(Error::Kind::Storage,
                fmt::format("cannot make \"{}\": {}", folder.string(), failed.message()));
  SampleWriter(folder, options).write(progress);
}

}  // namespace beam
