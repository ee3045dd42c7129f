// SPDX-License-Identifier: Apache-2.0
#include "core/scene/camera_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/scene/described_values.h"
#include "core/scene/lighting.h"

namespace beam {
namespace {

constexpr double kNarrowest_deg = 0.1, kWidest_deg = 170, kMostTurns_deg = 36'000, kFarthest_m = 1e9;

// Position, target, roll, field of view.
using Numbers = std::array<double, 8>;

Numbers numbersOf(const CameraKey& k) {
  const dvec3 &p = k.position_m, &t = k.target_m;
  return {p.x, p.y, p.z, t.x, t.y, t.z, k.roll_deg, k.fov_deg};
}

bool isCurveEasing(const std::string& easing) {
  return easing == "linear" || easing == "smooth" || easing == "step";
}

// Of the cubic through key i, per second: the chord of its neighbours; at an end that of the end.
Numbers slopeAt(const std::vector<CameraKey>& keys, std::size_t i) {
  const CameraKey& before = keys[i == 0 ? 0 : i - 1];
  const CameraKey& after = keys[std::min(i + 1, keys.size() - 1)];
  Numbers slope = numbersOf(after);
  const Numbers from = numbersOf(before);
  const double seconds = after.time_s - before.time_s;
  for (std::size_t n = 0; n < slope.size(); ++n) slope[n] = (slope[n] - from[n]) / seconds;
  return slope;
}

double shareOf(const std::string& easing, double u) {
  Curve unit{{{.time_s = 0, .value = 0, .easing = easing}, {.time_s = 1, .value = 1}}};
  return valueAt(unit, u);
}

Numbers between(const std::vector<CameraKey>& keys, std::size_t i, double time_s) {
  const CameraKey &key = keys[i], &next = keys[i + 1];
  const double seconds = next.time_s - key.time_s, u = (time_s - key.time_s) / seconds;
  const Numbers a = numbersOf(key), b = numbersOf(next);
  Numbers out;
  if (isCurveEasing(key.easing)) {
    const double share = shareOf(key.easing, u);
    for (std::size_t n = 0; n < out.size(); ++n) out[n] = std::lerp(a[n], b[n], share);
    return out;
  }
  const Numbers from = slopeAt(keys, i), to = slopeAt(keys, i + 1);
  const double u2 = u * u, u3 = u2 * u;
  for (std::size_t n = 0; n < out.size(); ++n) {
    out[n] = (2 * u3 - 3 * u2 + 1) * a[n] + (u3 - 2 * u2 + u) * seconds * from[n] + (3 * u2 - 2 * u3) * b[n] +
             (u3 - u2) * seconds * to[n];
  }
  return out;
}

}  // namespace

void describe(Fields& f, CameraKey& key) {
  f.field({.name = "time_s",
           .label = "Time",
           .help = "From the start of the film.",
           .min = -kFarthestTime_s,
           .max = kFarthestTime_s,
           .unit = "s"},
          key.time_s);
  describePosition(f, "position_m", {.name = "", .label = "Position", .help = "Where the camera is."},
                   key.position_m);
  describePosition(f, "target_m",
                   {.name = "", .label = "Target", .help = "What is in the middle of the picture."},
                   key.target_m);
  f.field({.name = "roll_deg",
           .label = "Roll",
           .help = "Counter-clockwise, seen from behind the camera.",
           .min = -kMostTurns_deg,
           .max = kMostTurns_deg,
           .unit = "degrees"},
          key.roll_deg);
  f.field({.name = "fov_deg",
           .label = "Field of view",
           .help = "From the top of the picture to its bottom.",
           .min = kNarrowest_deg,
           .max = kWidest_deg,
           .unit = "degrees"},
          key.fov_deg);
  f.field({.name = "easing",
           .label = "Easing",
           .help = "How the camera goes from this key to the next.",
           .choices = {"spline", "linear", "smooth", "step"}},
          key.easing);
}

void validate(const CameraTrack& track) {
  const std::vector<CameraKey>& keys = track.keys;
  if (keys.empty() || keys.size() > kMostKeys) {
    throw Error(Error::Kind::Data,
                fmt::format("keys: expected one to {} of them, found {}", kMostKeys, keys.size()));
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    try {
      validateFields(fieldsOf(keys[i]));
    } catch (const Error& e) {
      throw Error(e.kind(), fmt::format("keys[{}]: {}", i, e.what()));
    }
    const auto far_away = [](const dvec3& x_m) { return !(glm::length(x_m) <= kFarthest_m); };
    if (far_away(keys[i].position_m) || far_away(keys[i].target_m))
      throw Error(Error::Kind::Data,
                  fmt::format("keys[{}]: expected places up to {} m away", i, kFarthest_m));
    if (keys[i].position_m == keys[i].target_m)
      throw Error(Error::Kind::Data,
                  fmt::format("keys[{}]: expected a target away from the position, found the same", i));
    if (i > 0 && keys[i].time_s <= keys[i - 1].time_s) {
      throw Error(Error::Kind::Data, fmt::format("keys[{}]: expected a time after {} s, found {} s", i,
                                                 keys[i - 1].time_s, keys[i].time_s));
    }
  }
}

std::vector<std::string> remarks(const CameraTrack& track) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    const std::string& easing = track.keys[i].easing;
    if (easing != "spline" && !isCurveEasing(easing))
      found.push_back(fmt::format("keys[{}].easing is \"{}\", which this program does not know: spline holds",
                                  i, easing));
  }
  return found;
}

Camera cameraAt(const CameraTrack& track, double time_s, ivec2 size) {
  const std::vector<CameraKey>& keys = track.keys;
  const auto next = std::upper_bound(keys.begin(), keys.end(), time_s,
                                     [](double time, const CameraKey& k) { return time < k.time_s; });
  const Numbers n = next == keys.begin() ? numbersOf(*next)
                    : next == keys.end()
                        ? numbersOf(keys.back())
                        : between(keys, static_cast<std::size_t>(next - keys.begin()) - 1, time_s);
  const dvec3 position_m(n[0], n[1], n[2]);
  const dmat3 back = aimed(position_m, {n[3], n[4], n[5]}, n[6]);  // its +Y is up, its -Z ahead
  const Rigid3 world_from_camera{glm::normalize(glm::quat_cast(dmat3(back[0], -back[1], -back[2]))),
                                 position_m};
  const double focal =
      0.5 * size.y / std::tan(0.5 * glm::radians(std::clamp(n[7], kNarrowest_deg, kWidest_deg)));
  return {.intrinsics = {focal, focal, 0.5 * size.x, 0.5 * size.y},
          .width = size.x,
          .height = size.y,
          .camera_from_world = inverse(world_from_camera)};
}

Camera turnedAround(const Camera& camera, const dvec3& middle_m, double turn_rad) {
  const dquat turn = glm::angleAxis(turn_rad, dvec3(0, 1, 0));
  const Rigid3 world_from_camera = inverse(camera.camera_from_world);
  Camera turned = camera;
  turned.camera_from_world = inverse(Rigid3{glm::normalize(turn * world_from_camera.rotation),
                                            middle_m + turn * (world_from_camera.translation_m - middle_m)});
  return turned;
}

}  // namespace beam
