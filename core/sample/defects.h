// SPDX-License-Identifier: Apache-2.0
// Faults of a camera that a sample capture can be made with, to see whether they are found.
#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"

namespace beam {

struct SampleDefect {
  enum class Kind {
    Dropped,  // every fourth frame, from the third on, has neither picture nor mask
    Late,     // pictures and masks show the figure three frames ago
    Blurred,  // out of focus by 1/80 of the picture's height (standard deviation); the masks are sharp
    Black     // the picture of the middle frame is black; its mask is as it should be
  };
  Kind kind;
  std::string camera;
};

// "late" or "late:cam03"; Error{Usage} for anything else. Without a camera each kind has its own.
SampleDefect parseDefect(const std::string& text);
std::string nameOf(const SampleDefect& defect);  // "late:cam03"

// What the defects do to the cameras of a take.
class SampleDefects {
 public:
  SampleDefects(std::vector<SampleDefect> list, int frames) : list_(std::move(list)), frames_(frames) {}

  // The frames that show the figure of `frame`; may be none.
  std::vector<int> shownIn(const std::string& camera, int frame) const;
  bool has(const std::string& camera, SampleDefect::Kind kind) const;
  bool black(const std::string& camera, int frame) const;
  std::vector<std::string> names() const;

 private:
  std::vector<SampleDefect> list_;
  int frames_;
};

Image<vec3> outOfFocus(const Image<vec3>& linear);

}  // namespace beam
