// SPDX-License-Identifier: Apache-2.0
#include "core/io/capture_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/base/fields.h"
#include "core/base/log.h"
#include "core/base/word_list.h"
#include "core/io/capture_description.h"
#include "core/io/capture_pictures.h"
#include "core/io/file.h"
#include "core/io/mesh_ply.h"
#include "core/scene/name_pattern.h"
#include "core/scene/transform.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

CaptureDescription describedBy(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": expected a capture folder, found none", folder.string()));
  }
  if (auto d = readDatasetJson(folder)) return *d;
  if (auto d = readTransformsJson(folder)) return *d;
  if (auto d = readColmapModel(folder)) return *d;
  if (const std::string half = halfColmapModel(folder); !half.empty()) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\" {}; copy the whole model, or export it once more",
                                               folder.string(), half));
  }
  throw Error(Error::Kind::Data,
              fmt::format("\"{}\" is no capture: expected dataset.json, transforms.json or a COLMAP "
                          "model in sparse/0, found none of them; beam help captures tells what each holds",
                          folder.string()));
}

// The mean up direction of the cameras, when it lies within 15 degrees of an axis that is known.
std::optional<UpAxis> upFromCameras(const CaptureDescription& d) {
  dvec3 up(0);
  for (const DescribedCamera& c : d.cameras) {
    up += glm::conjugate(c.camera.camera_from_world.rotation) * dvec3(0, -1, 0);
  }
  if (glm::length(up) < 1e-9) return std::nullopt;
  up = glm::normalize(up);
  const double near = std::cos(glm::radians(15.0));
  if (up.y > near) return UpAxis::PlusY;
  if (up.z > near) return UpAxis::PlusZ;
  if (up.y < -near) return UpAxis::MinusY;
  return std::nullopt;
}

void holdOut(CaptureDescription& d, const std::vector<std::string>& wanted) {
  for (const std::string& w : wanted) {
    const bool number = !w.empty() && w.find_first_not_of("0123456789") == std::string::npos;
    const bool camera = std::any_of(d.cameras.begin(), d.cameras.end(),
                                    [&](const auto& c) { return matchesName(w, c.name); });
    if (number && !camera) {
      const std::size_t every = std::stoul(w.substr(0, 9));
      if (every < 2)
        throw Error(Error::Kind::Usage,
                    fmt::format("--hold-out {}: expected camera names or a number of at least 2", w));
      for (std::size_t i = 0; i < d.cameras.size(); i += every) d.cameras[i].split = Split::Test;
    } else if (camera) {
      for (DescribedCamera& c : d.cameras) {
        if (matchesName(w, c.name)) c.split = Split::Test;
      }
    } else {
      std::vector<std::string> names;
      for (const DescribedCamera& c : d.cameras) names.push_back(c.name);
      throw Error(Error::Kind::Usage,
                  fmt::format("--hold-out {}: the capture has no camera of that name or like it; {}", w,
                              knownNames("cameras", w, names)));
    }
  }
}

// Drops training cameras without any picture, with a warning; test cameras may have none.
void dropEmptyCameras(CaptureDescription& d, const fs::path& folder) {
  std::vector<DescribedCamera> kept;
  for (DescribedCamera& c : d.cameras) {
    std::erase_if(c.pictures, [](const auto& p) { return !isThere(p.second); });
    if (c.pictures.empty() && c.split == Split::Train) {
      d.warnings.push_back(
          fmt::format("\"{}\": camera {}: expected pictures in \"{}\", found none; the camera is left out",
                      folder.string(), c.name, (folder / "images" / c.name).string()));
    } else {
      kept.push_back(std::move(c));
    }
  }
  d.cameras = std::move(kept);
  const auto train = std::count_if(d.cameras.begin(), d.cameras.end(),
                                   [](const auto& c) { return c.split == Split::Train; });
  if (train < kLeastTrainingCameras) {
    const auto held_out = static_cast<std::ptrdiff_t>(d.cameras.size()) - train;
    throw Error(
        Error::Kind::Data,
        fmt::format("\"{}\": expected pictures (PNG, JPEG) of at least {} training cameras, found {}{}{}",
                    folder.string(), kLeastTrainingCameras, train,
                    held_out > 0 ? fmt::format(" beside {} held out", held_out) : std::string(),
                    fs::is_directory(folder / "videos")
                        ? "; videos are not read: take their frames out into images/CAMERA/"
                        : ""));
  }
}

PointCloud pointsOf(const CaptureDescription& d, const fs::path& folder, std::vector<std::string>& warnings) {
  for (const fs::path& file : {folder / "points3D.ply", folder / "sparse/0/points3D.ply", d.points_file}) {
    if (file.empty() || !fs::is_regular_file(file)) continue;
    try {
      return readPointsPly(file);
    } catch (const Error& e) {
      requireData(e);
      warnings.push_back(fmt::format("{}; the seed points are left out", e.what()));
    }
  }
  return d.points;
}

