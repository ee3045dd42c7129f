// SPDX-License-Identifier: Apache-2.0
#include "core/io/capture_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/base/log.h"
#include "core/base/parallel.h"
#include "core/base/word_list.h"
#include "core/io/capture_pictures.h"
#include "core/io/file.h"
#include "core/io/image_file.h"
#include "core/io/splat_ply.h"
#include "core/scene/environment.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

// What is repaired on the way is logged where it is repaired; the report lists it too. What other threads log
// meanwhile is theirs.
PanoramaCheck checkPanorama(const fs::path& path, std::vector<std::string>& warnings) {
  const int token = addLogSink([&, own = std::this_thread::get_id()](const LogRecord& r) {
    if (r.level == LogLevel::Warning && std::this_thread::get_id() == own) warnings.push_back(r.text);
  });
  const std::unique_ptr<const int, void (*)(const int*)> remove(&token,
                                                                [](const int* t) { removeLogSink(*t); });
  const Environment e = makeEnvironment(readRadiance(path));
  if (isGrayExr(path)) {
    warnings.push_back(fmt::format(
        "\"{}\": expected the channels R, G and B of a panorama, found Y alone: it is read as grey light; a "
        "depth map or another map of one channel is no light",
        path.string()));
  }
  if (const std::string doubt = shapeDoubt(e.radiance, path.string()); !doubt.empty())
    warnings.push_back(doubt);
  return {e.radiance.width, e.radiance.height, meanRadiance(e), brightestDirection(e)};
}

double coverageOf(const Image<std::uint8_t>& mask) {
  if (mask.empty()) return -1;
  double sum = 0;
  for (const std::uint8_t m : mask.pixels) sum += m / 255.0;
  return sum / static_cast<double>(mask.pixels.size());
}

// A lens cap and the noise that compression leaves of it differ less.
bool isOneColor(const Image<u8vec3>& photo) {
  constexpr int kAlike = 4;
  u8vec3 low(255), high(0);
  for (const u8vec3& p : photo.pixels) low = glm::min(low, p), high = glm::max(high, p);
  const ivec3 spread = ivec3(high) - ivec3(low);
  return std::max({spread.x, spread.y, spread.z}) <= kAlike;
}

// More bytes hold more than one colour: a PNG of one shrinks to a thousandth of its pixels' bytes, a JPEG to
// two bytes a block of 64; profiles and thumbnails come on top. A PNG that is stored and not compressed is
// missed.
bool mayBeOneColor(const fs::path& file, ImageSize size) {
  constexpr double kOverhead = 1 << 16, kPerPixel = 1.0 / 16;
  std::error_code failed;
  const std::uintmax_t bytes = fs::file_size(file, failed);
  return !failed && static_cast<double>(bytes) <= kOverhead + kPerPixel * size.width * size.height;
}

void warnOfOneColor(const std::string& camera, const std::vector<std::string>& frames,
                    std::vector<std::string>& warnings) {
  if (frames.empty()) return;
  warnings.push_back(
      fmt::format("camera {}, {} {}: expected {}, found one colour all over: a lens cap, a lost feed or a "
                  "damaged file? It would be learned as it is: remove {} from the capture",
                  camera, nounText(frames.size(), "frame"), shortList(frames),
                  frames.size() == 1 ? "a photograph" : "photographs", frames.size() == 1 ? "it" : "them"));
}

// Decodes the first picture that can be used, for its mask, and those that may show nothing; looks at the
// others without decoding them: whole, and of the calibrated size.
CameraCheck checkCamera(const CaptureSet& set, std::size_t view, CameraCheck c,
                        std::vector<std::string>& warnings, const Progress& progress) {
  const View& v = set.views[view];
  const ViewIndex index{static_cast<std::int32_t>(view)};
  std::vector<std::string> one_color;
  for (std::size_t f = 0; f < set.frames.size(); ++f) {
    const FrameIndex frame{static_cast<std::int32_t>(f)};
    if (progress.stopRequested()) return c;
    if (!set.source->has(index, frame)) continue;
    try {
      if (c.frames == 0) {
        if (isOneColor(set.source->photo(index, frame))) one_color.push_back(set.frames[f]);
        c.mask_coverage = coverageOf(set.source->mask(index, frame));
        if (c.mask_coverage == 0) {
          warnings.push_back(fmt::format("camera {}, frame {}: the mask is empty", v.name, set.frames[f]));
        }
      } else {
        const std::vector<std::string> files = set.source->files(index, frame);
        for (std::size_t i = 0; i < files.size(); ++i) {
          const ImageSize s = checkImageFile(files[i]);
          requireCalibratedSize(v, files[i], {s.width, s.height}, i == 0 ? "picture" : "mask");
          if (i == 0 && mayBeOneColor(files[i], s) && isOneColor(readPhoto(files[i])))
            one_color.push_back(set.frames[f]);
        }
      }
      ++c.frames;
    } catch (const Error& e) {
      requireData(e);
      warnings.push_back(
          fmt::format("{}; camera {}, frame {} cannot be used", e.what(), v.name, set.frames[f]));
    }
  }
  warnOfOneColor(v.name, one_color, warnings);
  return c;
}

