// SPDX-License-Identifier: Apache-2.0
#include "core/stages/picture_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/word_list.h"
#include "core/io/file_notes.h"
#include "core/pipeline/version.h"

namespace beam {
namespace {

// Raised where equal sources give another picture or file within one version of the program.
constexpr int kPictureVersion = 1;

// Shortest form that gives the same bits again.
std::string numbers(std::initializer_list<double> values) {
  return fmt::format("{} ", fmt::join(values, " "));
}

std::string textOf(const Similarity3& s) {
  std::string text = numbers({s.scale, s.translation.x, s.translation.y, s.translation.z});
  for (int c = 0; c < 3; ++c) text += numbers({s.rotation[c].x, s.rotation[c].y, s.rotation[c].z});
  return text;
}

std::string textOf(const Camera& c) {
  const Intrinsics& k = c.intrinsics;
  const dquat& q = c.camera_from_world.rotation;
  const dvec3& t = c.camera_from_world.translation_m;
  std::string text = fmt::format("{} x {} {} ", c.width, c.height, c.lens.model);
  text += numbers({k.fx, k.fy, k.cx, k.cy, q.w, q.x, q.y, q.z, t.x, t.y, t.z});
  for (const double p : c.lens.parameters) text += numbers({p});
  return text;
}

}  // namespace

std::string panoramaText(const PanoramaDigests& panoramas) {
  std::vector<std::string> each;
  for (const auto& [name, digest] : panoramas) each.push_back(fmt::format("{} {}", name, digest));
  return fmt::format("{}", fmt::join(each, ", "));
}

PanoramaDigests panoramasOf(const std::string& text) {
  PanoramaDigests panoramas;
  for (const std::string& each : splitAtCommas(text)) {
    const std::size_t blank = each.rfind(' ');
    if (blank != std::string::npos) panoramas[each.substr(0, blank)] = each.substr(blank + 1);
  }
  return panoramas;
}

std::string digestText(const PictureSource& source) {
  if (source.frame_stamp == Digest{}) return {};
  std::string text = fmt::format("{} {}\n{}\n{} {}\n{} {}\n{}\n", kProgramVersion, kPictureVersion,
                                 source.renderer, source.frame_stamp.hex(), source.frame, source.axes,
                                 textOf(source.frame_from_world), source.mode.dilation_px2);
  if (source.camera) text += textOf(*source.camera) + "\n";
  text += fmt::format("{}\n", fmt::join(source.channels, "\n"));
  for (const Digest& panorama : source.panoramas) text += panorama.hex() + "\n";
  if (!source.shadows.empty()) text += source.shadows + "\n";
  return digestOf(text).hex();
}

bool isMadeFrom(const std::filesystem::path& file, const std::string& written_by, const std::string& digest) {
  if (digest.empty() || written_by.empty()) return false;
  const FileNotes notes = notesIn(file);
  return noteIn(notes, "Software") == written_by && noteIn(notes, kSourceNote) == digest;
}

}  // namespace beam
