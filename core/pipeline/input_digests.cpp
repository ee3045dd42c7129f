// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/input_digests.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <istream>
#include <locale>
#include <span>
#include <sstream>

#include "core/base/error.h"
#include "core/pipeline/file_digest.h"

namespace beam {
namespace {

template <class T>
Digest digestOfValues(const std::vector<T>& values) {
  return digestOf(std::as_bytes(std::span(values)));
}

// By decoded content, for sources without files; an unreadable picture is a fact like any other.
std::string contentText(const FrameSource& source, ViewIndex view, FrameIndex frame) {
  try {
    return fmt::format("{} {}", digestOfValues(source.photo(view, frame).pixels).hex(),
                       digestOfValues(source.mask(view, frame).pixels).hex());
  } catch (const Error& e) {
    requireData(e);
    return "unreadable";
  }
}

// A picture that cannot be read is left out of its frame (loadFrameViews).
std::string fileText(const InputDigests& digests, const std::filesystem::path& file) {
  try {
    return digests.file(file).hex();
  } catch (const Error& e) {
    requireData(e);
    return "unreadable";
  }
}

// Word and all parameters; nothing of a pinhole, so that its text and the keys on it stay.
std::string lensText(const Lens& lens) {
  if (isPinhole(lens)) return "";
  return fmt::format(" lens {} {}", lens.model, fmt::join(lens.parameters, " "));
}

// What lensText() wrote at the end of a line; fails the stream for anything else.
Lens readLens(std::istream& lines) {
  std::string rest, word;
  std::getline(lines, rest);
  std::istringstream words(rest);
  words.imbue(std::locale::classic());
  Lens lens;
  if (!(words >> word)) return lens;
  words >> lens.model;
  for (double& parameter : lens.parameters) words >> parameter;
  if (!words || word != "lens") lines.setstate(std::ios::failbit);
  return lens;
}

}  // namespace

std::string calibrationText(const CaptureSet& capture) {
  std::string text;
  for (const View& view : capture.views) {
    const Camera& c = view.camera;
    const dquat& q = c.camera_from_world.rotation;
    const dvec3& t = c.camera_from_world.translation_m;
    text += fmt::format("view {}:{} {} {}x{} k {} {} {} {} q {} {} {} {} t {} {} {}{}\n", view.name.size(),
                        view.name, view.split == Split::Train ? "train" : "test", c.width, c.height,
                        c.intrinsics.fx, c.intrinsics.fy, c.intrinsics.cx, c.intrinsics.cy, q.w, q.x, q.y,
                        q.z, t.x, t.y, t.z, lensText(c.lens));
  }
  text += fmt::format("seed points {} {} {}\n", capture.seed_points.position_m.size(),
                      digestOfValues(capture.seed_points.position_m).hex(),
                      digestOfValues(capture.seed_points.color).hex());
  return text;
}

std::vector<View> viewsOfCalibration(const std::string& text) {
  std::vector<View> views;
  std::istringstream lines(text);
  lines.imbue(std::locale::classic());
  std::string word;
  // Names may hold spaces and line breaks, so they go by their length.
  while (lines >> word && word == "view") {
    View v;
    std::size_t length = 0;
    std::string split;
    char colon = 0, by = 0;
    lines >> length >> colon;
    v.name.resize(std::min<std::size_t>(length, text.size()));
    lines.read(v.name.data(), static_cast<std::streamsize>(v.name.size()));
    Camera& c = v.camera;
    dquat& q = c.camera_from_world.rotation;
    dvec3& t = c.camera_from_world.translation_m;
    lines >> split >> c.width >> by >> c.height >> word >> c.intrinsics.fx >> c.intrinsics.fy >>
        c.intrinsics.cx >> c.intrinsics.cy >> word >> q.w >> q.x >> q.y >> q.z >> word >> t.x >> t.y >> t.z;
    c.lens = readLens(lines);
    if (!lines || colon != ':' || by != 'x')
      throw Error(Error::Kind::Data, fmt::format("the cameras of the import cannot be understood: camera {} "
                                                 "is not whole",
                                                 views.size() + 1));
    v.split = split == "train" ? Split::Train : Split::Test;
    validate(c, v.name);
    views.push_back(std::move(v));
  }
  return views;
}

std::size_t seedPointsOfCalibration(const std::string& text) {
  constexpr std::string_view kBefore = "\nseed points ";
  const std::size_t at = text.rfind(kBefore);
  return at == std::string::npos ? 0 : std::strtoull(text.c_str() + at + kBefore.size(), nullptr, 10);
}

Digest InputDigests::calibration(const CaptureSet& capture) const {
  return digestOf(calibrationText(capture));
}

std::vector<PictureDigest> InputDigests::eachPicture(const CaptureSet& capture, FrameIndex frame,
                                                     Split split) const {
  std::vector<PictureDigest> pictures;
  for (std::size_t i = 0; i < capture.views.size(); ++i) {
    const ViewIndex view{static_cast<std::int32_t>(i)};
    if (capture.views[i].split != split || !capture.source->has(view, frame)) continue;
    PictureDigest picture{capture.views[i].name, capture.source->files(view, frame), {}};
    // Gone since the capture was read: as if it had never been there. Out of reach: unreadable.
    std::error_code out_of_reach;
    const bool gone = !picture.files.empty() && !std::filesystem::exists(picture.files.front(), out_of_reach);
    if (gone && !out_of_reach) continue;
    for (const std::string& name : picture.files) picture.words.push_back(fileText(*this, name));
    if (picture.files.empty()) picture.words.push_back(contentText(*capture.source, view, frame));
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

Digest InputDigests::pictures(const CaptureSet& capture, FrameIndex frame, Split split) const {
  // The kind is read off the first picture, which need not be one of these.
  std::string text = fmt::format("masks {}\n", static_cast<int>(capture.masks));
  for (const PictureDigest& p : eachPicture(capture, frame, split))
    text += fmt::format("view {}:{} {}\n", p.view.size(), p.view, fmt::join(p.words, " "));
  return digestOf(text);
}

Digest InputDigests::file(const std::filesystem::path& path) const {
  const std::string stamp = fileStamp(path);
  {
    std::lock_guard lock(mutex_);
    if (const auto known = files_.find(path.string());
        known != files_.end() && known->second.stamp == stamp) {
      return known->second.digest;
    }
  }
  const Digest digest = digestOfFile(path);
  if (justChanged(path)) return digest;
  std::lock_guard lock(mutex_);
  files_[path.string()] = {stamp, digest};
  return digest;
}

}  // namespace beam
