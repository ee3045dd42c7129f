// SPDX-License-Identifier: Apache-2.0
// COLMAP sparse models as its documentation of output formats has them, binary before text. Pinhole kinds
// only.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <set>
#include <sstream>

#include "core/base/error.h"
#include "core/io/capture_description.h"
#include "core/io/file.h"

namespace beam {
namespace {

constexpr std::uint64_t kMaxFile = 4ull << 30;

struct ModelKind {
  const char* name;
  int parameters;
};
constexpr std::array<ModelKind, 18> kModels = {{{"SIMPLE_PINHOLE", 3},
                                                {"PINHOLE", 4},
                                                {"SIMPLE_RADIAL", 4},
                                                {"RADIAL", 5},
                                                {"OPENCV", 8},
                                                {"OPENCV_FISHEYE", 8},
                                                {"FULL_OPENCV", 12},
                                                {"FOV", 5},
                                                {"SIMPLE_RADIAL_FISHEYE", 4},
                                                {"RADIAL_FISHEYE", 5},
                                                {"THIN_PRISM_FISHEYE", 12},
                                                {"RAD_TAN_THIN_PRISM_FISHEYE", 16},
                                                {"SIMPLE_DIVISION", 4},
                                                {"DIVISION", 5},
                                                {"SIMPLE_FISHEYE", 3},
                                                {"FISHEYE", 4},
                                                {"EUCM", 6},
                                                {"EQUIRECTANGULAR", 2}}};

struct ColmapCamera {
  Intrinsics intrinsics;
  int width = 0, height = 0;
};
struct ColmapImage {
  std::uint32_t id = 0, camera = 0;
  Rigid3 camera_from_world;
  std::string name;
};
struct ColmapModel {
  std::map<std::uint32_t, ColmapCamera> cameras;
  std::vector<ColmapImage> images;
  std::map<std::uint32_t, std::string> camera_of_image;  // by image id
  std::vector<dvec3> points;
  std::vector<u8vec3> colors;
};

[[noreturn]] void bad(const std::filesystem::path& path, const std::string& what) {
  throw Error(Error::Kind::Data, fmt::format("\"{}\": {}", path.string(), what));
}

// Models 0 to 4 and 6 are pinholes with (fx fy or one f) cx cy first and distortion behind; distortion 0 is
// what undistorters that keep the model write.
Intrinsics pinholeOf(const std::filesystem::path& path, std::uint32_t id, int model,
                     const std::vector<double>& p) {
  const bool one_focal = model == 0 || model == 2 || model == 3;
  const bool perspective = model <= 4 || model == 6;
  const auto distortion = p.begin() + (one_focal ? 3 : 4);
  if (!perspective || std::any_of(distortion, p.end(), [](double v) { return v != 0; })) {
    bad(path, fmt::format("camera {} has the model {}; only SIMPLE_PINHOLE and PINHOLE are supported yet: "
                          "undistort the pictures (colmap image_undistorter) and use that model",
                          id, kModels[model].name));
  }
  return one_focal ? Intrinsics{p[0], p[0], p[1], p[2]} : Intrinsics{p[0], p[1], p[2], p[3]};
}

void addCamera(ColmapModel& m, const std::filesystem::path& path, std::uint32_t id, int model, double w,
               double h, const std::vector<double>& p) {
  if (!(w >= 1 && w <= 65536 && h >= 1 && h <= 65536))
    bad(path, fmt::format("camera {} has the size {} x {}", id, w, h));
  for (const double v : p) {
    if (!std::isfinite(v)) bad(path, fmt::format("camera {}: expected finite parameters, found {}", id, v));
  }
  const ColmapCamera c{pinholeOf(path, id, model, p), static_cast<int>(w), static_cast<int>(h)};
  if (!(c.intrinsics.fx > 0 && c.intrinsics.fy > 0)) {
    bad(path, fmt::format("camera {}: expected a positive focal length, found {} and {}", id, c.intrinsics.fx,
                          c.intrinsics.fy));
  }
  if (!m.cameras.emplace(id, c).second) bad(path, fmt::format("camera id {} stands twice", id));
}

// A name may be a camera folder, camera/frame.ext, or a plain file: tools write all three.
std::string cameraNameOf(const std::string& image_name) {
  const std::filesystem::path name(image_name);
  if (!isPicture(name)) return image_name;
  return name.has_parent_path() ? name.parent_path().string() : name.stem().string();
}

struct ImageRecord {
  std::uint32_t id = 0, camera = 0;
  std::array<double, 7> pose{};  // qw qx qy qz tx ty tz
  std::string name;
};

void addImage(ColmapModel& m, const std::filesystem::path& path, const ImageRecord& r) {
  requirePlainName(r.name, fmt::format("\"{}\"", path.string()));
  for (const double v : r.pose) {
    if (!std::isfinite(v)) bad(path, fmt::format("image \"{}\" has a pose that is not finite", r.name));
  }
  const dquat q(r.pose[0], r.pose[1], r.pose[2], r.pose[3]);
  const double norm = std::sqrt(glm::dot(q, q));
  if (std::abs(norm - 1) > 1e-2)
    bad(path, fmt::format("image \"{}\": expected a unit quaternion, its norm is {}", r.name, norm));
  if (!m.cameras.contains(r.camera))
    bad(path, fmt::format("image \"{}\" names camera {}, which is not there", r.name, r.camera));
  if (!m.camera_of_image.emplace(r.id, cameraNameOf(r.name)).second)
    bad(path, fmt::format("image id {} stands twice", r.id));
  m.images.push_back({r.id, r.camera, {q / norm, dvec3(r.pose[4], r.pose[5], r.pose[6])}, r.name});
}

// Points that fewer than two cameras see are dropped; a track may name images that are gone.
void addPoint(ColmapModel& m, dvec3 x, u8vec3 color, const std::set<std::uint32_t>& track) {
  std::set<std::string> seen_by;
  for (const std::uint32_t image : track) {
    const auto found = m.camera_of_image.find(image);
    if (found != m.camera_of_image.end()) seen_by.insert(found->second);
    if (seen_by.size() == 2) break;
  }
  if (seen_by.size() < 2 || !std::isfinite(x.x + x.y + x.z)) return;
  m.points.push_back(x);
  m.colors.push_back(color);
}

class BinaryReader {
 public:
  explicit BinaryReader(const std::filesystem::path& path) : path_(path), bytes_(readFile(path, kMaxFile)) {}
  template <class T>
  T get() {
    if (at_ + sizeof(T) > bytes_.size()) bad(path_, "the file ends early; it is truncated");
    T v;
    std::memcpy(&v, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return v;
  }
  // A count whose entries take at least `least` bytes each: checked against what is left before anything is
  // allocated.
  std::uint64_t count(std::size_t least, const char* what) {
    const auto n = get<std::uint64_t>();
    const std::uint64_t left = bytes_.size() - at_;
    if (n > left / least)
      bad(path_, fmt::format("the file announces {} {}, {} bytes are left; it is damaged", n, what, left));
    return n;
  }
  std::string text() {
    std::string s;
    while (const char c = get<char>()) {
      if (s.size() > 4096) bad(path_, "a name is longer than 4096 bytes");
      s += c;
    }
    return s;
  }
  void skip(std::size_t bytes) { at_ += bytes; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
};

ColmapModel readBinary(const std::filesystem::path& folder) {
  ColmapModel m;
  BinaryReader c(folder / "cameras.bin");
  for (std::uint64_t n = c.count(24, "cameras"); n > 0; --n) {
    const auto id = c.get<std::uint32_t>();
    const auto model = c.get<std::int32_t>();
    if (model < 0 || model >= static_cast<int>(kModels.size()))
      bad(c.path(), fmt::format("unknown camera model {}", model));
    const auto w = c.get<std::uint64_t>(), h = c.get<std::uint64_t>();
    std::vector<double> p(kModels[model].parameters);
    for (double& v : p) v = c.get<double>();
    addCamera(m, c.path(), id, model, static_cast<double>(w), static_cast<double>(h), p);
  }
  BinaryReader i(folder / "images.bin");
  for (std::uint64_t n = i.count(73, "images"); n > 0; --n) {
    ImageRecord r;
    r.id = i.get<std::uint32_t>();
    for (double& v : r.pose) v = i.get<double>();
    r.camera = i.get<std::uint32_t>();
    r.name = i.text();
    i.skip(i.count(24, "points of an image") * 24);
    addImage(m, i.path(), r);
  }
  if (!std::filesystem::exists(folder / "points3D.bin")) return m;
  BinaryReader p(folder / "points3D.bin");
  for (std::uint64_t n = p.count(51, "points"); n > 0; --n) {
    p.get<std::uint64_t>();
    dvec3 x;
    for (int k = 0; k < 3; ++k) x[k] = p.get<double>();
    u8vec3 color;
    for (int k = 0; k < 3; ++k) color[k] = p.get<std::uint8_t>();
    p.get<double>();
    std::set<std::uint32_t> seen;
    for (std::uint64_t t = p.count(8, "observations of a point"); t > 0; --t) {
      seen.insert(p.get<std::uint32_t>());
      p.get<std::uint32_t>();
    }
    addPoint(m, x, color, seen);
  }
  return m;
}

// Lines of a text file without comments; empty lines are kept (an image may have no points).
std::vector<std::string> linesOf(const std::filesystem::path& path) {
  std::istringstream in(readTextFile(path, kMaxFile));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line[0] != '#') lines.push_back(line);
  }
  return lines;
}

// Streams refuse "nan", which then could not be named; a word that is no number counts as one.
double numberIn(std::istream& in) {
  std::string word;
  in >> word;
  char* end = nullptr;
  const double v = std::strtod(word.c_str(), &end);
  return word.empty() || *end != '\0' ? std::nan("") : v;
}

void readTextCameras(ColmapModel& m, const std::filesystem::path& path) {
  for (const std::string& line : linesOf(path)) {
    if (line.empty()) continue;
    std::istringstream in(line);
    std::uint32_t id = 0;
    std::string name;
    double w = 0, h = 0;
    in >> id >> name >> w >> h;
    int model = -1;
    for (int k = 0; k < static_cast<int>(kModels.size()); ++k) {
      if (name == kModels[k].name) model = k;
    }
    if (!in || model < 0) bad(path, fmt::format("cannot understand the camera \"{}\"", line));
    std::vector<double> p;
    while (in >> std::ws && in.peek() != std::istringstream::traits_type::eof()) p.push_back(numberIn(in));
    if (static_cast<int>(p.size()) != kModels[model].parameters) {
      bad(path, fmt::format("camera {}: expected {} parameters, found {}", id, kModels[model].parameters,
                            p.size()));
    }
    addCamera(m, path, id, model, w, h, p);
  }
}

void readTextImages(ColmapModel& m, const std::filesystem::path& path) {
  const std::vector<std::string> lines = linesOf(path);
  for (std::size_t i = 0; i < lines.size(); i += 2) {  // every second line lists points
    while (i < lines.size() && lines[i].empty()) ++i;
    if (i >= lines.size()) break;
    std::istringstream in(lines[i]);
    ImageRecord r;
    in >> r.id;
    for (double& v : r.pose) v = numberIn(in);
    in >> r.camera;
    std::getline(in >> std::ws, r.name);  // a name runs to the end of its line, blanks and all
    if (r.name.empty()) bad(path, fmt::format("cannot understand the image \"{}\"", lines[i]));
    addImage(m, path, r);
  }
}

ColmapModel readText(const std::filesystem::path& folder) {
  ColmapModel m;
  readTextCameras(m, folder / "cameras.txt");
  readTextImages(m, folder / "images.txt");
  if (!std::filesystem::exists(folder / "points3D.txt")) return m;
  for (const std::string& line : linesOf(folder / "points3D.txt")) {
    std::istringstream in(line);
    std::uint64_t id = 0;
    dvec3 x(0);
    int r = 0, g = 0, b = 0;
    double error = 0;
    if (!(in >> id >> x.x >> x.y >> x.z >> r >> g >> b >> error)) continue;
    std::set<std::uint32_t> seen;
    for (std::uint32_t image = 0, point = 0; in >> image >> point;) seen.insert(image);
    addPoint(m, x, u8vec3(r, g, b), seen);
  }
  return m;
}

void addPictures(CaptureDescription& d, const ColmapModel& m, const std::filesystem::path& pictures,
                 const std::filesystem::path& model_folder) {
  std::map<std::string, std::size_t> index;
  for (const ColmapImage& i : m.images) {
    const std::string& name = m.camera_of_image.at(i.id);
    const std::filesystem::path file = pictures / i.name, relative(i.name);
    std::map<std::string, std::filesystem::path> found;
    if (std::filesystem::is_directory(file)) {
      found = picturesIn(file);
    } else if (isPicture(file)) {
      found[relative.has_parent_path() ? relative.stem().string() : "000000"] = file;
    }
    const ColmapCamera& c = m.cameras.at(i.camera);
    const Camera camera{c.intrinsics, c.width, c.height, i.camera_from_world};
    const auto [place, fresh] = index.emplace(name, d.cameras.size());
    if (fresh) d.cameras.push_back({name, camera, Split::Train, {}, {}});
    DescribedCamera& described = d.cameras[place->second];
    addPose(described, camera, fmt::format("\"{}\"", model_folder.string()));
    described.pictures.insert(found.begin(), found.end());
  }
}

struct ModelPlace {
  std::filesystem::path folder;
  bool binary = false;
};

constexpr const char* kModelPlaces[] = {"sparse/0", "sparse", "colmap/sparse/0", "."};
constexpr const char* kEndings[] = {".bin", ".txt"};

std::optional<ModelPlace> findModel(const std::filesystem::path& folder) {
  for (const char* place : kModelPlaces) {
    const std::filesystem::path model = folder / place;
    for (const std::string ending : kEndings)
      if (isThere(model / ("cameras" + ending)) && isThere(model / ("images" + ending)))
        return ModelPlace{model, ending == kEndings[0]};
  }
  return std::nullopt;
}

}  // namespace

bool hasColmapModel(const std::filesystem::path& folder) { return findModel(folder).has_value(); }

std::string halfColmapModel(const std::filesystem::path& folder) {
  if (hasColmapModel(folder)) return {};
  for (const char* place : kModelPlaces) {
    std::vector<std::string> found, missing;
    for (const char* part : {"cameras", "images"}) {
      const std::filesystem::path stem = std::filesystem::path(place) / part;
      const auto ending = std::find_if(std::begin(kEndings), std::end(kEndings),
                                       [&](const char* e) { return isThere(folder / (stem.string() + e)); });
      if (ending == std::end(kEndings))
        missing.emplace_back(part);
      else
        found.push_back(stem.lexically_normal().string() + *ending);
    }
    if (found.empty()) continue;
    if (!missing.empty())
      return fmt::format("has half of a COLMAP model: {} without {}.bin or {}.txt beside it", found.front(),
                         missing.front(), missing.front());
    return fmt::format(
        "has parts of two COLMAP models: {} and {}, of which one has to be written as the other", found[0],
        found[1]);
  }
  return {};
}

std::optional<CaptureDescription> readColmapModel(const std::filesystem::path& folder) {
  const std::optional<ModelPlace> place = findModel(folder);
  if (!place) return std::nullopt;
  const ColmapModel m = place->binary ? readBinary(place->folder) : readText(place->folder);
  CaptureDescription d;
  d.layout = place->binary ? "COLMAP binary" : "COLMAP text";
  d.name = folder.filename().string();
  const std::filesystem::path pictures = folder / "images";
  addPictures(d, m, std::filesystem::is_directory(pictures) ? pictures : folder, place->folder);
  d.points = pointCloudOf(m.points, m.colors);
  return d;
}

}  // namespace beam
