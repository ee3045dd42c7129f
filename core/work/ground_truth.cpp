// SPDX-License-Identifier: Apache-2.0
#include "core/work/ground_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/base/json_words.h"
#include "core/base/log.h"
#include "core/base/word_list.h"
#include "core/io/capture_description.h"
#include "core/io/file.h"
#include "core/io/image_file.h"
#include "core/io/mesh_ply.h"
#include "core/math/color.h"
#include "core/method/evaluate.h"
#include "core/scene/channel.h"
#include "core/scene/transform.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> findPicture(const fs::path& folder, const std::string& camera,
                                    const std::string& frame) {
  for (const char* e : {".exr", ".png"}) {
    const fs::path p = folder / camera / (frame + e);
    if (fs::exists(p)) return p;
  }
  return std::nullopt;
}

bool isExr(const fs::path& p) { return p.extension() == ".exr"; }

Planes fromPhoto(const fs::path& p, bool decode) {
  const Image<u8vec3> im = readPhoto(p);
  Planes out(im.width, im.height, 3);
  for (std::size_t i = 0; i < im.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float v = im.pixels[i][c] / 255.0f;
      out.plane(c)[i] = decode ? linearFromSrgb(v) : v;
    }
  }
  return out;
}

// Channels by what is stored: R G B, else the one there is.
Planes fromExr(const fs::path& p) {
  const std::vector<std::string> names = exrChannels(p);
  const bool rgb = std::find(names.begin(), names.end(), "R") != names.end();
  return rgb ? readExr(p, {"R", "G", "B"}) : readExr(p, {names.at(0)});
}

Planes asLinear(const fs::path& p) { return isExr(p) ? fromExr(p) : fromPhoto(p, true); }

Planes asValue(const fs::path& p) {
  const Planes in = isExr(p) ? fromExr(p) : fromPhoto(p, false);
  Planes out(in.width, in.height, 1);
  for (std::size_t i = 0; i < in.planeSize(); ++i) {
    for (int c = 0; c < in.channels; ++c) out.values[i] += in.plane(c)[i] / static_cast<float>(in.channels);
  }
  return out;
}

Planes asNormal(const fs::path& p) {
  if (isExr(p)) return fromExr(p);
  Planes out = fromPhoto(p, false);
  for (float& v : out.values) v = 2 * v - 1;
  return out;
}

Planes encoded(Planes p, const dvec3& scale = dvec3(1)) {
  for (int c = 0; c < p.channels; ++c) {
    for (std::size_t i = 0; i < p.planeSize(); ++i) {
      float& v = p.plane(c)[i];
      v = srgbFromLinear(std::clamp(static_cast<float>(v * scale[c]), 0.0f, 1.0f));
    }
  }
  return p;
}

Planes clipped(Planes p) {
  for (float& v : p.values) v = std::clamp(v, 0.0f, 1.0f);
  return p;
}

Planes scaled(Planes lengths, double factor) {
  if (factor == 1) return lengths;
  for (float& v : lengths.values) v = static_cast<float>(factor * v);
  return lengths;
}

Mesh inTruth(const Mesh& mesh, const GroundTruth& t) {
  return t.truth_from_capture == Similarity3{} ? mesh : transformed(mesh, t.truth_from_capture);
}

Mesh inMetres(const Mesh& mesh, const GroundTruth& t) {
  return t.unit_m == 1 ? mesh : transformed(mesh, {dmat3(1.0), t.unit_m});
}

struct Triple {
  std::string camera, frame;
  Planes prediction, truth;
  Image<std::uint8_t> mask;
};

std::vector<Triple> load(const GroundTruth& t, const fs::path& pictures, const std::string& what,
                         Planes (*reader)(const fs::path&), const Progress& progress) {
  std::vector<Triple> out;
  for (const std::string& camera : t.test_cameras) {
    for (const std::string& frame : what == "rgb" ? t.frames : t.gt_frames) {
      const auto p = findPicture(pictures / what, camera, frame),
                 g = findPicture(t.folder / "gt" / what, camera, frame);
      if (!p || !g) continue;
      progress.check();
      Triple triple{camera, frame, reader(*p), reader(*g),
                    readMask(t.folder / "gt/mask" / camera / (frame + ".png"))};
      if (triple.prediction.width != triple.truth.width || triple.prediction.height != triple.truth.height) {
        // Which may lie in a folder of the program: named as below it.
        throw Error(
            Error::Kind::Data,
            fmt::format("the picture {}: expected {} x {} pixels as \"{}\" has, found {} x {}",
                        p->lexically_relative(pictures).string(), triple.truth.width, triple.truth.height,
                        g->string(), triple.prediction.width, triple.prediction.height));
      }
      out.push_back(std::move(triple));
    }
  }
  return out;
}

