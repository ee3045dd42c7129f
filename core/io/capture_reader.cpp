// SPDX-License-Identifier: Apache-2.0
#include "core/io/capture_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/capture_description.h"
#include "core/io/image_file.h"
#include "core/io/mesh_ply.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

// Where the mask of a picture lies (ecosystem 1.7, 1 to 4); empty: nowhere.
fs::path findMask(const fs::path& root, const fs::path& picture, const std::string& camera) {
  const std::string file = picture.filename().string(), stem = picture.stem().string();
  for (const char* folder : {"masks", "mask", "mattes", "alpha"}) {
    for (const fs::path& place : {root / folder / camera, root / folder}) {
      if (!fs::is_directory(place)) continue;
      for (const std::string& name : {file + ".png", stem + ".png", stem + ".jpg", camera + ".png"}) {
        const bool whole_camera = name == camera + ".png";
        if (whole_camera && place != root / folder) continue;
        if (!whole_camera && place == root / folder && fs::is_directory(root / folder / camera)) continue;
        if (fs::exists(place / name)) return place / name;
      }
    }
  }
  for (const std::string& name : {stem + "_alpha.png", stem + "_mask.png"}) {
    if (fs::exists(picture.parent_path() / name)) return picture.parent_path() / name;
  }
  return {};
}

// A constant black or white border makes a key (contract: import).
std::optional<u8vec3> keyOf(const Image<u8vec3>& photo) {
  const u8vec3 first = photo(0, 0);
  if (first != u8vec3(0) && first != u8vec3(255)) return std::nullopt;
  for (int x = 0; x < photo.width; ++x) {
    if (photo(x, 0) != first || photo(x, photo.height - 1) != first) return std::nullopt;
  }
  for (int y = 0; y < photo.height; ++y) {
    if (photo(0, y) != first || photo(photo.width - 1, y) != first) return std::nullopt;
  }
  return first;
}

enum class MaskKind { None, Files, Alpha, Key };

struct PictureFiles {
  fs::path picture, mask;
};

class FileFrames final : public FrameSource {
 public:
  FileFrames(std::vector<std::vector<PictureFiles>> files, std::vector<std::string> names,
             std::vector<Camera> cameras, MaskKind kind)
      : files_(std::move(files)), names_(std::move(names)), cameras_(std::move(cameras)), kind_(kind) {}

  bool has(ViewIndex view, FrameIndex frame) const override { return !at(view, frame).picture.empty(); }

  Image<u8vec3> photo(ViewIndex view, FrameIndex frame) const override {
    Image<u8vec3> p = readPhoto(at(view, frame).picture);
    checkSize(view, at(view, frame).picture, p.width, p.height, "picture");
    return p;
  }

  Image<std::uint8_t> mask(ViewIndex view, FrameIndex frame) const override {
    const PictureFiles& f = at(view, frame);
    Image<std::uint8_t> m;
    if (kind_ == MaskKind::Files && !f.mask.empty()) m = readMask(f.mask);
    if (kind_ == MaskKind::Alpha) m = readAlpha(f.picture);
    if (kind_ == MaskKind::Key) m = keyMask(f.picture);
    if (!m.empty()) checkSize(view, kind_ == MaskKind::Files ? f.mask : f.picture, m.width, m.height, "mask");
    return m;
  }

  std::vector<std::string> files(ViewIndex view, FrameIndex frame) const override {
    const PictureFiles& f = at(view, frame);
    if (f.mask.empty()) return {f.picture.string()};
    return {f.picture.string(), f.mask.string()};
  }

 private:
  const PictureFiles& at(ViewIndex view, FrameIndex frame) const { return files_[view.value][frame.value]; }

  static Image<std::uint8_t> keyMask(const fs::path& picture) {
    const Image<u8vec3> p = readPhoto(picture);
    const std::optional<u8vec3> key = keyOf(p);
    if (!key) return {};
    Image<std::uint8_t> m(p.width, p.height);
    for (std::size_t i = 0; i < p.pixels.size(); ++i) m.pixels[i] = p.pixels[i] == *key ? 0 : 255;
    return m;
  }

  void checkSize(ViewIndex view, const fs::path& file, int w, int h, const char* what) const {
    const Camera& c = cameras_[view.value];
    if (w == c.width && h == c.height) return;
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": camera {} is calibrated for {} x {} pixels, the {} has {} x {}; "
                            "use the size the calibration was made for",
                            file.string(), names_[view.value], c.width, c.height, what, w, h));
  }

  std::vector<std::vector<PictureFiles>> files_;
  std::vector<std::string> names_;
  std::vector<Camera> cameras_;
  MaskKind kind_;
};

