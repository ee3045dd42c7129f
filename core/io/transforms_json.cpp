// SPDX-License-Identifier: Apache-2.0
// transforms.json in the keys of NeRF, instant-ngp and nerfstudio: world_from_camera, OpenGL camera.
#include <algorithm>
#include <cmath>
#include <set>

#include "core/io/capture_description.h"
#include "core/io/image_file.h"
#include "core/io/json_reader.h"

namespace beam {
namespace {

struct Entry {
  std::string camera, frame;
  std::filesystem::path picture, mask;
  nlohmann::json json;
};

// A path of the document; exporters on Windows write back-slashes.
std::filesystem::path namedFile(const std::filesystem::path& folder, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return (folder / name).lexically_normal();
}

std::filesystem::path pictureFile(const std::filesystem::path& folder, const std::string& file_path) {
  std::filesystem::path p = namedFile(folder, file_path);
  if (!p.has_extension() || !isPicture(p)) {
    for (const char* e : {".png", ".jpg", ".jpeg"}) {
      if (std::filesystem::exists(p.string() + e)) return p.string() + e;
    }
  }
  return p;
}

// Camera and frame of an entry: our own keys, else folder/stem when several entries share the folder, else
// the stem.
std::vector<Entry> entriesOf(const nlohmann::json& j, const std::filesystem::path& folder) {
  std::vector<Entry> entries;
  std::set<std::string> folders, stems;
  for (const nlohmann::json& f : j["frames"]) {
    Entry e;
    const std::string path = f.value("file_path", "");
    if (path.empty()) throw Error(Error::Kind::Data, "transforms.json: a frame has no \"file_path\"");
    e.picture = pictureFile(folder, path);
    if (f.contains("mask_path")) e.mask = namedFile(folder, f["mask_path"].get<std::string>());
    e.json = f;
    folders.insert(e.picture.parent_path().string());
    stems.insert(e.picture.stem().string());
    entries.push_back(std::move(e));
  }
  const bool camera_folders = folders.size() > 1 && stems.size() * folders.size() <= entries.size() * 2;
  for (Entry& e : entries) {
    const std::string stem = e.picture.stem().string();
    e.camera = camera_folders ? e.picture.parent_path().filename().string() : stem;
    e.frame = camera_folders ? stem : "000000";
    if (e.json.contains("camera") && e.json["camera"].is_string()) {
      e.camera = e.json["camera"].get<std::string>();
      e.frame = stem;
    }
  }
  return entries;
}

double numberFrom(const nlohmann::json& top, const nlohmann::json& frame, const char* key, double otherwise,
                  const std::string& where) {
  if (top.contains(key)) return finiteNumber(top, key, where);
  if (frame.contains(key)) return finiteNumber(frame, key, where);
  return otherwise;
}

void requirePinhole(const nlohmann::json& top, const Entry& e, const std::string& where) {
  for (const char* k : {"k1", "k2", "k3", "k4", "p1", "p2"}) {
    if (numberFrom(top, e.json, k, 0, where) == 0) continue;
    throw Error(
        Error::Kind::Data,
        fmt::format("{}: lens distortion ({}) is not supported yet; undistort the pictures first", where, k));
  }
}

// World_from_camera of an OpenGL camera, as camera_from_world of ours.
Rigid3 poseOf(const Entry& e, const std::string& where) {
  const nlohmann::json m = e.json.value("transform_matrix", nlohmann::json());
  dmat3 world_from_camera;
  dvec3 center;
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 4; ++k) {
      const bool ok = m.is_array() && m.size() >= 3 && m[r].is_array() && m[r].size() == 4 &&
                      m[r][k].is_number() && std::isfinite(m[r][k].get<double>());
      if (!ok)
        throw Error(Error::Kind::Data,
                    fmt::format("{}: expected \"transform_matrix\" as rows of 4 finite numbers", where));
      const double v = m[r][k].get<double>();
      // OpenGL to OpenCV: the camera's y and z turn round.
      if (k < 3) world_from_camera[k][r] = k == 0 ? v : -v;
      if (k == 3) center[r] = v;
    }
  }
  const dquat q = glm::conjugate(rotationFromMatrix(world_from_camera, where));
  return {q, -(q * center)};
}

