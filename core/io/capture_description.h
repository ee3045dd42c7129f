// SPDX-License-Identifier: Apache-2.0
// What a description file says of a capture, still in the capture's own axes; the three readers of
// descriptions and how they are told apart. openCapture turns it into a CaptureSet.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/capture.h"

namespace beam {

struct DescribedCamera {
  std::string name;
  Camera camera;  // camera_from_world holds camera_from_capture
  Split split = Split::Train;
  std::map<std::string, std::filesystem::path> pictures;  // by frame name
  std::map<std::string, std::filesystem::path> masks;     // as the description names them; may be empty
  double moved = 0;  // farthest that another of its pictures was taken from there, in the capture's unit
};

struct CaptureDescription {
  std::string layout;
  std::string name;
  double frames_per_second = 30;
  std::optional<UpAxis> up;
  std::optional<double> unit_m;  // metres a unit, where the description names it
  std::vector<DescribedCamera> cameras;
  std::filesystem::path points_file;  // seed points named by the description; may be empty
  PointCloud points;                  // capture axes; may be empty
  std::vector<std::string> warnings;
};

// Each returns nothing when its file is not there, and throws Error{Data} when it is there and wrong.
std::optional<CaptureDescription> readDatasetJson(const std::filesystem::path& folder);
std::optional<CaptureDescription> readTransformsJson(const std::filesystem::path& folder);
std::optional<CaptureDescription> readColmapModel(const std::filesystem::path& folder);
bool hasColmapModel(const std::filesystem::path& folder);  // whether its files are there
// Of a folder with some of these: "has half of a COLMAP model: sparse/0/cameras.bin without images.bin";
// empty: it has all or none.
std::string halfColmapModel(const std::filesystem::path& folder);

// Pictures of a camera folder by frame name (file stem); hidden files are none.
std::map<std::string, std::filesystem::path> picturesIn(const std::filesystem::path& folder);
bool isPicture(const std::filesystem::path& file);

// A rotation matrix given in a file: throws Error{Data} unless it is orthonormal to 1e-3.
dquat rotationFromMatrix(const dmat3& matrix, const std::string& where);

// For descriptions with one pose a picture: notes how far the camera moved, throws Error{Data} when it turns
// or changes its lens.
void addPose(DescribedCamera& known, const Camera& again, const std::string& where);
// Throws Error{Data} when a camera moved by more than its share of the distance to what the cameras look at,
// which is the same in every unit.
void requireStill(const CaptureDescription& description, const std::string& where);

// Names become paths, here and in what is written: throws Error{Data} for those that leave their folder.
void requirePlainName(const std::string& name, const std::string& where);

}  // namespace beam