template <class Prepare>
Scores meanScores(const std::string& what, const std::vector<Triple>& triples, const Progress& progress,
                  PictureScores& each, Prepare&& prepare) {
  Scores s;
  std::vector<PictureScore> all;
  for (const Triple& t : triples) {
    all.push_back(scorePicture(prepare(t.prediction, true), prepare(t.truth, false), t.mask, progress));
    progress.check();
    put(all.back(), fmt::format("{}.", what), each[t.frame][t.camera]);
  }
  put(meanOf(all), "", s);
  s["pictures"] = static_cast<double>(triples.size());
  return s;
}

// Folders of pictures, in order of the evaluator.
std::vector<std::string> mapsOf(const GroundTruth& t) {
  std::vector<std::string> maps = {"rgb", "base_color", "ao", "roughness", "normal", "depth"};
  for (const std::string& e : t.environments) maps.push_back(fmt::format("{}_{}", kRelightChannel, e));
  return maps;
}

void requireMask(const GroundTruth& t, const View& view, const std::string& frame) {
  const fs::path mask = t.folder / "gt/mask" / view.name / (frame + ".png");
  if (!fs::exists(mask))
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\" is not there: no picture of camera {} and frame {} can "
                            "be scored without its mask",
                            mask.string(), view.name, frame));
  const ImageSize size = readImageSize(mask);
  if (size.width == view.camera.width && size.height == view.camera.height) return;
  throw Error(
      Error::Kind::Data,
      fmt::format("\"{}\": expected {} x {} pixels as camera {} of the project has, found {} x {}; the "
                  "ground truth is not of this capture",
                  mask.string(), view.camera.width, view.camera.height, view.name, size.width, size.height));
}

// One factor a channel, least squares over all mask pixels of all pictures, linear.
dvec3 channelScale(const std::vector<Triple>& triples) {
  dvec3 product(0), square(0);
  for (const Triple& t : triples) {
    for (int c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < t.truth.planeSize(); ++i) {
        if (t.mask.pixels[i] <= 127) continue;
        const double p = t.prediction.plane(c)[i];
        product[c] += p * t.truth.plane(c)[i];
        square[c] += p * p;
      }
    }
  }
  return product / glm::max(square, dvec3(1e-12));
}

void scoreColors(const GroundTruth& t, const fs::path& pictures, const std::string& what,
                 const Progress& progress, ScoreTable& out, PictureScores& each) {
  const std::vector<Triple> triples = load(t, pictures, what, asLinear, progress);
  if (triples.empty()) return;
  out.emplace_back(
      what, meanScores(what, triples, progress, each, [](const Planes& p, bool) { return encoded(p); }));
  if (what == "rgb") return;
  const dvec3 scale = channelScale(triples);
  out.emplace_back(what + "_scaled", meanScores(what + "_scaled", triples, progress, each,
                                                [&](const Planes& p, bool prediction) {
                                                  return encoded(p, prediction ? scale : dvec3(1));
                                                }));
}

void scoreMeshes(const GroundTruth& t, const fs::path& pictures, const Progress& progress, ScoreTable& out,
                 PictureScores& each) {
  Scores sum;
  double n = 0;
  for (const std::string& frame : t.gt_frames) {
    const fs::path p = pictures / "mesh" / (frame + ".ply"), g = t.folder / "gt/mesh" / (frame + ".ply");
    if (!fs::exists(p) || !fs::exists(g)) continue;
    const Chamfer c =
        chamferDistance(inMetres(inTruth(readMeshPly(p), t), t), inMetres(readMeshPly(g), t), progress);
    progress.check();
    sum["chamfer_mm"] += c.chamfer_mm;
    sum["pred_to_gt_mm"] += c.prediction_to_truth_mm;
    sum["gt_to_pred_mm"] += c.truth_to_prediction_mm;
    each[frame][""]["mesh.chamfer_mm"] = c.chamfer_mm;
    ++n;
  }
  if (n == 0) return;
  for (auto& [key, value] : sum) value /= n;
  sum["pictures"] = n;
  out.emplace_back("mesh", sum);
}

