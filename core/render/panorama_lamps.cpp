// SPDX-License-Identifier: Apache-2.0
#include "core/render/panorama_lamps.h"

#include <algorithm>
#include <cmath>

#include "core/math/color.h"
#include "core/scene/environment.h"

namespace beam {
namespace {

constexpr float kBright = 20;                  // times the mean
constexpr double kLeastShare = 0.03;           // of the mean irradiance, on what faces it
constexpr float kWidest_rad = 12 * kPi / 180;  // half the angle of one lamp
constexpr std::size_t kMostPieces = 4096;      // of one bright place

struct Texel {
  std::size_t at = 0;
  vec3 direction{0};
  vec3 flux{0};  // above the mean, x solid angle
};
using Piece = std::vector<Texel>;

double solidAngleOf(const Image<vec3>& panorama, int row) {
  const double top = std::cos(kPi * row / panorama.height),
               bottom = std::cos(kPi * (row + 1.0) / panorama.height);
  return 2 * kPi / panorama.width * (top - bottom);
}

float meanLuminance(const Image<vec3>& panorama) {
  double sum = 0;
  for (int y = 0; y < panorama.height; ++y) {
    double row = 0;
    for (int x = 0; x < panorama.width; ++x) row += luminance(panorama(x, y));
    sum += row * solidAngleOf(panorama, y);
  }
  return static_cast<float>(sum / (4 * kPi));
}

// Neighbours over the corners, across the seam and the poles.
class BrightPlaces {
 public:
  BrightPlaces(const Image<vec3>& panorama, float mean)
      : panorama_(panorama), mean_(mean), open_(panorama.pixels.size()) {
    for (std::size_t i = 0; i < open_.size(); ++i) open_[i] = luminance(panorama.pixels[i]) > kBright * mean;
  }

  std::vector<Piece> all(const Progress& progress) {
    std::vector<Piece> places;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      if (!open_[i]) continue;
      progress.check();
      places.push_back(placeAround(i));
    }
    return places;
  }

 private:
  Texel texelAt(std::size_t i) const {
    const int w = panorama_.width, x = static_cast<int>(i) % w, y = static_cast<int>(i) / w;
    const vec3 light = panorama_.pixels[i];
    const float above = 1 - mean_ / luminance(light);
    return {i, directionFromLatLong({(x + 0.5f) / w, (y + 0.5f) / panorama_.height}),
            static_cast<float>(above * solidAngleOf(panorama_, y)) * light};
  }

  Piece placeAround(std::size_t first) {
    Piece place;
    std::vector<std::size_t> todo{first};
    open_[first] = false;
    const int w = panorama_.width, h = panorama_.height;
    const auto meet = [&](int x, int y) {
      const std::size_t i = panorama_.index((x + w) % w, y);
      if (!open_[i]) return;
      open_[i] = false;
      todo.push_back(i);
    };
    while (!todo.empty()) {
      const std::size_t i = todo.back();
      todo.pop_back();
      place.push_back(texelAt(i));
      const int x = static_cast<int>(i) % w, y = static_cast<int>(i) / w;
      for (int j = std::max(0, y - 1); j <= std::min(h - 1, y + 1); ++j)
        for (int k = x - 1; k <= x + 1; ++k) meet(k, j);
      if (y == 0 || y == h - 1)
        for (int k = 0; k < w; ++k) meet(k, y);
    }
    return place;
  }

  const Image<vec3>& panorama_;
  float mean_;
  std::vector<char> open_;
};

// The mean direction is that of the vector irradiance: where all of it is above a surface, its light on that
// surface is the lamp's. The angle is that of an even disc with the same second moment.
LightSource lampOf(const Piece& piece) {
  dvec3 flux(0), toward(0);
  for (const Texel& t : piece) {
    flux += dvec3(t.flux);
    toward += static_cast<double>(luminance(t.flux)) * dvec3(t.direction);
  }
  const double all = luminance(vec3(flux)), length = glm::length(toward);
  if (length == 0) return {.far = true, .half_angle_rad = kPi};
  LightSource lamp{.far = true, .toward = vec3(toward / length), .strength = vec3(flux * (length / all))};
  double moment = 0;
  for (const Texel& t : piece) {
    const double angle = std::acos(std::clamp(glm::dot(t.direction, lamp.toward), -1.0f, 1.0f));
    moment += luminance(t.flux) * angle * angle;
  }
  lamp.half_angle_rad = static_cast<float>(std::sqrt(2 * moment / all));
  return lamp;
}

// The axis across `toward` along which the piece is longest, of the covariance of what lies across.
vec3 longAxisOf(const Piece& piece, vec3 toward) {
  const vec3 side =
      glm::normalize(glm::cross(std::abs(toward.y) > 0.9f ? vec3(1, 0, 0) : vec3(0, 1, 0), toward));
  const vec3 up = glm::cross(toward, side);
  double xx = 0, xy = 0, yy = 0;
  for (const Texel& t : piece) {
    const double weight = luminance(t.flux), x = glm::dot(t.direction, side), y = glm::dot(t.direction, up);
    xx += weight * x * x, xy += weight * x * y, yy += weight * y * y;
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  return static_cast<float>(std::cos(angle)) * side + static_cast<float>(std::sin(angle)) * up;
}

std::vector<Piece> narrowPieces(Piece place) {
  std::vector<Piece> narrow, wide;
  wide.push_back(std::move(place));
  while (!wide.empty()) {
    Piece piece = std::move(wide.back());
    wide.pop_back();
    const LightSource lamp = lampOf(piece);
    const bool fits = lamp.half_angle_rad <= kWidest_rad || piece.size() == 1;
    if (fits || narrow.size() + wide.size() > kMostPieces) {
      narrow.push_back(std::move(piece));
      continue;
    }
    const vec3 axis = longAxisOf(piece, lamp.toward);
    const auto other = std::stable_partition(piece.begin(), piece.end(), [&](const Texel& t) {
      return glm::dot(t.direction - lamp.toward, axis) < 0;
    });
    if (other == piece.begin() || other == piece.end()) {
      narrow.push_back(std::move(piece));
      continue;
    }
    wide.emplace_back(other, piece.end());
    piece.erase(other, piece.end());
    wide.push_back(std::move(piece));
  }
  return narrow;
}

}  // namespace

SplitPanorama splitPanorama(const Image<vec3>& panorama, const Progress& progress) {
  const float mean = meanLuminance(panorama);
  if (!(mean > 0)) return {};
  struct Found {
    LightSource lamp;
    Piece piece;
  };
  std::vector<Found> found;
  for (Piece& place : BrightPlaces(panorama, mean).all(progress)) {
    for (Piece& piece : narrowPieces(std::move(place))) {
      LightSource lamp = lampOf(piece);
      if (luminance(lamp.strength) >= kLeastShare * kPi * mean && lamp.half_angle_rad <= kWidest_rad)
        found.push_back({lamp, std::move(piece)});
    }
  }
  if (found.empty()) return {};
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return luminance(a.lamp.strength) > luminance(b.lamp.strength);
  });
  if (found.size() > kMostPanoramaLamps) found.resize(kMostPanoramaLamps);
  SplitPanorama split{{}, panorama};
  for (const Found& f : found) {
    split.lamps.push_back(f.lamp);
    for (const Texel& t : f.piece) split.rest.pixels[t.at] *= mean / luminance(panorama.pixels[t.at]);
  }
  return split;
}

}  // namespace beam
