// SPDX-License-Identifier: Apache-2.0
#include "core/render/cpu/cpu_resident_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/sh.h"
#include "core/scene/transform.h"

namespace beam {
namespace {

constexpr std::size_t kBlock = 256;  // Gaussians whose bases stay in the first cache
constexpr std::size_t kGrain = 16;   // blocks

std::size_t planesOf(const AttributeInfo& info) {
  return static_cast<std::size_t>(info.coefficients) * info.channels;
}

// The basis of each Gaussian's direction from the eye; positions, and what is written, a block each.
void basesFrom(vec3 eye, const float* const position[3], std::size_t count,
               float (&basis)[kShCount][kBlock]) {
  float x[kBlock], y[kBlock], z[kBlock];
  for (std::size_t i = 0; i < count; ++i) {
    const vec3 to = vec3(position[0][i], position[1][i], position[2][i]) - eye;
    const vec3 d = to / std::max(glm::length(to), 1e-6f);
    x[i] = d.x;
    y[i] = d.y;
    z[i] = d.z;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto b = shBasis({x[i], y[i], z[i]});
    for (int k = 0; k < kShCount; ++k) basis[k][i] = b[k];
  }
}

// 0.5 + sum_k basis_k coefficient_k, the coefficients `apart` from each other.
void sumOf(const float (&basis)[kShCount][kBlock], const float* coefficient, std::size_t apart,
           std::size_t count, float* value) {
  float sum[kBlock];
  for (std::size_t i = 0; i < count; ++i) {
    float v = 0.5f;
    for (int k = 0; k < kShCount; ++k) v += basis[k][i] * coefficient[k * apart + i];
    sum[i] = v;
  }
  std::copy_n(sum, count, value);
}

}  // namespace

void CpuResidentScene::pack(const std::vector<Place>& places, std::size_t total,
                            const std::vector<AttributeInfo>& attributes) {
  const bool same_planes =
      attributes_.size() == attributes.size() &&
      std::equal(attributes.begin(), attributes.end(), attributes_.begin(),
                 [](const auto& info, const AttributePlanes& p) { return info == p.info; });
  const bool in_place = same_planes && total == gaussians_.count &&
                        std::all_of(places.begin(), places.end(),
                                    [](const Place& p) { return !p.before || p.before->first == p.first; });
  if (!in_place) {
    const GaussianBuffers old = std::exchange(gaussians_, GaussianBuffers(total));
    const std::vector<AttributePlanes> old_attributes = std::move(attributes_);
    attributes_.clear();
    for (const AttributeInfo& info : attributes)
      attributes_.push_back({info, AlignedVector<float>(planesOf(info) * gaussians_.stride)});
    for (const Place& p : places) {
      if (!p.before) continue;
      for (int k = 0; k < gaussians_.planes(); ++k)
        std::copy_n(old.plane(k) + p.before->first, p.count, gaussians_.plane(k) + p.first);
      for (std::size_t a = 0; a < attributes_.size(); ++a) {
        for (std::size_t k = 0; k < planesOf(attributes[a]); ++k) {
          std::copy_n(old_attributes[a].values.data() + k * old.stride + p.before->first, p.count,
                      attributes_[a].values.data() + k * gaussians_.stride + p.first);
        }
      }
    }
  }
  for (const Place& p : places) {
    if (!p.before) packInstance(p);
  }
}

void CpuResidentScene::packInstance(const Place& place) {
  const RenderInstance* from = place.instance;
  RenderInstance turned;
  if (!isIdentity(from->world_from_cloud)) {
    const Similarity3& s = from->world_from_cloud;
    turned.cloud = std::make_shared<const GaussianCloud>(transformed(*from->cloud, s));
    if (from->materials)
      turned.materials = std::make_shared<const Materials>(transformed(*from->materials, s));
    if (from->attributes) {
      std::vector<Attribute> all;
      for (const Attribute& a : *from->attributes) all.push_back(transformed(a, s));
      turned.attributes = std::make_shared<const std::vector<Attribute>>(std::move(all));
    }
    from = &turned;
  }
  packCloud(*from->cloud, gaussians_, place.first);
  for (const AttributeSpan& a : drawnAttributesOf(*from)) {
    const auto to = std::find_if(attributes_.begin(), attributes_.end(),
                                 [&](const AttributePlanes& p) { return p.info == a.info; });
    if (to != attributes_.end())
      packPlanes(a.values, planesOf(a.info), place.count, gaussians_.stride, to->values.data() + place.first);
  }
}

const CpuResidentScene::AttributePlanes& CpuResidentScene::named(const std::string& attribute) const {
  const auto found = std::find_if(attributes_.begin(), attributes_.end(),
                                  [&](const AttributePlanes& p) { return p.info.name == attribute; });
  if (found != attributes_.end()) return *found;
  throw Error(Error::Kind::Bug, fmt::format("resident scene: it holds no attribute \"{}\"", attribute));
}

// Sums over coefficients in their order, a Gaussian apart from the others: the same bits whatever the block.
void CpuResidentScene::evaluate(const std::vector<const AttributePlanes*>& attributes, vec3 eye,
                                float* out) const {
  const std::size_t n = gaussians_.count, stride = gaussians_.stride;
  parallelFor((n + kBlock - 1) / kBlock, kGrain, [&](std::size_t begin, std::size_t end) {
    float basis[kShCount][kBlock];
    for (std::size_t block = begin; block < end; ++block) {
      const std::size_t first = block * kBlock, count = std::min(kBlock, n - first);
      const float* const position[3] = {gaussians_.plane(PlaneLayout::kPosition) + first,
                                        gaussians_.plane(PlaneLayout::kPosition + 1) + first,
                                        gaussians_.plane(PlaneLayout::kPosition + 2) + first};
      basesFrom(eye, position, count, basis);
      float* value = out + first;
      for (const AttributePlanes* planes : attributes) {
        const int channels = planes->info.channels;
        for (int c = 0; c < channels; ++c, value += stride) {
          const float* coefficient = planes->values.data() + c * stride + first;
          sumOf(basis, coefficient, channels * stride, count, value);
        }
      }
    }
  });
}

std::vector<const float*> CpuResidentScene::seenFrom(vec3 eye, std::span<const std::string> attributes,
                                                     AlignedVector<float>& scratch) const {
  const std::size_t stride = gaussians_.stride;
  std::vector<const AttributePlanes*> by_direction;
  std::size_t rows = 0;
  for (const std::string& name : attributes) {
    if (name.ends_with(kCoefficientsMark)) continue;
    const AttributePlanes& planes = named(name);
    if (!planes.info.turns()) continue;
    by_direction.push_back(&planes);
    rows += static_cast<std::size_t>(planes.info.channels);
  }
  if (scratch.size() < rows * stride) scratch.resize(rows * stride);
  if (!by_direction.empty()) evaluate(by_direction, eye, scratch.data());
  std::vector<const float*> seen;
  const float* next = scratch.data();
  for (const std::string& name : attributes) {
    if (name.ends_with(kCoefficientsMark)) {
      const AttributePlanes& planes = named(name.substr(0, name.size() - kCoefficientsMark.size()));
      for (std::size_t p = 0; p < planesOf(planes.info); ++p)
        seen.push_back(planes.values.data() + p * stride);
      continue;
    }
    const AttributePlanes& planes = named(name);
    const bool turns = planes.info.turns();
    for (int c = 0; c < planes.info.channels; ++c)
      seen.push_back((turns ? next : planes.values.data()) + c * stride);
    if (turns) next += planes.info.channels * stride;
  }
  return seen;
}

}  // namespace beam
