// SPDX-License-Identifier: Apache-2.0
// PNG, JPEG, EXR and Radiance HDR files. Every reader checks the header's sizes against caps and against the
// bytes that are there before it allocates, so that no file takes memory that it could not fill, and throws
// Error{Data} naming file, expected and found.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/io/written_by.h"

namespace beam {

struct ImageSize {
  int width = 0, height = 0;
  bool has_alpha = false;
};

// Size from the header alone (PNG, JPEG).
ImageSize readImageSize(const std::filesystem::path& path);
// The same, and throws when the picture's end is not there; decodes nothing.
ImageSize checkImageFile(const std::filesystem::path& path);

// 8-bit sRGB picture, alpha dropped.
Image<u8vec3> readPhoto(const std::filesystem::path& path);
// Coverage from a mask picture: its single or first channel; of a picture with alpha, readAlpha.
Image<std::uint8_t> readMask(const std::filesystem::path& path);
Image<std::uint8_t> readAlpha(const std::filesystem::path& path);

// Endings, in lower case, of files that a person may take for photographs and no reader here does.
const std::vector<std::string_view>& unreadPictureEndings();
const std::vector<std::string_view>& videoEndings();

// Whether readRadiance takes a file of that name.
bool isRadianceName(const std::filesystem::path& path);
// Whether it is an .exr that has luminance alone.
bool isGrayExr(const std::filesystem::path& path);
// Linear RGB of an .exr or .hdr file; an .exr that has luminance alone is gray.
Image<vec3> readRadiance(const std::filesystem::path& path);

// Float planes of an EXR file in order of `channels`, over its display window (0 where the file has no data);
// channels of a layer ("env.R") serve when the plain names are missing and one layer has them all.
Planes readExr(const std::filesystem::path& path, const std::vector<std::string>& channels);
std::vector<std::string> exrChannels(const std::filesystem::path& path);

// With notes also the colour state, of an sRGB picture, for programs that ask for it; without, pixels alone.
void writePng(const std::filesystem::path& path, const Image<u8vec3>& image, const FileNotes& notes = {});
void writePng(const std::filesystem::path& path, const Image<std::uint8_t>& image,
              const FileNotes& notes = {});
// With straight alpha.
void writePng(const std::filesystem::path& path, const Image<u8vec4>& image, const FileNotes& notes = {});

// A JPEG picture in memory; quality in [0, 100].
std::vector<std::byte> encodeJpeg(const Image<u8vec3>& image, int quality);

enum class ExrPrecision { Half, Float };
// One channel a plane, PIZ-compressed, named as given ("Y", or "R" "G" "B"); notes are string attributes.
void writeExr(const std::filesystem::path& path, const Planes& planes,
              const std::vector<std::string>& channels, ExrPrecision precision, const FileNotes& notes = {});

// A channel of an EXR file: width x height values, rows top to bottom, no padding.
struct ExrChannel {
  std::string name;  // "R"; of a layer "normal.X"
  ExrPrecision precision = ExrPrecision::Half;
  const float* values = nullptr;
};
// Channels of different precision and layers in one file, otherwise as above: the same channels give the same
// bytes. Throws Error{Data} for more than is read again (requireExrSize) before it takes memory. `progress`
// is asked whether to stop: Cancelled, and nothing is written.
void writeExr(const std::filesystem::path& path, int width, int height, std::span<const ExrChannel> channels,
              const FileNotes& notes = {}, const Progress* progress = nullptr);

}  // namespace beam