// What a person takes for a picture and no reader of photographs does.
bool isForeignPicture(const fs::path& file) {
  const std::string ending = lowerCase(file.extension().string());
  const auto has = [&](const std::vector<std::string_view>& endings) {
    return std::find(endings.begin(), endings.end(), ending) != endings.end();
  };
  return isRadianceName(file) || has(unreadPictureEndings()) || has(videoEndings());
}

// Folders of photographs that hold other pictures too. The capture's own folder has the panorama.
void warnOfForeignPictures(const CaptureSet& set, const fs::path& capture,
                           std::vector<std::string>& warnings) {
  std::set<fs::path> folders = pictureFolders(set, false);
  folders.erase(capture.lexically_normal());
  for (const fs::path& folder : folders) {
    std::vector<std::string> found;
    for (const fs::directory_entry& entry : entriesOf(folder))
      if (isForeignPicture(entry.path())) found.push_back(entry.path().filename().string());
    if (found.empty()) continue;
    warnings.push_back(
        fmt::format("\"{}\": expected photographs as PNG or JPEG, found also {}, which {} not used",
                    folder.string(), shortList(found), found.size() == 1 ? "is" : "are"));
  }
}

// The photographs' light, or what is missing of it.
void checkLight(const CaptureSet& set, CheckReport& r) {
  if (set.environment_file) {
    try {
      r.panorama = checkPanorama(*set.environment_file, r.warnings);
    } catch (const Error& e) {
      requireData(e);
      r.warnings.emplace_back(e.what());
    }
    return;
  }
  constexpr const char* kNoLight = "the run stops after Surface";
  for (const char* name : {"environment.png", "environment.jpg", "environment.jpeg"}) {
    std::error_code failed;
    if (!fs::exists(fs::path(r.path) / name, failed)) continue;
    return r.warnings.push_back(
        fmt::format("\"{}\" is not used: expected a panorama with the true brightness of lamps "
                    "(environment.exr or .hdr), found one of 8 bits, in which they are clipped; {}",
                    (fs::path(r.path) / name).string(), kNoLight));
  }
  r.warnings.push_back(fmt::format("no panorama (environment.exr or .hdr): {}", kNoLight));
}

SplatCheck checkSplats(const fs::path& path) {
  const SplatFile f = readSplatPly(path);
  SplatCheck s{f.cloud.size(), f.sh_degree, f.materials.has_value()};
  if (s.count == 0) return s;
  s.low = s.high = f.cloud.position_m[0];
  for (const vec3& p : f.cloud.position_m) s.low = glm::min(s.low, p), s.high = glm::max(s.high, p);
  return s;
}

std::string textOf(vec3 v) { return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z); }
nlohmann::ordered_json jsonOf(vec3 v) { return {v.x, v.y, v.z}; }

nlohmann::ordered_json jsonOf(const CapturePlacement& p) {
  nlohmann::ordered_json j = {{"unit_m", p.unit_m},
                              {"from", toText(p.from)},
                              {"origin", {p.origin.x, p.origin.y, p.origin.z}},
                              {"text", toText(p)}};
  if (p.height > 0) j["height"] = p.height;
  return j;
}

}  // namespace

CheckReport checkDescription(const fs::path& path, const ImportedCapture& capture) {
  CheckReport r;
  r.path = path.string();
  r.kind = "capture";
  r.layout = capture.layout;
  r.up = toText(capture.set.up);
  r.placement = capture.placement;
  r.frames = capture.set.frames;
  r.warnings = capture.warnings;
  r.seed_points = capture.set.seed_points.position_m.size();
  for (const View& v : capture.set.views) {
    r.cameras.push_back(
        {v.name, v.split == Split::Test, v.camera.width, v.camera.height, v.camera.intrinsics});
  }
  return r;
}

void checkPictures(const CaptureSet& set, CheckReport& r, Progress& progress) {
  std::vector<std::vector<std::string>> warnings(set.views.size());
  progress.expect(static_cast<std::int64_t>(set.views.size()));
  // Some cameras at once: progress is told between them, by this thread.
  const std::size_t at_once = std::max<std::size_t>(1, static_cast<std::size_t>(threadCount()));
  for (std::size_t first = 0; first < set.views.size(); first += at_once) {
    const std::size_t count = std::min(at_once, set.views.size() - first);
    parallelFor(count, 1, [&](std::size_t begin, std::size_t) {
      const std::size_t v = first + begin;
      r.cameras[v] = checkCamera(set, v, r.cameras[v], warnings[v], progress);
    });
    progress.step(static_cast<std::int64_t>(count));
  }
  for (const auto& w : warnings) r.warnings.insert(r.warnings.end(), w.begin(), w.end());
  if (set.masks == MaskKind::None)
    r.warnings.push_back("no masks: there will be no visual hull and no mask loss");
  warnOfForeignPictures(set, r.path, r.warnings);
  checkLight(set, r);
}