bool isNumber(const std::string& name) { return name.find_first_not_of("0123456789") == std::string::npos; }

// Names by their numbers where all are numbers ("2" before "10"), else as text.
std::vector<std::string> framesOf(const CaptureDescription& d) {
  std::set<std::string> names;
  for (const DescribedCamera& c : d.cameras) {
    for (const auto& [frame, file] : c.pictures) names.insert(frame);
  }
  std::vector<std::string> frames(names.begin(), names.end());
  if (std::all_of(frames.begin(), frames.end(), isNumber)) {
    const auto digits = [](const std::string& s) {
      return s.substr(std::min(s.find_first_not_of('0'), s.size()));
    };
    std::stable_sort(frames.begin(), frames.end(), [&](const std::string& a, const std::string& b) {
      const std::string x = digits(a), y = digits(b);
      return x.size() != y.size() ? x.size() < y.size() : x < y;
    });
  }
  return frames;
}

// One row of the table: the pictures and masks of a camera by frame.
std::vector<PictureFiles> filesOf(const DescribedCamera& c, const std::vector<std::string>& frames,
                                  const fs::path& folder) {
  std::vector<PictureFiles> row(frames.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const auto picture = c.pictures.find(frames[f]);
    if (picture == c.pictures.end()) continue;
    const auto mask = c.masks.find(frames[f]);
    const bool named = mask != c.masks.end() && fs::exists(mask->second);
    row[f] = {picture->second, named ? mask->second : findMask(folder, picture->second, c.name)};
  }
  return row;
}

// Frames that no camera has leave a gap in numbers that otherwise keep their step.
void warnOfMissingFrames(CaptureDescription& d, const std::vector<std::string>& frames) {
  constexpr std::size_t kMostDigits = 18;  // of a 64-bit number
  std::vector<std::int64_t> numbers;
  for (const std::string& name : frames) {
    if (name.empty() || name.size() > kMostDigits || !isNumber(name)) return;
    numbers.push_back(std::stoll(name));
  }
  std::int64_t step = 0;
  for (std::size_t f = 1; f < numbers.size(); ++f)
    step = f == 1 ? numbers[1] - numbers[0] : std::min(step, numbers[f] - numbers[f - 1]);
  std::vector<std::string> gaps;
  for (std::size_t f = 1; f < numbers.size(); ++f) {
    if (numbers[f] - numbers[f - 1] > step) gaps.push_back(frames[f - 1] + " and " + frames[f]);
  }
  if (gaps.empty()) return;
  d.warnings.push_back(
      fmt::format("no camera has a picture between frames {}; they are solved as if one followed the other",
                  shortList(gaps)));
}

// Says which training pictures and which masks are not there.
void warnOfGaps(CaptureDescription& d, const PictureTable& files, const std::vector<std::string>& frames,
                MaskKind kind) {
  for (std::size_t v = 0; v < files.size(); ++v) {
    std::vector<std::string> no_picture, no_mask;
    for (std::size_t f = 0; f < frames.size(); ++f) {
      if (files[v][f].picture.empty()) {
        no_picture.push_back(frames[f]);
      } else if (kind == MaskKind::Files && files[v][f].mask.empty()) {
        no_mask.push_back(frames[f]);
      }
    }
    const std::string& name = d.cameras[v].name;
    if (!no_picture.empty() && d.cameras[v].split == Split::Train) {
      d.warnings.push_back(fmt::format("camera {} has no picture of {} {}; solved without it", name,
                                       nounText(no_picture.size(), "frame"), shortList(no_picture)));
    }
    if (!no_mask.empty()) {
      d.warnings.push_back(
          fmt::format("camera {} has no mask for {} {}; expected one as for the other cameras", name,
                      nounText(no_mask.size(), "frame"), shortList(no_mask)));
    }
  }
}

// Without an origin of their own, as all that reads them takes them.
void inWorld(PointCloud& seeds) {
  for (std::size_t i = 0; i < seeds.position_m.size(); ++i) seeds.position_m[i] = vec3(seeds.position(i));
  seeds.origin = dvec3(0);
}

// What the seed points say of their unit, against the masks.
void warnOfSeeds(const SubjectMeasure& subject, std::size_t count, const fs::path& folder,
                 std::vector<std::string>& warnings) {
  constexpr double kNone = 0.02;  // points of the room around the subject are no mistake
  if (!subject.seeds) return;
  const SeedFit& fit = *subject.seeds;
  if (fit.factor != 1) {
    warnings.push_back(
        fmt::format("\"{}\": expected {} seed points in the unit of the cameras; found that they fit the "
                    "masks only after a factor of {:.4g}: scale them or leave them out",
                    folder.string(), count, fit.factor));
  } else if (fit.share < kNone) {
    warnings.push_back(
        fmt::format("\"{}\": expected seed points inside the masks, found {:.0f} % of {} there: the "
                    "points and the cameras differ in place, axes or unit",
                    folder.string(), 100 * fit.share, count));
  }
}