// Mean over the environments, as the evaluator's relight_mean.
void addRelightMean(ScoreTable& table, bool scaled) {
  Scores mean;
  double rows = 0;
  for (const auto& [name, s] : table) {
    if (name.rfind("relight_", 0) != 0 || name.ends_with("_scaled") != scaled) continue;
    for (const char* k : {"psnr", "ssim", "psnr_mask", "pictures"})
      if (s.contains(k)) mean[k] += s.at(k);
    ++rows;
  }
  if (rows < 2) return;
  for (const char* k : {"psnr", "ssim", "psnr_mask"})
    if (mean.contains(k)) mean[k] /= rows;
  table.emplace_back(scaled ? "relight_mean_scaled" : "relight_mean", mean);
}

std::vector<std::string> strings(const nlohmann::json& j, const char* key) {
  return j.contains(key) ? j[key].get<std::vector<std::string>>() : std::vector<std::string>{};
}

// None where the description tells of no cameras: pictures alone can be scored.
std::vector<DescribedCamera> camerasOf(const fs::path& folder) {
  try {
    const std::optional<CaptureDescription> described = readDatasetJson(folder);
    return described ? described->cameras : std::vector<DescribedCamera>();
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

GroundTruth openGroundTruth(const fs::path& folder) {
  const fs::path file = folder / "dataset.json";
  if (!fs::is_directory(folder / "gt") || !fs::exists(file)) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": expected a data set with dataset.json and gt/", folder.string()));
  }
  try {
    const nlohmann::json j = nlohmann::json::parse(readTextFile(file));
    GroundTruth t{folder, strings(j, "test_cameras"), strings(j, "frame_names"), strings(j, "gt_frames"),
                  strings(j, "relight_environments")};
    return t;
  } catch (const nlohmann::json::exception& e) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\" cannot be understood: {}", file.string(), jsonComplaint(e)));
  }
}

void align(GroundTruth& truth, const CaptureSet& capture) {
  constexpr double kSame = 1e-6, kFits = 1e-3;  // of the cameras' spread
  const Similarity3 capture_from_world = capture.capture_from_world;
  truth.unit_m = inverse(capture_from_world).scale;
  std::vector<std::pair<dvec3, dvec3>> pairs;  // centres: of the capture, of the data set
  const std::vector<DescribedCamera> true_cameras = camerasOf(truth.folder);
  for (const View& view : capture.views) {
    for (const DescribedCamera& c : true_cameras)
      if (c.name == view.name)
        pairs.emplace_back(centerOf(transformed(view.camera, capture_from_world)), centerOf(c.camera));
  }
  if (pairs.size() < 2) return;
  dvec3 middle(0), true_middle(0);
  for (const auto& [here, there] : pairs) middle += here, true_middle += there;
  middle /= static_cast<double>(pairs.size()), true_middle /= static_cast<double>(pairs.size());
  double spread = 0, true_spread = 0;
  for (const auto& [here, there] : pairs)
    spread += glm::distance(here, middle), true_spread += glm::distance(there, true_middle);
  const double scale = true_spread / spread;
  const Similarity3 found{dmat3(1.0), scale, true_middle - scale * middle};
  if (!std::isfinite(scale) || !(scale > 0)) return;
  const double size = true_spread / static_cast<double>(pairs.size());
  const bool fits = std::all_of(pairs.begin(), pairs.end(), [&](const auto& p) {
    return glm::distance(found * p.first, p.second) < kFits * size;
  });
  const bool same = std::abs(scale - 1) < kSame && glm::length(found.translation) < kSame * size;
  if (!fits) {
    logWarning(
        "the cameras of \"{}\" stand otherwise than those of the same names in the project: is it the "
        "ground truth of this capture?",
        truth.folder.string());
  }
  if (!fits || same) return;
  truth.truth_from_capture = found;
  truth.unit_m /= scale;
}

