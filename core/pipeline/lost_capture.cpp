// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/lost_capture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/pipeline/input_digests.h"
#include "core/pipeline/project.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

class NoPictures final : public FrameSource {
 public:
  bool has(ViewIndex, FrameIndex) const override { return false; }
  Image<u8vec3> photo(ViewIndex, FrameIndex) const override {
    throw Error(Error::Kind::Data,
                "there are no pictures: the capture of this project is gone; put it back or locate it");
  }
  Image<std::uint8_t> mask(ViewIndex, FrameIndex) const override { return {}; }
};

std::size_t digitsAt(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end]))) ++end;
  return end - at;
}

// Without leading zeros.
std::string_view numberAt(std::string_view text, std::size_t at, std::size_t digits) {
  std::string_view number = text.substr(at, digits);
  while (number.size() > 1 && number.front() == '0') number.remove_prefix(1);
  return number;
}

}  // namespace

bool naturallyBefore(std::string_view a, std::string_view b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const std::size_t m = digitsAt(a, i), n = digitsAt(b, j);
    if (m > 0 && n > 0) {
      const std::string_view left = numberAt(a, i, m), right = numberAt(b, j, n);
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
      i += m, j += n;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
    }
  }
  if (i < a.size() || j < b.size()) return i == a.size();
  return a < b;  // "01" and "1"
}

ImportedCapture captureFromResults(const Project& project) {
  ImportedCapture found;
  found.layout = "results";
  found.set.name = project.name();
  found.set.source = std::make_shared<const NoPictures>();
  std::set<std::string> frames;
  for (const ResultRecord& record : project.store().recordsByAge()) {
    const StepShown shown = shownOf(project.setup().stages, record.ingredients.step);
    const fs::path folder = project.store().folderOf(record.key);
    std::error_code failed;
    if (!record.frame.empty()) frames.insert(record.frame);
    const auto has = [&](const std::string& file) {
      return !file.empty() && fs::exists(folder / file, failed);
    };
    if (has(shown.panorama_file)) found.set.environment_file = (folder / shown.panorama_file).string();
    if (!has(shown.cameras_file)) continue;
    try {
      found.set.views = viewsOfCalibration(readTextFile(folder / shown.cameras_file));
    } catch (const Error& e) {
      requireData(e);
      found.warnings.emplace_back(e.what());
    }
  }
  found.set.frames.assign(frames.begin(), frames.end());
  std::sort(found.set.frames.begin(), found.set.frames.end(), naturallyBefore);
  return found;
}

}  // namespace beam
