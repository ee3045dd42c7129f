// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/path_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/base/word_list.h"
#include "core/io/capture_description.h"
#include "core/io/capture_reader.h"
#include "core/io/image_file.h"
#include "core/io/ply_file.h"
#include "core/pipeline/project.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

bool isPly(const fs::path& path) { return lowerCase(path.extension().string()) == ".ply"; }

bool holdsSplats(const std::vector<PlyElement>& elements) {
  const PlyElement* vertex = findElement(elements, "vertex");
  if (!vertex) return false;
  const auto isOfSplats = [](const PlyProperty& p) {
    return p.name == "scale_0" || p.name == "rot_0" || p.name == "f_dc_0" || p.name == "opacity";
  };
  return std::any_of(vertex->properties.begin(), vertex->properties.end(), isOfSplats);
}

std::string plyInWords(const fs::path& path) {
  try {
    const std::vector<PlyElement> elements = readPlyHeader(path);
    if (holdsSplats(elements)) return fmt::format("is a splat file: see beam check \"{}\"", path.string());
    const PlyElement *vertex = findElement(elements, "vertex"), *face = findElement(elements, "face");
    if (!vertex) return "is a PLY file of neither splats nor points";
    if (face && face->count > 0) {
      return fmt::format("is a mesh ({}, {}), no splats: a viewer of meshes shows it",
                         countText(vertex->count, "vertex", "vertices"), countText(face->count, "triangle"));
    }
    return fmt::format("is a point cloud ({}), no splats: their columns, such as scale_0, are missing",
                       countText(vertex->count, "point"));
  } catch (const Error&) {
    return "is called a PLY file and has no header of one";
  }
}

struct FileKind {
  std::vector<std::string_view> endings;
  const char* words;
};

// Of files that are not looked into.
const std::vector<FileKind>& fileKinds() {
  static const std::vector<FileKind> all = {
      {videoEndings(), "is a video: expected a folder of photographs, take them out of it first"},
      {{".png", ".jpg", ".jpeg"},
       "is a PNG or JPEG picture: a photograph is looked at with the folder of its capture, and a panorama "
       "of the light must be .exr or .hdr, which hold how bright lamps are"},
      {unreadPictureEndings(),
       "is a picture of a kind that is not read: photographs are PNG or JPEG, panoramas .exr or .hdr"},
      {{".spz", ".sog", ".splat", ".ksplat", ".spx"},
       "is a file of splats of a kind that is not read: turn it into .ply first"},
      {{".obj", ".glb", ".gltf", ".fbx", ".stl", ".usd", ".usda", ".usdc", ".usdz", ".abc"},
       "is a mesh or a scene of another program, which is not read"},
      {{".json"}, "is a description: name the folder that it lies in"},
      {{".zip", ".tar", ".gz", ".tgz", ".7z"}, "is an archive: unpack it first"}};
  return all;
}

std::string fileInWords(const fs::path& path) {
  if (isRadianceName(path))
    return fmt::format("is a picture, a panorama perhaps: see beam check \"{}\"", path.string());
  if (isPly(path)) return plyInWords(path);
  const std::string extension = lowerCase(path.extension().string());
  for (const FileKind& kind : fileKinds())
    if (std::find(kind.endings.begin(), kind.endings.end(), extension) != kind.endings.end())
      return kind.words;
  return "is a file";
}

bool isSplatPly(const fs::path& path) {
  try {
    return isPly(path) && holdsSplats(readPlyHeader(path));
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

std::string kindInWords(const fs::path& path) {
  std::error_code failed;
  if (!fs::exists(path, failed)) return "is not there";
  if (Project::isProject(path)) return fmt::format("is a project: see beam status \"{}\"", path.string());
  if (isCapture(path)) {
    return fmt::format("is a capture: make a project of it with beam process \"{}\" --out Name.beam",
                       path.string());
  }
  if (const std::string half = halfColmapModel(path); !half.empty()) return half;
  if (!fs::is_directory(path, failed) && !fs::is_regular_file(path, failed))
    return "is no regular file but a pipe or a device";
  return fs::is_directory(path, failed)
             ? "is a folder with neither a project nor a capture in it: see beam help captures"
             : fileInWords(path);
}

void requireCheckable(const fs::path& path) {
  std::error_code failed;
  if (fs::is_directory(path, failed) && !Project::isProject(path)) return;
  if (fs::is_regular_file(path, failed) && (isRadianceName(path) || isSplatPly(path))) return;
  throw Error(Error::Kind::Data, fmt::format("beam check looks at a capture, a panorama or splats; \"{}\" {}",
                                             path.string(), kindInWords(path)));
}

void requireCaptureFolder(const fs::path& path) {
  std::error_code failed;
  if (fs::is_directory(path, failed) && !Project::isProject(path)) return;
  throw Error(Error::Kind::Data,
              fmt::format("expected the folder of a capture; \"{}\" {}", path.string(), kindInWords(path)));
}

}  // namespace beam
