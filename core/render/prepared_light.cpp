// SPDX-License-Identifier: Apache-2.0
#include "core/render/prepared_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/parallel.h"
#include "core/math/brdf.h"
#include "core/math/color.h"
#include "core/math/sampling.h"
#include "core/render/panorama_lamps.h"

namespace beam {
namespace {

constexpr int kLutSize = 64;
constexpr int kLutSamples = 512;
constexpr int kLevels = 11;         // roughness 0, 0.1 .. 1
constexpr int kKernelTable = 4096;  // entries over the square root of 1 - cosine
constexpr float kShTolerance =
    0.01f;  // of the mean irradiance; beyond it the convolved map serves (methods 7.2)
constexpr float kHighlightShare = 0.997f;  // of a narrow lobe's energy that is kept

vec2 integrateSplitSum(float n_dot_v, float roughness) {
  const float alpha = ggxAlpha(std::max(roughness, 0.04f));
  const vec3 v(std::sqrt(std::max(0.0f, 1 - n_dot_v * n_dot_v)), 0, n_dot_v);
  dvec2 sum(0);
  for (std::uint32_t i = 0; i < kLutSamples; ++i) {
    const vec3 h = visibleNormal(v, alpha, R2Sequence{}(i));
    const float v_dot_h = glm::dot(v, h);
    const vec3 l = 2 * v_dot_h * h - v;
    if (l.z <= 0 || v_dot_h <= 0) continue;
    // f_s (n.l) / pdf = F G2 / G1 for visible normals (methods 5.4).
    const float g = smithG2(l.z, v.z, alpha) / smithG1(v.z, alpha);
    const float m = 1 - v_dot_h, fresnel = m * m * m * m * m;
    sum += dvec2((1 - fresnel) * g, fresnel * g);
  }
  return vec2(sum / static_cast<double>(kLutSamples));
}

// Directions and solid angles of a panorama's texels, column by column of the same row together.
struct Texels {
  std::vector<vec3> direction;
  std::vector<float> solid_angle;  // of each row

  Texels(int width, int height) : direction(static_cast<std::size_t>(width) * height), solid_angle(height) {
    for (int y = 0; y < height; ++y) {
      const double top = std::sin(kPi * (0.5 - static_cast<double>(y) / height));
      const double bottom = std::sin(kPi * (0.5 - static_cast<double>(y + 1) / height));
      solid_angle[y] = static_cast<float>(2 * kPi / width * (top - bottom));
      for (int x = 0; x < width; ++x) {
        direction[static_cast<std::size_t>(y) * width + x] =
            directionFromLatLong({(x + 0.5f) / width, (y + 0.5f) / height});
      }
    }
  }
};

// Half width, in radians of longitude, of the cap of radius `reach` around latitude `center`; pi when it
// holds a pole.
float capHalfWidth(float center, float reach) {
  if (std::abs(center) + reach >= kPi / 2) return kPi;
  return std::asin(std::min(1.0f, std::sin(reach) / std::cos(center)));
}

// The kernel as a table: a look-up a pair instead of a call.
class KernelTable {
 public:
  KernelTable(const std::function<float(float)>& kernel, float min_cosine) : min_cosine_(min_cosine) {
    const float widest = std::sqrt(1 - min_cosine);
    scale_ = (kKernelTable - 1) / widest;
    for (int i = 0; i < kKernelTable; ++i) {
      const float root = i / scale_;
      values_[i] = kernel(std::max(1 - root * root, min_cosine));
    }
    values_[kKernelTable] = values_[kKernelTable - 1];
  }
  float operator()(float cosine) const {
    if (cosine < min_cosine_) return 0;
    const float t = std::min(std::sqrt(std::max(0.0f, 1 - cosine)) * scale_, kKernelTable - 1.0f);
    const int i = static_cast<int>(t);
    return values_[i] + (t - i) * (values_[i + 1] - values_[i]);
  }

