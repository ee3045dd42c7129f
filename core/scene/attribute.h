// SPDX-License-Identifier: Apache-2.0
// What Gaussians carry beside their shape, named and described, so that writers and pictures need not know
// each kind. Materials stay typed; attributesOf lists them with the rest.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"
#include "core/math/sh.h"

namespace beam {

struct GaussianCloud;
struct GaussianFrame;
struct Materials;

struct AttributeInfo {
  std::string name;  // snake_case, unique in a frame
  int channels = 1;  // 1 or 3
  // 1: one value from all sides; kShCount: degree-3 SH, value(d) = 0.5 + sum_k basis_k(d) c_k.
  int coefficients = 1;
  Encoding encoding = Encoding::Data;
  std::string unit = "";
  // Turns with the cloud: its bands are those of the world's directions. A plain value never does.
  bool turns() const { return coefficients == kShCount; }
  bool operator==(const AttributeInfo&) const = default;
};

// values[(gaussian * coefficients + k) * channels + channel].
struct Attribute {
  AttributeInfo info;
  std::vector<float> values;
  bool operator==(const Attribute&) const = default;
};

// An attribute in somebody else's memory.
struct AttributeSpan {
  AttributeInfo info;
  std::span<const float> values;
};

inline constexpr const char* kRoughnessName = "roughness";
inline constexpr const char* kBaseColorName = "base_color";
inline constexpr const char* kOcclusionName = "ambient_occlusion";
// Of frames whose visibility was baked: the share of light from a direction that arrives, SH of directions in
// the world; and 1 or -1, by which the thinnest axis (scene/thin_axis.h) is the outward normal.
inline constexpr const char* kVisibilityName = "visibility";
inline constexpr const char* kNormalSideName = "normal_side";

// Every one: "opacity", "radiance", the materials' roughness, base colour and ambient occlusion where there
// are some (null: none), then `own`. Valid as long as the values.
std::vector<AttributeSpan> attributesOf(const GaussianCloud& cloud, const Materials* materials,
                                        const std::vector<Attribute>& own);
std::vector<AttributeSpan> attributesOf(const GaussianFrame& frame);
const Attribute* attributeNamed(const std::vector<Attribute>& all, std::string_view name);  // null: none

// Throws Error{Data} unless it has 1 or 3 channels, 1 or kShCount coefficients, finite values for
// `gaussians`, and a name that no typed one has.
void validate(const Attribute& attribute, std::size_t gaussians);

}  // namespace beam