Camera cameraOf(const nlohmann::json& top, const Entry& e, const std::string& where) {
  requirePinhole(top, e, where);
  Camera c;
  const auto has = [&](const char* key) { return top.contains(key) || e.json.contains(key); };
  if (has("w") && has("h")) {
    c.width = pictureSide(top.contains("w") ? top : e.json, "w", where);
    c.height = pictureSide(top.contains("h") ? top : e.json, "h", where);
  } else {
    const ImageSize s = readImageSize(e.picture);
    c.width = s.width;
    c.height = s.height;
  }
  const double angle_x = numberFrom(top, e.json, "camera_angle_x", 0, where);
  const double angle_y = numberFrom(top, e.json, "camera_angle_y", 0, where);
  const double from_x = angle_x > 0 ? 0.5 * c.width / std::tan(0.5 * angle_x) : 0;
  const double from_y = angle_y > 0 ? 0.5 * c.height / std::tan(0.5 * angle_y) : from_x;
  c.intrinsics.fx = numberFrom(top, e.json, "fl_x", from_x, where);
  c.intrinsics.fy = numberFrom(
      top, e.json, "fl_y", top.contains("fl_x") || e.json.contains("fl_x") ? c.intrinsics.fx : from_y, where);
  c.intrinsics.cx = numberFrom(top, e.json, "cx", 0.5 * c.width, where);
  c.intrinsics.cy = numberFrom(top, e.json, "cy", 0.5 * c.height, where);
  c.camera_from_world = poseOf(e, where);
  if (!(c.intrinsics.fx > 0 && c.intrinsics.fy > 0)) {
    throw Error(Error::Kind::Data,
                fmt::format("{}: expected a focal length as fl_x or camera_angle_x", where));
  }
  return c;
}

void requirePinholeModel(const nlohmann::json& j, const std::filesystem::path& file) {
  const std::string model = j.value("camera_model", "PINHOLE");
  const bool fisheye =
      j.contains("is_fisheye") && j["is_fisheye"].is_boolean() && j["is_fisheye"].get<bool>();
  if (!fisheye &&
      (model == "PINHOLE" || model == "OPENCV" || model == "SIMPLE_PINHOLE" || model == "perspective")) {
    return;
  }
  throw Error(
      Error::Kind::Data,
      fmt::format("\"{}\": camera model {} is not supported yet; undistort the pictures to a pinhole camera",
                  file.string(), fisheye ? "fisheye" : model));
}

// Pictures that nerfstudio's document keeps for testing.
std::set<std::string> testFiles(const nlohmann::json& j, const std::filesystem::path& folder) {
  std::set<std::string> files;
  if (!j.contains("test_filenames")) return files;
  for (const nlohmann::json& f : j["test_filenames"]) files.insert(pictureFile(folder, f.get<std::string>()));
  return files;
}

CaptureDescription describe(const nlohmann::json& j, const std::filesystem::path& folder,
                            const std::filesystem::path& file) {
  if (!j.is_object() || !j.contains("frames") || !j["frames"].is_array()) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\": expected an array \"frames\"", file.string()));
  }
  requirePinholeModel(j, file);
  CaptureDescription d;
  d.layout = "transforms.json";
  d.name = folder.filename().string();
  if (j.contains("ply_file_path")) d.points_file = namedFile(folder, j["ply_file_path"].get<std::string>());
  const std::set<std::string> test = testFiles(j, folder);
  std::map<std::string, std::size_t> index;
  for (const Entry& e : entriesOf(j, folder)) {
    const std::string where = fmt::format("\"{}\", camera \"{}\"", file.string(), e.camera);
    requirePlainName(e.camera, where);
    const bool sized = (j.contains("w") && j.contains("h")) || (e.json.contains("w") && e.json.contains("h"));
    if (!sized && !std::filesystem::exists(e.picture)) {
      d.warnings.push_back(fmt::format("{}: expected the picture \"{}\", found none; it is left out", where,
                                       e.picture.string()));
      continue;
    }
    const Camera camera = cameraOf(j, e, where);
    const auto [place, fresh] = index.emplace(e.camera, d.cameras.size());
    if (fresh) d.cameras.push_back({e.camera, camera, Split::Train, {}, {}});
    DescribedCamera& c = d.cameras[place->second];
    addPose(c, camera, fmt::format("\"{}\"", file.string()));
    if (!c.pictures.emplace(e.frame, e.picture).second) {
      throw Error(Error::Kind::Data, fmt::format("{}: two pictures of frame {}: \"{}\" and \"{}\"", where,
                                                 e.frame, c.pictures[e.frame].string(), e.picture.string()));
    }
    if (!e.mask.empty()) c.masks[e.frame] = e.mask;
    if (test.contains(e.picture.string())) c.split = Split::Test;
  }
  return d;
}

}  // namespace

std::optional<CaptureDescription> readTransformsJson(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "transforms.json";
  if (!std::filesystem::exists(file)) return std::nullopt;
  return withJsonErrors(file, [&] { return describe(readJson(file), folder, file); });
}

}  // namespace beam
