// SPDX-License-Identifier: Apache-2.0
#include "core/io/capture_pictures.h"

#include <fmt/format.h>

#include <optional>

#include "core/base/error.h"
#include "core/io/image_file.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

// A constant black or white border makes a key: a picture of something in front of nothing.
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

Image<std::uint8_t> keyMask(const fs::path& picture) {
  const Image<u8vec3> p = readPhoto(picture);
  const std::optional<u8vec3> key = keyOf(p);
  if (!key) return {};
  Image<std::uint8_t> m(p.width, p.height);
  for (std::size_t i = 0; i < p.pixels.size(); ++i) m.pixels[i] = p.pixels[i] == *key ? 0 : 255;
  return m;
}

class FileFrames final : public FrameSource {
 public:
  FileFrames(PictureTable files, std::vector<View> views, MaskKind kind)
      : files_(std::move(files)), views_(std::move(views)), kind_(kind) {}

  bool has(ViewIndex view, FrameIndex frame) const override { return !at(view, frame).picture.empty(); }

  Image<u8vec3> photo(ViewIndex view, FrameIndex frame) const override {
    const PictureFiles& f = at(view, frame);
    Image<u8vec3> p = readPhoto(f.picture);
    requireCalibratedSize(views_[view.value], f.picture, {p.width, p.height}, "picture");
    return p;
  }

  Image<std::uint8_t> mask(ViewIndex view, FrameIndex frame) const override {
    const PictureFiles& f = at(view, frame);
    Image<std::uint8_t> m;
    if (kind_ == MaskKind::Files && !f.mask.empty()) m = readMask(f.mask);
    if (kind_ == MaskKind::Alpha) m = readAlpha(f.picture);
    if (kind_ == MaskKind::Key) m = keyMask(f.picture);
    if (!m.empty()) {
      requireCalibratedSize(views_[view.value], kind_ == MaskKind::Files ? f.mask : f.picture,
                            {m.width, m.height}, "mask");
    }
    return m;
  }

  std::vector<std::string> files(ViewIndex view, FrameIndex frame) const override {
    const PictureFiles& f = at(view, frame);
    if (f.mask.empty()) return {f.picture.string()};
    return {f.picture.string(), f.mask.string()};
  }

 private:
  const PictureFiles& at(ViewIndex view, FrameIndex frame) const { return files_[view.value][frame.value]; }

  PictureTable files_;
  std::vector<View> views_;
  MaskKind kind_;
};

}  // namespace

fs::path findMask(const fs::path& root, const fs::path& picture, const std::string& camera) {
  const std::string file = picture.filename().string(), stem = picture.stem().string();
  for (const char* folder : {"masks", "mask", "mattes", "alpha"}) {
    if (!fs::is_directory(root / folder)) continue;
    const bool by_camera = fs::is_directory(root / folder / camera);
    const fs::path place = by_camera ? root / folder / camera : root / folder;
    for (const std::string& name : {file + ".png", stem + ".png", stem + ".jpg"}) {
      if (fs::exists(place / name)) return place / name;
    }
    if (fs::exists(root / folder / (camera + ".png"))) return root / folder / (camera + ".png");
  }
  for (const std::string& name : {stem + "_alpha.png", stem + "_mask.png"}) {
    if (fs::exists(picture.parent_path() / name)) return picture.parent_path() / name;
  }
  return {};
}

MaskKind maskKindOf(const PictureTable& files) {
  for (const auto& view : files) {
    for (const PictureFiles& f : view) {
      if (!f.mask.empty()) return MaskKind::Files;
    }
  }
  for (const auto& view : files) {
    for (const PictureFiles& f : view) {
      if (f.picture.empty()) continue;
      try {
        if (checkImageFile(f.picture).has_alpha) return MaskKind::Alpha;
        return keyOf(readPhoto(f.picture)) ? MaskKind::Key : MaskKind::None;
      } catch (const Error& e) {
        requireData(e);
        continue;  // a damaged picture is named when its frame is loaded
      }
    }
  }
  return MaskKind::None;
}

void requireCalibratedSize(const View& view, const fs::path& file, ivec2 found, const char* what) {
  const Camera& c = view.camera;
  if (found == ivec2(c.width, c.height)) return;
  throw Error(
      Error::Kind::Data,
      fmt::format("\"{}\": camera {} is calibrated for {} x {} pixels, the {} has {} x {}; use the size "
                  "the calibration was made for",
                  file.string(), view.name, c.width, c.height, what, found.x, found.y));
}

std::shared_ptr<const FrameSource> makeFileFrames(PictureTable files, std::vector<View> views,
                                                  MaskKind kind) {
  return std::make_shared<FileFrames>(std::move(files), std::move(views), kind);
}

std::set<fs::path> pictureFolders(const CaptureSet& capture, bool masks_too) {
  std::set<fs::path> folders;
  for (std::size_t v = 0; v < capture.views.size(); ++v) {
    for (std::size_t f = 0; f < capture.frames.size(); ++f) {
      const ViewIndex view{static_cast<std::int32_t>(v)};
      const FrameIndex frame{static_cast<std::int32_t>(f)};
      if (!capture.source->has(view, frame)) continue;
      for (const std::string& file : capture.source->files(view, frame)) {
        folders.insert(fs::path(file).parent_path());
        if (!masks_too) break;  // the picture comes first
      }
    }
  }
  return folders;
}

}  // namespace beam
