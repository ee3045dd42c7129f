// SPDX-License-Identifier: Apache-2.0
// The Gaussians of a scene where a device computes on them: in world axes, packed once, whatever cameras look
// at them then.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/attribute.h"
#include "core/scene/render_scene.h"

namespace beam {

class ComputeDevice;

// The name by which an attribute's coefficients themselves are drawn, whoever looks.
inline constexpr std::string_view kCoefficientsMark = "[]";
inline std::string coefficientsOf(std::string_view attribute) {
  return std::string(attribute).append(kCoefficientsMark);
}

// One thread at a time.
class ResidentScene {
 public:
  virtual ~ResidentScene() = default;

  // Holds these from now on, one after the other. An instance that is equal to one that it holds already is
  // not packed again: shared values must not change behind their pointers. Throws Error{Bug} for an instance
  // without a cloud or with values for another number of Gaussians, and what transformed() throws.
  void load(const std::vector<RenderInstance>& instances);

  std::size_t count() const { return count_; }  // Gaussians of all instances
  // Beside shape, opacity and radiance: what every instance has, by name and description. It can be drawn.
  const std::vector<AttributeInfo>& attributes() const { return attributes_; }
  bool has(std::string_view attribute) const;
  // Floats a Gaussian that can be drawn under that name: channels of an attribute, all numbers of one of
  // coefficientsOf; 0: there is none.
  int channelsOf(std::string_view name) const;
  // Gaussians that the last load packed; the others were there.
  std::size_t packed() const { return packed_; }

 protected:
  struct Place {
    const RenderInstance* instance = nullptr;
    std::size_t first = 0, count = 0;  // Gaussians
    const Place* before = nullptr;     // of the equal instance in the load before; null: pack it
  };

 private:
  // `places` cover [0, total) in order; `attributes` as attributes() will give them. Places before refer to
  // what the last call made.
  virtual void pack(const std::vector<Place>& places, std::size_t total,
                    const std::vector<AttributeInfo>& attributes) = 0;

  std::vector<RenderInstance> instances_;
  std::vector<Place> places_;
  std::vector<AttributeInfo> attributes_;
  std::size_t count_ = 0, packed_ = 0;
};

// Every attribute of the instance that a ResidentScene can hold, in the order of attributesOf.
std::vector<AttributeSpan> drawnAttributesOf(const RenderInstance& instance);

// One cloud where it is, for the length of a loop over cameras. `materials` may be null. Nothing refers to
// the values afterwards.
std::unique_ptr<ResidentScene> residentOf(ComputeDevice& device, const GaussianCloud& cloud,
                                          const Materials* materials);
inline std::unique_ptr<ResidentScene> residentOf(ComputeDevice& device, const GaussianFrame& frame) {
  return residentOf(device, frame.cloud, frame.materials ? &*frame.materials : nullptr);
}

}  // namespace beam