 private:
  float min_cosine_, scale_ = 1;
  std::array<float, kKernelTable + 1> values_{};
};

vec3 convolvedAt(const Image<vec3>& source, const Texels& texels, vec3 direction, float min_cosine,
                 const KernelTable& kernel) {
  const float reach = std::acos(std::clamp(min_cosine, -1.0f, 1.0f));
  const float latitude = std::asin(std::clamp(direction.y, -1.0f, 1.0f));
  const int w = source.width, h = source.height;
  const int top = std::clamp(static_cast<int>((0.5f - (latitude + reach) / kPi) * h) - 1, 0, h - 1);
  const int bottom = std::clamp(static_cast<int>((0.5f - (latitude - reach) / kPi) * h) + 1, 0, h - 1);
  const int middle = static_cast<int>(latLongFromDirection(direction).x * w);
  const int half = std::min(w / 2, static_cast<int>(capHalfWidth(latitude, reach) / (2 * kPi) * w) + 2);
  const int columns = 2 * half >= w ? w : 2 * half + 1;
  const int first = (middle - half + w) % w;
  dvec3 sum(0);
  double weight = 0;
  for (int y = top; y <= bottom; ++y) {
    vec3 row(0);
    float row_weight = 0;
    const auto convolve = [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const float k = kernel(glm::dot(direction, texels.direction[t]));
        row += k * source.pixels[t];
        row_weight += k;
      }
    };
    // Around the seam in two pieces: a remainder a texel would be a third of the time.
    const std::size_t row_begin = source.index(0, y);
    const int ahead = std::min(columns, w - first);
    convolve(row_begin + first, row_begin + first + ahead);
    convolve(row_begin, row_begin + columns - ahead);
    sum += dvec3(row) * static_cast<double>(texels.solid_angle[y]);
    weight += static_cast<double>(row_weight) * texels.solid_angle[y];
  }
  return weight > 0 ? vec3(sum / weight) : lookUp(source, direction);
}

// The prefiltered radiance of one roughness; the lobe of n = v = l's mirror (Karis 2013): D(h) (n.l). Texels
// are kept below half the lobe's width.
Image<vec3> prefilteredLevel(const Image<vec3>& panorama, float roughness, const Progress& progress) {
  const float alpha = ggxAlpha(roughness);
  const int out = roughness < 0.15f ? 256 : roughness < 0.35f ? 128 : 64;
  const int in = roughness < 0.15f ? 512 : roughness < 0.25f ? 256 : roughness < 0.55f ? 128 : 64;
  // tan^2 of the half vector that holds kHighlightShare of the lobe: share = t / (alpha^2 + t).
  const float tan2 = alpha * alpha * kHighlightShare / (1 - kHighlightShare);
  const float cos2_h = 1 / (1 + tan2), min_cosine = std::max(0.0f, 2 * cos2_h - 1);
  const auto lobe = [=](float c) {
    return ggxDistribution(std::sqrt(0.5f * (1 + c)), alpha) * std::max(0.0f, c);
  };
  return convolvedPanorama(reducedPanorama(panorama, in, in / 2, progress), {out, out / 2}, min_cosine, lobe,
                           progress);
}

}  // namespace

// The square root of n.v: most changes at grazing angles.
const Image<vec2>& splitSumTable() {
  static const Image<vec2> table = [] {
    Image<vec2> t(kLutSize, kLutSize);
    for (int y = 0; y < kLutSize; ++y) {
      for (int x = 0; x < kLutSize; ++x) {
        const float c = static_cast<float>(x) / (kLutSize - 1);
        t(x, y) = integrateSplitSum(std::max(c * c, 1e-4f), static_cast<float>(y) / (kLutSize - 1));
      }
    }
    return t;
  }();
  return table;
}