void keepFrames(GroundTruth& truth, const std::vector<std::string>& names) {
  std::vector<std::string> before = truth.frames;
  before.insert(before.end(), truth.gt_frames.begin(), truth.gt_frames.end());
  const auto other = [&](const std::string& frame) {
    return std::find(names.begin(), names.end(), frame) == names.end();
  };
  std::erase_if(truth.frames, other);
  std::erase_if(truth.gt_frames, other);
  if (!truth.frames.empty() || !truth.gt_frames.empty()) return;
  std::sort(before.begin(), before.end());
  before.erase(std::unique(before.begin(), before.end()), before.end());
  throw Error(
      Error::Kind::Data,
      fmt::format("\"{}\" has ground truth of none of the frames {}: it has {}", truth.folder.string(),
                  shortList(names), before.empty() ? std::string("none at all") : shortList(before)));
}

void requireFits(const GroundTruth& t, const std::vector<View>& views) {
  bool some = std::any_of(t.gt_frames.begin(), t.gt_frames.end(), [&](const std::string& frame) {
    return fs::exists(t.folder / "gt/mesh" / (frame + ".ply"));
  });
  for (const std::string& what : mapsOf(t)) {
    for (const View& view : views) {
      for (const std::string& frame : what == "rgb" ? t.frames : t.gt_frames) {
        if (!findPicture(t.folder / "gt" / what, view.name, frame)) continue;
        requireMask(t, view, frame);
        some = true;
      }
    }
  }
  if (some) return;
  throw Error(
      Error::Kind::Data,
      fmt::format("\"{}\" has no ground truth of the frames and cameras that are scored; expected "
                  "files such as gt/rgb/{}/{}.png",
                  t.folder.string(), views.at(0).name, (t.frames.empty() ? t.gt_frames : t.frames).at(0)));
}

bool hasPictures(const GroundTruth& t, const fs::path& pictures) {
  const std::vector<std::string> maps = mapsOf(t);
  return std::any_of(maps.begin(), maps.end(),
                     [&](const std::string& map) { return fs::is_directory(pictures / map); });
}

ScoreTable scorePictures(const GroundTruth& t, const fs::path& pictures, Progress& progress,
                         PictureScores& each) {
  ScoreTable out;
  progress.expect(static_cast<std::int64_t>(7 + t.environments.size()));
  for (const char* what : {"rgb", "base_color"})
    scoreColors(t, pictures, what, progress, out, each), progress.step();
  for (const char* what : {"ao", "roughness"}) {
    const std::vector<Triple> triples = load(t, pictures, what, asValue, progress);
    if (!triples.empty())
      out.emplace_back(
          what, meanScores(what, triples, progress, each, [](const Planes& p, bool) { return clipped(p); }));
    progress.step();
  }
  if (const std::vector<Triple> triples = load(t, pictures, "normal", asNormal, progress); !triples.empty()) {
    Scores s{{"angle_deg", 0}, {"pictures", static_cast<double>(triples.size())}};
    for (const Triple& n : triples) {
      const double angle = normalErrorDeg(n.prediction, n.truth, n.mask);
      each[n.frame][n.camera]["normal.angle_deg"] = angle;
      s["angle_deg"] += angle / s["pictures"];
    }
    out.emplace_back("normal", s);
  }
  progress.step();
  if (const std::vector<Triple> triples = load(t, pictures, "depth", asValue, progress); !triples.empty()) {
    Scores s{{"mae_mm", 0}, {"pictures", static_cast<double>(triples.size())}};
    for (const Triple& d : triples) {
      const double error = depthErrorMm(scaled(d.prediction, t.unit_m * t.truth_from_capture.scale),
                                        scaled(d.truth, t.unit_m), d.mask);
      each[d.frame][d.camera]["depth.mae_mm"] = error;
      s["mae_mm"] += error / s["pictures"];
    }
    out.emplace_back("depth", s);
  }
  progress.step();
  for (const std::string& e : t.environments)
    scoreColors(t, pictures, "relight_" + e, progress, out, each), progress.step();
  scoreMeshes(t, pictures, progress, out, each);
  progress.step();
  addRelightMean(out, false);
  addRelightMean(out, true);
  if (out.empty()) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": nothing to score against \"{}\"; expected folders such as "
                            "rgb/<test camera>/<frame>.png",
                            pictures.string(), t.folder.string()));
  }
  return out;
}

}  // namespace beam
