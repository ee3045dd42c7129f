// SPDX-License-Identifier: Apache-2.0
#include "core/render/resident_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/render/device.h"

namespace beam {
namespace {

constexpr std::size_t kInBuffers = 2;  // opacity and radiance, which lead attributesOf

void check(const RenderInstance& instance) {
  if (!instance.cloud) throw Error(Error::Kind::Bug, "resident scene: an instance has no cloud");
  const std::size_t n = instance.cloud->size();
  for (const AttributeSpan& a : drawnAttributesOf(instance)) {
    const std::size_t expected = n * a.info.coefficients * a.info.channels;
    if (a.values.size() == expected) continue;
    throw Error(Error::Kind::Bug,
                fmt::format("resident scene: \"{}\" has {} values, expected {} of {} Gaussians", a.info.name,
                            a.values.size(), expected, n));
  }
}

// What all have.
std::vector<AttributeInfo> sharedAttributes(const std::vector<RenderInstance>& instances) {
  std::vector<AttributeInfo> shared;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    std::vector<AttributeInfo> own;
    for (const AttributeSpan& a : drawnAttributesOf(instances[i])) own.push_back(a.info);
    if (i == 0) shared = own;
    std::erase_if(shared, [&](const AttributeInfo& info) {
      return std::find(own.begin(), own.end(), info) == own.end();
    });
  }
  return shared;
}

template <class T>
std::shared_ptr<const T> borrowed(const T* value) {
  return {std::shared_ptr<const T>(), value};
}

}  // namespace

std::vector<AttributeSpan> drawnAttributesOf(const RenderInstance& instance) {
  static const std::vector<Attribute> kNone;
  std::vector<AttributeSpan> all = attributesOf(*instance.cloud, instance.materials.get(),
                                                instance.attributes ? *instance.attributes : kNone);
  all.erase(all.begin(), all.begin() + kInBuffers);
  return all;
}

bool ResidentScene::has(std::string_view attribute) const {
  return std::any_of(attributes_.begin(), attributes_.end(),
                     [&](const AttributeInfo& info) { return info.name == attribute; });
}

int ResidentScene::channelsOf(std::string_view name) const {
  const bool whole = name.ends_with(kCoefficientsMark);
  if (whole) name.remove_suffix(kCoefficientsMark.size());
  for (const AttributeInfo& info : attributes_)
    if (info.name == name) return whole ? info.channels * info.coefficients : info.channels;
  return 0;
}

void ResidentScene::load(const std::vector<RenderInstance>& instances) {
  for (const RenderInstance& instance : instances) check(instance);
  const std::vector<AttributeInfo> attributes = sharedAttributes(instances);
  const bool same_planes = attributes == attributes_;
  const std::vector<RenderInstance> instances_before = std::exchange(instances_, {});
  const std::vector<Place> places_before = std::exchange(places_, {});  // none any more if packing fails
  std::vector<RenderInstance> kept = instances;
  std::vector<Place> places;
  std::vector<bool> taken(places_before.size(), false);
  std::size_t total = 0, packed = 0;
  for (const RenderInstance& instance : kept) {
    Place place{&instance, total, instance.cloud->size(), nullptr};
    for (std::size_t i = 0; same_planes && i < places_before.size(); ++i) {
      if (taken[i] || *places_before[i].instance != instance) continue;
      taken[i] = true;
      place.before = &places_before[i];
      break;
    }
    if (!place.before) packed += place.count;
    total += place.count;
    places.push_back(place);
  }
  pack(places, total, attributes);
  for (Place& place : places) place.before = nullptr;
  instances_ = std::move(kept);  // its elements stay where `places` says
  places_ = std::move(places);
  attributes_ = attributes;
  count_ = total;
  packed_ = packed;
}

std::unique_ptr<ResidentScene> residentOf(ComputeDevice& device, const GaussianCloud& cloud,
                                          const Materials* materials) {
  std::unique_ptr<ResidentScene> scene = device.newResidentScene();
  scene->load({{.cloud = borrowed(&cloud), .materials = borrowed(materials), .attributes = nullptr}});
  return scene;
}

}  // namespace beam