vec2 splitSum(float n_dot_v, float roughness) {
  const Image<vec2>& table = splitSumTable();
  const float x = std::sqrt(std::clamp(n_dot_v, 0.0f, 1.0f)) * (kLutSize - 1);
  const float y = std::clamp(roughness, 0.0f, 1.0f) * (kLutSize - 1);
  const int x0 = std::min(static_cast<int>(x), kLutSize - 2),
            y0 = std::min(static_cast<int>(y), kLutSize - 2);
  const vec2* row = table.pixels.data() + y0 * kLutSize + x0;
  return glm::mix(glm::mix(row[0], row[1], x - x0), glm::mix(row[kLutSize], row[kLutSize + 1], x - x0),
                  y - y0);
}

Image<vec3> reducedPanorama(const Image<vec3>& in, int width, int height, const Progress& progress) {
  const int w = std::min(width, in.width), h = std::min(height, in.height);
  if (w == in.width && h == in.height) return in;
  Image<vec3> out(w, h, vec3(0), Encoding::Linear);
  // Overlap of [a, a + 1) / to with [b, b + 1) / from, for both axes; rows weighted by the sine of the
  // latitude.
  const auto overlap = [](int a, int to, int b, int from) {
    const double begin = std::max(static_cast<double>(a) / to, static_cast<double>(b) / from);
    const double end = std::min((a + 1.0) / to, (b + 1.0) / from);
    return std::pair{begin, std::max(begin, end)};
  };
  parallelFor(h, 1, [&](std::size_t row, std::size_t) {
    if (progress.stopRequested()) return;
    const int y = static_cast<int>(row);
    const int y0 = y * in.height / h, y1 = std::min(in.height, (y + 1) * in.height / h + 1);
    for (int x = 0; x < w; ++x) {
      const int x0 = static_cast<int>(static_cast<std::int64_t>(x) * in.width / w);
      const int x1 = std::min(in.width, static_cast<int>((x + 1ll) * in.width / w) + 1);
      dvec3 sum(0);
      double weight = 0;
      for (int j = y0; j < y1; ++j) {
        const auto [top, bottom] = overlap(y, h, j, in.height);
        const double band = std::cos(kPi * top) - std::cos(kPi * bottom);
        for (int i = x0; i < x1; ++i) {
          const auto [left, right] = overlap(x, w, i, in.width);
          sum += dvec3(in(i, j)) * (band * (right - left));
          weight += band * (right - left);
        }
      }
      out(x, y) = vec3(sum / weight);
    }
  });
  progress.check();
  return out;
}

Image<vec3> convolvedPanorama(const Image<vec3>& panorama, ivec2 size, float min_cosine,
                              const std::function<float(float)>& kernel, const Progress& progress) {
  const Texels texels(panorama.width, panorama.height), targets(size.x, size.y);
  const KernelTable table(kernel, min_cosine);
  Image<vec3> out(size.x, size.y, vec3(0), Encoding::Linear);
  parallelFor(out.pixels.size(), 64, [&](std::size_t begin, std::size_t end) {
    if (progress.stopRequested()) return;
    for (std::size_t i = begin; i < end; ++i) {
      out.pixels[i] = convolvedAt(panorama, texels, targets.direction[i], min_cosine, table);
    }
  });
  progress.check();
  return out;
}

Environment lightingEnvironment(const Environment& e, const Progress& progress) {
  return {reducedPanorama(e.radiance, kWidestLight, kWidestLight / 2, progress), e.yaw_rad, e.gain};
}

