// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/path_kind.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/word_list.h"
#include "core/io/capture_reader.h"
#include "core/pipeline/project.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

std::string fileInWords(const fs::path& path) {
  const std::string extension = lowerCase(path.extension().string());
  if (extension == ".exr" || extension == ".hdr")
    return fmt::format("is a picture, a panorama perhaps: see beam check \"{}\"", path.string());
  if (extension == ".ply") return fmt::format("is a splat file: see beam check \"{}\"", path.string());
  for (const char* video : {".mp4", ".mov", ".mkv", ".avi"})
    if (extension == video) return "is a video: expected a folder of photographs, take them out of it first";
  return "is a file";
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
  return fs::is_directory(path, failed) ? "is a folder with neither a project nor a capture in it"
                                        : fileInWords(path);
}

void requireCaptureFolder(const fs::path& path) {
  std::error_code failed;
  if (fs::is_directory(path, failed) && !Project::isProject(path)) return;
  throw Error(Error::Kind::Data,
              fmt::format("expected the folder of a capture; \"{}\" {}", path.string(), kindInWords(path)));
}

}  // namespace beam
