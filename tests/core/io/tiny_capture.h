// SPDX-License-Identifier: Apache-2.0
// A capture of two training cameras and a test camera, +Z up, two frames of 20 x 12 pixels, written by the
// test itself; and the message with which a capture is refused.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/base/error.h"
#include "core/io/capture_reader.h"
#include "core/io/image_file.h"

namespace beam::testing {

inline constexpr const char* kDataset = R"({"name": "t", "fps": 25, "world": {"up": "+Z"}, "cameras": {
  "a": {"split": "train", "width": 20, "height": 12, "fx": 30, "fy": 31, "cx": 9.5, "cy": 6,
        "R": [[1,0,0],[0,0,-1],[0,1,0]], "t": [0.1, 0.9, 3]},
  "b": {"split": "train", "width": 20, "height": 12, "fx": 30, "fy": 31, "cx": 9.5, "cy": 6,
        "R": [[0,1,0],[0,0,-1],[-1,0,0]], "t": [0, 0.9, 3]},
  "c": {"split": "test", "width": 20, "height": 12, "fx": 30, "fy": 31, "cx": 9.5, "cy": 6,
        "R": [[1,0,0],[0,0,-1],[0,1,0]], "t": [0, 0.9, 4]}}})";

inline void put(const std::filesystem::path& path, const std::string& bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

inline void putPictures(const std::filesystem::path& folder, int width = 20) {
  for (const char* camera : {"a", "b"}) {
    std::filesystem::create_directories(folder / "images" / camera);
    std::filesystem::create_directories(folder / "masks" / camera);
    for (const char* frame : {"000003", "000004"}) {
      writePng(folder / "images" / camera / (std::string(frame) + ".png"),
               Image<u8vec3>(width, 12, u8vec3(10, 20, 30)));
      writePng(folder / "masks" / camera / (std::string(frame) + ".png"), Image<std::uint8_t>(20, 12, 255));
    }
  }
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

inline std::string errorOf(const std::filesystem::path& folder, const ImportOptions& options = {},
                           Error::Kind kind = Error::Kind::Data) {
  try {
    openCapture(folder, options);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), kind);
    return e.what();
  }
  ADD_FAILURE() << "expected an error";
  return "";
}

}  // namespace beam::testing
