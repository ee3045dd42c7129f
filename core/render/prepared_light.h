// SPDX-License-Identifier: Apache-2.0
// A panorama prepared for shading, as plain data that a shader can read as well: irradiance, radiance
// filtered by roughness, split-sum table. Preparing takes a moment (parallel); shading many views does not.
// Turning the light (yaw) needs no new preparation.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "core/render/light_transfer.h"
#include "core/scene/environment.h"
#include "core/scene/light_source.h"

namespace beam {

// Panoramas in the axes of `radiance`, of which LightTurn tells where they are in the world. All are
// scene-linear Rec.709, the environment's gain applied.
struct PreparedLight {
  Image<vec3> radiance;
  float yaw_rad = 0;                    // the environment's own
  std::array<vec3, 9> irradiance_sh{};  // as irradianceSh() gives it
  Image<vec3> irradiance_map;           // 128 x 64; empty where SH hold all there is
  // GGX-filtered for roughness i / (size - 1); the first is empty: `radiance` itself. Interpolated between.
  std::vector<Image<vec3>> levels;
  TransferTables transfer;  // for surfaces whose visibility is known
  // Far ones that were taken out of all of the above; none where they are in it.
  std::vector<LightSource> lamps;
};

// Of a panorama that light falls from, at most: a wider one lights as its reduced one does.
inline constexpr int kWidestLight = 4096;
// The reduced one; as it is where it is not wider.
Environment lightingEnvironment(const Environment& environment, const Progress& progress = Progress{});

// What of a panorama its lamps (render/panorama_lamps.h) are: part of it, or lights of their own.
enum class PanoramaLamps { Within, Apart };

// Throws Cancelled when the progress is stopped.
PreparedLight prepareLight(const Environment& environment, const Progress& progress = Progress{},
                           PanoramaLamps lamps = PanoramaLamps::Within);

// From the world into the panorama's axes; `yaw_rad` comes on top of the environment's own.
class LightTurn {
 public:
  LightTurn(const PreparedLight& light, float yaw_rad);
  // The tables by coefficients of the world's directions: looked up, as the others, by normals in the
  // panorama's axes.
  TransferTables of(const TransferTables& tables) const;
  std::vector<LightSource> toWorld(std::vector<LightSource> lamps) const;
  vec3 operator()(vec3 d) const { return {cos_ * d.x + sin_ * d.z, d.y, -sin_ * d.x + cos_ * d.z}; }

 private:
  float cos_, sin_;
};

// Unit directions and normals in the panorama's axes.
vec3 irradiance(const PreparedLight& light, vec3 normal);  // E(n)
vec3 prefiltered(const PreparedLight& light, vec3 direction, float roughness);

// Prepared lights by the identity of their environments, so that all who draw share them; forgotten with the
// environment. Thread-safe.
class PreparedLights {
 public:
  // Throws Cancelled when the progress is stopped while it prepares, and keeps nothing then.
  std::shared_ptr<const PreparedLight> of(const std::shared_ptr<const Environment>& environment,
                                          const Progress& progress = Progress{},
                                          PanoramaLamps lamps = PanoramaLamps::Within);

 private:
  struct Entry {
    std::weak_ptr<const Environment> environment;
    PanoramaLamps lamps = PanoramaLamps::Within;
    std::shared_ptr<const PreparedLight> light;
  };
  std::mutex mutex_;
  std::vector<Entry> all_;
};

// Split-sum factors (Karis 2013) of a smooth dielectric: integral of f_s (n.l) = F0 * x + y. `n_dot_v` in [0,
// 1].
vec2 splitSum(float n_dot_v, float roughness);
// The table behind it: columns are the square root of n.v, rows the roughness, both from 0 to 1 on the middle
// of the first and the last texel.
const Image<vec2>& splitSumTable();

// Both throw Cancelled when the progress is stopped. The panorama as another of width x height texels, each
// the mean over its solid angle; never enlarges.
Image<vec3> reducedPanorama(const Image<vec3>& panorama, int width, int height,
                            const Progress& progress = Progress{});

// out(d) = integral of panorama(w) kernel(d . w) / integral of kernel; the kernel is 0 below `min_cosine`.
Image<vec3> convolvedPanorama(const Image<vec3>& panorama, ivec2 size, float min_cosine,
                              const std::function<float(float)>& kernel,
                              const Progress& progress = Progress{});

}  // namespace beam
