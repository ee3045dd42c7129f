// SPDX-License-Identifier: Apache-2.0
// What a picture or a mesh was made from, as a note in its file: by it a later command knows that the file
// need not be made again.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "core/base/hash.h"
#include "core/math/similarity3.h"
#include "core/scene/camera.h"
#include "core/scene/gaussian_sequence.h"

namespace beam {

inline constexpr const char* kSourceNote = "source";

// The renderer and its way of light, of a picture that a panorama lights, in words.
inline constexpr const char* kLitByNote = "lit_by";

// What lights a picture or its layers, as a note: "relight_studio" and the digest of the panorama's file,
// each, with commas.
inline constexpr const char* kPanoramaNote = "panorama";
using PanoramaDigests = std::map<std::string, std::string>;  // by the name of the channel's folder or layer
std::string panoramaText(const PanoramaDigests& panoramas);
PanoramaDigests panoramasOf(const std::string& text);

// Values alone: no path, time or name of a project. Equal sources give the same bytes.
struct PictureSource {
  std::string renderer;          // its id; of a mesh empty
  Digest frame_stamp;            // of the frame in its sequence, taken before the frame is read
  std::string frame;             // its name: frames between the same two differ by it
  Similarity3 frame_from_world;  // axes, unit and origin of what goes out
  std::string axes;              // how the file calls them
  RenderMode mode = {};
  const Camera* camera = nullptr;      // null: of a mesh
  std::vector<std::string> channels;   // of the file, in their order
  std::vector<Digest> panoramas = {};  // files whose light is in it, in that order
  std::string shadows = {};            // kOcclusionAlone where that is what they are drawn by
};

// 32 digits; also of the program's version. Empty where the stamp is none: such a file is always made anew.
std::string digestText(const PictureSource& source);

// Whether `file` is there, whole, and says `written_by` and this digest, which is not empty.
bool isMadeFrom(const std::filesystem::path& file, const std::string& written_by, const std::string& digest);

}  // namespace beam