CaptureDescription describedBy(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": expected a capture folder, found none", folder.string()));
  }
  if (auto d = readDatasetJson(folder)) return *d;
  if (auto d = readTransformsJson(folder)) return *d;
  if (auto d = readColmapModel(folder)) return *d;
  throw Error(Error::Kind::Data,
              fmt::format("\"{}\" is no capture: expected dataset.json, transforms.json or a COLMAP "
                          "model in sparse/0, found none of them",
                          folder.string()));
}

// The mean up direction of the cameras, when it lies within 15 degrees of an axis that is known.
std::optional<UpAxis> upFromCameras(const CaptureDescription& d) {
  dvec3 up(0);
  for (const DescribedCamera& c : d.cameras) {
    up += glm::conjugate(c.camera.camera_from_world.rotation) * dvec3(0, -1, 0);
  }
  if (glm::length(up) < 1e-9) return std::nullopt;
  up = glm::normalize(up);
  const double near = std::cos(glm::radians(15.0));
  if (up.y > near) return UpAxis::PlusY;
  if (up.z > near) return UpAxis::PlusZ;
  if (up.y < -near) return UpAxis::MinusY;
  return std::nullopt;
}

void holdOut(CaptureDescription& d, const std::vector<std::string>& wanted) {
  for (const std::string& w : wanted) {
    const bool number = !w.empty() && w.find_first_not_of("0123456789") == std::string::npos;
    const bool camera =
        std::any_of(d.cameras.begin(), d.cameras.end(), [&](const auto& c) { return c.name == w; });
    if (number && !camera) {
      const std::size_t every = std::stoul(w.substr(0, 9));
      if (every < 2)
        throw Error(Error::Kind::Usage,
                    fmt::format("--hold-out {}: expected camera names or a number of at least 2", w));
      for (std::size_t i = 0; i < d.cameras.size(); i += every) d.cameras[i].split = Split::Test;
    } else if (camera) {
      for (DescribedCamera& c : d.cameras) {
        if (c.name == w) c.split = Split::Test;
      }
    } else {
      throw Error(Error::Kind::Usage,
                  fmt::format("--hold-out {}: the capture has no camera of that name", w));
    }
  }
}

// Drops training cameras without any picture, with a warning; test cameras may have none.
void dropEmptyCameras(CaptureDescription& d, const fs::path& folder) {
  std::vector<DescribedCamera> kept;
  for (DescribedCamera& c : d.cameras) {
    std::erase_if(c.pictures, [](const auto& p) { return !fs::exists(p.second); });
    if (c.pictures.empty() && c.split == Split::Train) {
      d.warnings.push_back(
          fmt::format("\"{}\": camera {}: expected pictures in \"{}\", found none; the camera is left out",
                      folder.string(), c.name, (folder / "images" / c.name).string()));
    } else {
      kept.push_back(std::move(c));
    }
  }
  d.cameras = std::move(kept);
  const auto train = std::count_if(d.cameras.begin(), d.cameras.end(),
                                   [](const auto& c) { return c.split == Split::Train; });
  if (train < 2) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": expected pictures of at least 2 training cameras, found {}",
                            folder.string(), train));
  }
}

MaskKind maskKindOf(const CaptureDescription& d, std::vector<std::vector<PictureFiles>>& files) {
  for (const auto& camera : files) {
    for (const PictureFiles& f : camera) {
      if (!f.mask.empty()) return MaskKind::Files;
    }
  }
  for (const auto& camera : files) {
    for (const PictureFiles& f : camera) {
      if (f.picture.empty()) continue;
      try {
        if (readImageSize(f.picture).has_alpha) return MaskKind::Alpha;
        return keyOf(readPhoto(f.picture)) ? MaskKind::Key : MaskKind::None;
      } catch (const Error&) {
        continue;  // a damaged picture is named when its frame is loaded
      }
    }
  }
  (void)d;
  return MaskKind::None;
}