void warnOfInvertedMasks(const fs::path& folder, std::vector<std::string>& warnings) {
  warnings.push_back(fmt::format(
      "\"{}\": the masks look inverted: expected white where the subject is, found white along the "
      "borders of the pictures and black inside; invert them. The subject's size is not measured",
      folder.string()));
}

// Where a turned capture lies, as it is found when a project is made.
CapturePlacement foundPlacement(const CaptureSet& turned, const UnitHints& hints, const fs::path& folder,
                                std::vector<std::string>& warnings) {
  const SubjectMeasure subject = measureSubject(turned);
  if (subject.masks_look_inverted) warnOfInvertedMasks(folder, warnings);
  warnOfSeeds(subject, turned.seed_points.position_m.size(), folder, warnings);
  return placementOf(subject, hints, turned.up);
}

// All that is written of a capture names them, and JSON is UTF-8.
void requireUtf8(const CaptureSet& set, const fs::path& folder) {
  const auto require = [&](const char* what, const std::string& name) {
    if (isUtf8(name)) return;
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": the {} \"{}\" is not named in UTF-8; rename its files", folder.string(),
                            what, name));
  };
  for (const View& view : set.views) require("camera", view.name);
  for (const std::string& frame : set.frames) require("frame", frame);
}

ImportedCapture importedFrom(CaptureDescription d, const fs::path& folder, UpAxis up,
                             const ImportOptions& options) {
  ImportedCapture out;
  CaptureSet& set = out.set;
  out.layout = d.layout;
  set.name = d.name;
  set.frames_per_second = d.frames_per_second;
  set.up = up;
  set.frames = framesOf(d);
  PictureTable files;
  for (const DescribedCamera& c : d.cameras) {
    set.views.push_back({c.name, c.camera, c.split});
    files.push_back(filesOf(c, set.frames, folder));
  }
  requireUtf8(set, folder);
  const MaskKind kind = maskKindOf(files);
  warnOfMissingFrames(d, set.frames);
  warnOfGaps(d, files, set.frames, kind);
  set.masks = kind;
  set.seed_points = pointsOf(d, folder, d.warnings);
  for (const char* name : {"environment.exr", "environment.hdr"}) {
    if (!set.environment_file && fs::exists(folder / name)) set.environment_file = (folder / name).string();
  }
  set.source = makeFileFrames(std::move(files), set.views, kind);
  // The turn first: up is up wherever a subject is measured.
  CaptureSet turned = transformed(set, {worldFromCapture(up)});
  out.placement = options.placement ? *options.placement
                                    : foundPlacement(turned, {options.unit_m, d.unit_m}, folder, d.warnings);
  const Similarity3 world_from_capture = worldFromCapture(up, out.placement);
  set = isTurn(world_from_capture) ? std::move(turned) : transformed(std::move(set), world_from_capture);
  inWorld(set.seed_points);
  for (std::string& doubt : doubtsOf(out.placement, folder.string())) d.warnings.push_back(std::move(doubt));
  out.warnings = std::move(d.warnings);
  return out;
}

ImportedCapture open(const fs::path& folder, const ImportOptions& options) {
  CaptureDescription d = describedBy(folder);
  // By name, whatever the order of the file: every Nth camera is then the same one in every description.
  std::stable_sort(d.cameras.begin(), d.cameras.end(),
                   [](const DescribedCamera& a, const DescribedCamera& b) { return a.name < b.name; });
  holdOut(d, options.hold_out);
  for (const DescribedCamera& c : d.cameras) {
    try {
      validate(c.camera, c.name);
    } catch (const Error& e) {
      throw Error(Error::Kind::Data, fmt::format("\"{}\", {}: {}", folder.string(), d.layout, e.what()));
    }
  }
  requireStill(d, fmt::format("\"{}\", {}", folder.string(), d.layout));
  dropEmptyCameras(d, folder);
  const std::optional<UpAxis> up = options.up ? options.up : d.up ? d.up : upFromCameras(d);
  if (!up) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": the up axis is not known (the cameras' mean up vector is not near "
                            "+Y, +Z or -Y); say it with --up",
                            folder.string()));
  }
  return importedFrom(std::move(d), folder, *up, options);
}

}  // namespace

bool isCapture(const fs::path& folder) {
  std::error_code out_of_reach;
  return fs::is_regular_file(folder / "dataset.json", out_of_reach) ||
         fs::is_regular_file(folder / "transforms.json", out_of_reach) || hasColmapModel(folder);
}

ImportedCapture openCapture(const fs::path& folder, const ImportOptions& options) {
  try {
    ImportedCapture capture = open(folder, options);
    for (const std::string& w : capture.warnings) logWarning("{}", w);
    return capture;
  } catch (const fs::filesystem_error& e) {
    if (e.code() == std::errc::not_enough_memory) throw storageError(e);
    throw Error(Error::Kind::Storage,
                fmt::format("\"{}\": the capture cannot be read: {}", folder.string(), e.what()));
  }
}

}  // namespace beam
