// SPDX-License-Identifier: Apache-2.0
#include "core/sample/sample_descriptions.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/io/file.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void put(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  writeFileAtomically(path, text);
}

Json datasetJson(const SampleDescription& d) {
  Json j;
  j["name"] = "sample";
  j["fps"] = d.frames_per_second;
  j["frames"] = d.frames;
  j["frame_names"] = Json::array();
  for (int f = 0; f < d.frames; ++f) j["frame_names"].push_back(frameName(f));
  j["image_size"] = {d.width, d.height};
  for (const char* list : {"train_cameras", "test_cameras"}) j[list] = Json::array();
  for (const SampleCamera& c : d.cameras) j[c.test ? "test_cameras" : "train_cameras"].push_back(c.name);
  j["gt_frames"] = Json::array();
  for (const int f : d.truth_frames) j["gt_frames"].push_back(frameName(f));
  j["relight_environments"] = d.lights;
  j["world"] = {{"unit", "metre"},
                {"up", "+Z"},
                {"handedness", "right"},
                {"performer_faces", "-Y"},
                {"performer_left", "+X"}};
  j["conventions"] = {
      {"camera",
       "R, t map world to camera: x right, y down, z forward (OpenCV/COLMAP); pixel centres at +0.5; no "
       "distortion"},
      {"environment",
       "lat-long, linear, d = (cos el cos az, cos el sin az, sin el), az = pi - 2 pi u, el = pi/2 - pi v"},
      {"images", "8-bit sRGB, linear colour composited on black then encoded"},
      {"maps",
       "base_color, roughness, ao are composited on black; base_color linear; normal: world, smooth shading "
       "normal"},
      {"brdf", "Lambert x (1 - F) + GGX, F0 0.04, alpha = roughness^2, height-correlated Smith"}};
  if (!d.defects.empty()) j["defects"] = d.defects;
  if (d.frames > 1) {
    j["tracks"] = {
        {"folder", "gt/tracks"},
        {"file", "<frame>.ply, binary little-endian, float x y z nx ny nz"},
        {"content",
         "points spread evenly over the body's surface in the first frame and followed through the "
         "take: row i is the same point in every file; metres and unit normals in the capture's axes"}};
  }
  for (const SampleCamera& c : d.cameras) {
    const dmat3 r = glm::mat3_cast(c.camera.camera_from_world.rotation);
    const dvec3 t = c.camera.camera_from_world.translation_m;
    const Intrinsics& k = c.camera.intrinsics;
    j["cameras"][c.name] = {
        {"split", c.test ? "test" : "train"},
        {"width", d.width},
        {"height", d.height},
        {"fx", k.fx},
        {"fy", k.fy},
        {"cx", k.cx},
        {"cy", k.cy},
        {"R", {{r[0][0], r[1][0], r[2][0]}, {r[0][1], r[1][1], r[2][1]}, {r[0][2], r[1][2], r[2][2]}}},
        {"t", {t.x, t.y, t.z}}};
  }
  return j;
}

// world_from_camera of an OpenGL camera, rows.
Json openGlMatrix(const Camera& camera) {
  const Rigid3 pose = inverse(camera.camera_from_world);
  const dmat3 r = glm::mat3_cast(pose.rotation);
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({r[0][i], -r[1][i], -r[2][i], pose.translation_m[i]});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

Json transformsJson(const SampleDescription& d, bool test) {
  const Intrinsics& k = d.cameras.front().camera.intrinsics;
  Json j = {{"camera_model", "PINHOLE"},
            {"w", d.width},
            {"h", d.height},
            {"fl_x", k.fx},
            {"fl_y", k.fy},
            {"cx", k.cx},
            {"cy", k.cy},
            {"frames", Json::array()}};
  for (const SampleCamera& c : d.cameras) {
    if (c.test != test) continue;
    for (int f = 0; f < d.frames; ++f) {
      const std::string file = c.name + "/" + frameName(f) + ".png";
      j["frames"].push_back({{"file_path", (test ? "rgb/" : "images/") + file},
                             {"mask_path", (test ? "mask/" : "masks/") + file},
                             {"camera", c.name},
                             {"frame", f},
                             {"time", f / d.frames_per_second},
                             {"transform_matrix", openGlMatrix(c.camera)}});
    }
  }
  return j;
}

void colmapText(const fs::path& folder, const SampleDescription& d, bool test) {
  std::string cameras = "# CAMERA_ID, MODEL, WIDTH, HEIGHT, fx, fy, cx, cy\n";
  std::string images =
      "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME (= camera folder); second line: no 2D "
      "points\n";
  int id = 0;
  for (const SampleCamera& c : d.cameras) {
    if (c.test != test) continue;
    const Intrinsics& k = c.camera.intrinsics;
    const dquat& q = c.camera.camera_from_world.rotation;
    const dvec3& t = c.camera.camera_from_world.translation_m;
    ++id;
    cameras += fmt::format("{} PINHOLE {} {} {:.9f} {:.9f} {:.9f} {:.9f}\n", id, d.width, d.height, k.fx,
                           k.fy, k.cx, k.cy);
    images += fmt::format("{} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f} {} {}\n\n", id, q.w,
                          q.x, q.y, q.z, t.x, t.y, t.z, id, c.name);
  }
  put(folder / "cameras.txt", cameras);
  put(folder / "images.txt", images);
  put(folder / "points3D.txt", "# empty: see points3D.ply for a seed\n");
}

}  // namespace

void writeSampleDescriptions(const fs::path& folder, const SampleDescription& d) {
  put(folder / "transforms.json", transformsJson(d, false).dump(1) + "\n");
  put(folder / "gt/transforms_test.json", transformsJson(d, true).dump(1) + "\n");
  colmapText(folder / "sparse/0", d, false);
  colmapText(folder / "gt/sparse/0", d, true);
  put(folder / "dataset.json", datasetJson(d).dump(1) + "\n");
}

}  // namespace beam