std::string refusalOf(const CheckReport& r) {
  if (r.kind != "capture") return {};
  const std::ptrdiff_t usable = std::count_if(
      r.cameras.begin(), r.cameras.end(), [](const CameraCheck& c) { return !c.held_out && c.frames > 0; });
  if (usable >= kLeastTrainingCameras) return {};
  return fmt::format(
      "\"{}\" cannot be processed: expected at least {} training cameras with pictures that can be used, "
      "found {}",
      r.path, kLeastTrainingCameras, usable);
}

CheckReport checkPath(const fs::path& path, const ImportOptions& options, Progress* progress) {
  if (fs::is_directory(path) || !fs::exists(path)) {
    const ImportedCapture capture = openCapture(path, options);
    CheckReport r = checkDescription(path, capture);
    Progress none;
    checkPictures(capture.set, r, progress ? *progress : none);
    return r;
  }
  CheckReport r;
  r.path = path.string();
  if (lowerCase(path.extension().string()) == ".ply") {
    r.kind = "splats";
    r.splats = checkSplats(path);
  } else {
    r.kind = "panorama";
    r.panorama = checkPanorama(path, r.warnings);
  }
  return r;
}

std::string toText(const CheckReport& r) {
  std::string t = fmt::format("{}: {}\n", r.kind, r.path);
  if (r.kind == "capture") {
    t += fmt::format(
        "layout: {}\nup axis: {}\nunit: {}\nframes: {} ({} to {})\nseed points: {}\ncameras: {}\n", r.layout,
        r.up, toText(r.placement), r.frames.size(), r.frames.empty() ? "-" : r.frames.front(),
        r.frames.empty() ? "-" : r.frames.back(), r.seed_points, r.cameras.size());
    for (const CameraCheck& c : r.cameras) {
      t += fmt::format("  {:<10} {} x {}  fx {:.1f} fy {:.1f} cx {:.1f} cy {:.1f}  frames {}  mask {}{}\n",
                       c.name, c.width, c.height, c.intrinsics.fx, c.intrinsics.fy, c.intrinsics.cx,
                       c.intrinsics.cy, c.frames,
                       c.mask_coverage < 0 ? "-" : fmt::format("{:.1f} %", 100 * c.mask_coverage),
                       c.held_out ? "  held out" : "");
    }
  }
  if (r.panorama) {
    t += fmt::format("panorama: {} x {}, mean radiance {}, brightest towards {}\n", r.panorama->width,
                     r.panorama->height, textOf(r.panorama->mean_radiance),
                     textOf(r.panorama->brightest_direction));
  }
  if (r.splats) {
    t += fmt::format("Gaussians: {}, SH degree {}, {}, from {} to {}\n", r.splats->count, r.splats->sh_degree,
                     r.splats->has_materials ? "with materials" : "without materials", textOf(r.splats->low),
                     textOf(r.splats->high));
  }
  t += fmt::format("warnings: {}", r.warnings.size());
  return t;
}

std::string toJson(const CheckReport& r) {
  nlohmann::ordered_json j;
  j["path"] = r.path;
  j["kind"] = r.kind;
  if (r.kind == "capture") {
    j["layout"] = r.layout;
    j["up"] = r.up;
    j["unit"] = jsonOf(r.placement);
    j["frames"] = r.frames;
    j["seed_points"] = r.seed_points;
    j["cameras"] = nlohmann::ordered_json::array();
    for (const CameraCheck& c : r.cameras) {
      nlohmann::ordered_json k = {{"name", c.name},        {"width", c.width},      {"height", c.height},
                                  {"fx", c.intrinsics.fx}, {"fy", c.intrinsics.fy}, {"cx", c.intrinsics.cx},
                                  {"cy", c.intrinsics.cy}, {"frames", c.frames},    {"held_out", c.held_out}};
      if (c.mask_coverage >= 0) k["mask_coverage"] = c.mask_coverage;
      j["cameras"].push_back(std::move(k));
    }
  }
  if (r.panorama) {
    j["panorama"] = {{"width", r.panorama->width},
                     {"height", r.panorama->height},
                     {"mean_radiance", jsonOf(r.panorama->mean_radiance)},
                     {"brightest_direction", jsonOf(r.panorama->brightest_direction)}};
  }
  if (r.splats) {
    j["splats"] = {{"count", r.splats->count},
                   {"sh_degree", r.splats->sh_degree},
                   {"has_materials", r.splats->has_materials},
                   {"low", jsonOf(r.splats->low)},
                   {"high", jsonOf(r.splats->high)}};
  }
  j["warnings"] = r.warnings;
  return j.dump(2, ' ', false, decltype(j)::error_handler_t::replace);
}

}  // namespace beam