PreparedLight prepareLight(const Environment& environment, const Progress& progress, PanoramaLamps lamps) {
  PreparedLight light;
  light.radiance = lightingEnvironment(environment, progress).radiance;
  if (lamps == PanoramaLamps::Apart) {
    SplitPanorama split = splitPanorama(light.radiance, progress);
    light.lamps = std::move(split.lamps);
    for (LightSource& lamp : light.lamps) lamp.strength *= environment.gain;
    if (!light.lamps.empty()) light.radiance = std::move(split.rest);
  }
  for (vec3& p : light.radiance.pixels) p *= environment.gain;
  light.yaw_rad = environment.yaw_rad;
  light.irradiance_sh = irradianceSh(Environment{light.radiance});
  Image<vec3> map = convolvedPanorama(
      reducedPanorama(light.radiance, 128, 64, progress), {128, 64}, 0.0f, [](float c) { return c; },
      progress);
  float worst = 0, mean = 0;
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    map.pixels[i] *= kPi;
    const int x = static_cast<int>(i) % map.width, y = static_cast<int>(i) / map.width;
    const vec3 n = directionFromLatLong({(x + 0.5f) / map.width, (y + 0.5f) / map.height});
    worst = std::max(worst, std::abs(luminance(map.pixels[i] - irradiance(light.irradiance_sh, n))));
    mean += luminance(map.pixels[i]) / static_cast<float>(map.pixels.size());
  }
  if (worst > kShTolerance * mean) light.irradiance_map = std::move(map);
  light.levels.resize(kLevels);
  for (int i = 1; i < kLevels; ++i)
    light.levels[i] = prefilteredLevel(light.radiance, i / (kLevels - 1.0f), progress);
  light.transfer = prepareTransfer(light.radiance, progress);
  return light;
}

LightTurn::LightTurn(const PreparedLight& light, float yaw_rad)
    : cos_(std::cos(-yaw_rad - light.yaw_rad)), sin_(std::sin(-yaw_rad - light.yaw_rad)) {}

// (R v) . T = v . (R^T T): one turn of the tables instead of one of each visibility.
TransferTables LightTurn::of(const TransferTables& tables) const {
  const ShRotation back(dmat3(cos_, 0, sin_, 0, 1, 0, -sin_, 0, cos_));
  TransferTables turned{tables.width, tables.height, tables.texels};
  for (std::size_t i = 0; i < tables.texels.size(); ++i) {
    float in[3 * kShCount], out[3 * kShCount];
    for (int k = 0; k < 3 * kShCount; ++k) in[k] = tables.texels[i][k / 3][k % 3];
    back.apply(3, in, out);
    for (int k = 0; k < 3 * kShCount; ++k) turned.texels[i][k / 3][k % 3] = out[k];
  }
  return turned;
}

std::vector<LightSource> LightTurn::toWorld(std::vector<LightSource> lamps) const {
  for (LightSource& lamp : lamps) {
    const vec3 d = lamp.toward;
    lamp.toward = {cos_ * d.x - sin_ * d.z, d.y, sin_ * d.x + cos_ * d.z};
  }
  return lamps;
}

vec3 irradiance(const PreparedLight& light, vec3 normal) {
  return light.irradiance_map.empty() ? irradiance(light.irradiance_sh, normal)
                                      : lookUp(light.irradiance_map, normal);
}

vec3 prefiltered(const PreparedLight& light, vec3 direction, float roughness) {
  const int last = static_cast<int>(light.levels.size()) - 1;
  const float level = std::clamp(roughness, 0.0f, 1.0f) * static_cast<float>(last);
  const int below = std::min(static_cast<int>(level), last - 1);
  const Image<vec3>& sharp = below == 0 ? light.radiance : light.levels[below];
  const vec2 uv = latLongFromDirection(direction);
  return glm::mix(lookUp(sharp, uv), lookUp(light.levels[below + 1], uv), level - static_cast<float>(below));
}

std::shared_ptr<const PreparedLight> PreparedLights::of(const std::shared_ptr<const Environment>& environment,
                                                        const Progress& progress, PanoramaLamps lamps) {
  const auto found = [&]() -> std::shared_ptr<const PreparedLight> {
    std::erase_if(all_, [](const Entry& entry) { return entry.environment.expired(); });
    for (const Entry& known : all_)
      if (known.lamps == lamps && known.environment.lock() == environment) return known.light;
    return nullptr;
  };
  {
    const std::lock_guard lock(mutex_);
    if (auto light = found()) return light;
  }
  auto light = std::make_shared<const PreparedLight>(prepareLight(*environment, progress, lamps));
  const std::lock_guard lock(mutex_);
  if (auto other = found()) return other;  // of a thread that was faster
  all_.push_back({environment, lamps, light});
  return light;
}

}  // namespace beam
