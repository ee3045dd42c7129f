// SPDX-License-Identifier: Apache-2.0
// Resident Gaussians of the CPU device: the planes that the kernels load, and further attributes likewise, a
// plane a coefficient and channel.
#pragma once

#include <span>
#include <vector>

#include "core/render/gaussian_buffers.h"
#include "core/render/resident_scene.h"

namespace beam {

class CpuResidentScene final : public ResidentScene {
 public:
  const GaussianBuffers& gaussians() const { return gaussians_; }

  // A plane of the scene's Gaussians for every channel of the named attributes, in their order: SH seen from
  // `eye`, value(d) = 0.5 + sum_k basis_k(d) c_k, not clamped; plain values, and what coefficientsOf names
  // (coefficient after coefficient), as they are. Valid until
  // `scratch` or the scene changes.
  std::vector<const float*> seenFrom(vec3 eye, std::span<const std::string> attributes,
                                     AlignedVector<float>& scratch) const;

 private:
  struct AttributePlanes {
    AttributeInfo info;
    AlignedVector<float> values;  // [coefficient * channels + channel][stride]
  };
  void pack(const std::vector<Place>& places, std::size_t total,
            const std::vector<AttributeInfo>& attributes) override;
  void packInstance(const Place& place);
  const AttributePlanes& named(const std::string& attribute) const;
  // [channel of one after the other][stride]
  void evaluate(const std::vector<const AttributePlanes*>& attributes, vec3 eye, float* out) const;

  GaussianBuffers gaussians_;
  std::vector<AttributePlanes> attributes_;
};

}  // namespace beam
