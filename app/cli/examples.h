// SPDX-License-Identifier: Apache-2.0
// Examples of every command, as the help shows them and the tests run them: in a folder with the capture
// CAPTURE of four frames, a panorama studio.exr and its solved project Take.beam with held-out cameras, as
// `beam sample` and `beam process` make them.
#pragma once

#include <string>
#include <vector>

namespace beam {

struct Example {
  std::string line;  // as typed
  std::string what;  // it does
};

// Of "beam run"; of "beam" what to begin with. A command without has an empty list.
const std::vector<Example>& examplesOf(const std::string& command);

}  // namespace beam