PointCloud pointsOf(const CaptureDescription& d, const fs::path& folder, std::vector<std::string>& warnings) {
  for (const fs::path& file : {folder / "points3D.ply", folder / "sparse/0/points3D.ply"}) {
    if (!fs::exists(file)) continue;
    try {
      return readPointsPly(file);
    } catch (const Error& e) {
      warnings.push_back(fmt::format("{}; the seed points are left out", e.what()));
    }
  }
  return d.points;
}

}  // namespace

bool isPicture(const fs::path& file) {
  std::string e = file.extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return std::tolower(c); });
  return e == ".png" || e == ".jpg" || e == ".jpeg";
}

std::map<std::string, fs::path> picturesIn(const fs::path& folder) {
  std::map<std::string, fs::path> found;
  if (!fs::is_directory(folder)) return found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && isPicture(entry.path()))
      found[entry.path().stem().string()] = entry.path();
  }
  return found;
}

dquat rotationFromMatrix(const dmat3& m, const std::string& where) {
  const dmat3 square = glm::transpose(m) * m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (std::abs(square[i][j] - (i == j)) < 1e-3) continue;
      throw Error(Error::Kind::Data, fmt::format("{}: expected an orthonormal rotation matrix", where));
    }
  }
  if (glm::determinant(m) < 0) {
    throw Error(Error::Kind::Data,
                fmt::format("{}: the rotation matrix is a mirror (determinant -1)", where));
  }
  return glm::normalize(glm::quat_cast(m));
}

ImportedCapture openCapture(const fs::path& folder, const ImportOptions& options) {
  CaptureDescription d = describedBy(folder);
  holdOut(d, options.hold_out);
  for (const DescribedCamera& c : d.cameras) validate(c.camera, c.name);
  dropEmptyCameras(d, folder);
  const std::optional<UpAxis> up = options.up ? options.up : d.up ? d.up : upFromCameras(d);
  if (!up) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": the up axis is not known (the cameras' mean up vector is not near "
                            "+Y, +Z or -Y); say it with --up",
                            folder.string()));
  }
  ImportedCapture out;
  CaptureSet& set = out.set;
  out.layout = d.layout;
  set.name = d.name;
  set.frames_per_second = d.frames_per_second;
  set.up = *up;
  const dmat3 world_from_capture = worldFromCapture(*up);
  const dquat capture_from_world = glm::conjugate(glm::normalize(glm::quat_cast(world_from_capture)));
  std::set<std::string> frames;
  for (const DescribedCamera& c : d.cameras) {
    for (const auto& [frame, file] : c.pictures) frames.insert(frame);
  }
  set.frames.assign(frames.begin(), frames.end());
  std::vector<std::vector<PictureFiles>> files;
  std::vector<std::string> names;
  std::vector<Camera> cameras;
  for (const DescribedCamera& c : d.cameras) {
    Camera camera = c.camera;
    camera.camera_from_world.rotation =
        glm::normalize(c.camera.camera_from_world.rotation * capture_from_world);
    set.views.push_back({c.name, camera, c.split});
    names.push_back(c.name);
    cameras.push_back(camera);
    std::vector<PictureFiles> row(set.frames.size());
    for (std::size_t f = 0; f < set.frames.size(); ++f) {
      const auto picture = c.pictures.find(set.frames[f]);
      if (picture == c.pictures.end()) {
        if (c.split == Split::Train) {
          d.warnings.push_back(
              fmt::format("\"{}\": camera {} has no picture of frame {}; the frame is solved without it",
                          folder.string(), c.name, set.frames[f]));
        }
        continue;
      }
      const auto mask = c.masks.find(set.frames[f]);
      row[f] = {picture->second, mask != c.masks.end() && fs::exists(mask->second)
                                     ? mask->second
                                     : findMask(folder, picture->second, c.name)};
    }
    files.push_back(std::move(row));
  }
  const MaskKind kind = maskKindOf(d, files);
  set.has_masks = kind != MaskKind::None;
  set.seed_points = pointsOf(d, folder, d.warnings);
  for (vec3& p : set.seed_points.position_m) p = vec3(world_from_capture * dvec3(p));
  for (const char* name : {"environment.exr", "environment.hdr"}) {
    if (!set.environment_file && fs::exists(folder / name)) set.environment_file = (folder / name).string();
  }
  set.source = std::make_shared<FileFrames>(std::move(files), std::move(names), std::move(cameras), kind);
  for (const std::string& w : d.warnings) logWarning("{}", w);
  out.warnings = std::move(d.warnings);
  return out;
}

}  // namespace beam
