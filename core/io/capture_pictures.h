// SPDX-License-Identifier: Apache-2.0
// The pictures and masks of an opened capture as files: where masks are looked for, what kind of mask a
// capture has, and the FrameSource that reads them when asked.
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/scene/capture.h"

namespace beam {

struct PictureFiles {
  std::filesystem::path picture, mask;  // empty: there is none
};

// Pictures of every view, one entry a frame.
using PictureTable = std::vector<std::vector<PictureFiles>>;

// Where the mask of a picture lies, by the names that capture tools give them; empty: nowhere.
std::filesystem::path findMask(const std::filesystem::path& root, const std::filesystem::path& picture,
                               const std::string& camera);

// Files where any picture has one; else alpha or a black or white key, as the first readable picture has it.
MaskKind maskKindOf(const PictureTable& files);

// Throws Error{Data} that names the file and both sizes unless `file` has the size of its calibration.
void requireCalibratedSize(const View& view, const std::filesystem::path& file, ivec2 found,
                           const char* what);

std::shared_ptr<const FrameSource> makeFileFrames(PictureTable files, std::vector<View> views, MaskKind kind);

// The folders that the capture's pictures lie in, and those of its masks where these are asked for.
std::set<std::filesystem::path> pictureFolders(const CaptureSet& capture, bool masks_too);

}  // namespace beam
