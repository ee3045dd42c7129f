// SPDX-License-Identifier: Apache-2.0
#include "core/scene/attribute.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/scene/gaussian_sequence.h"

namespace beam {
namespace {

const AttributeInfo kOpacity{.name = "opacity"};
const AttributeInfo kRadiance{
    .name = "radiance", .channels = 3, .coefficients = kShCount, .encoding = Encoding::Srgb};
const AttributeInfo kRoughness{.name = kRoughnessName};
const AttributeInfo kBaseColor{
    .name = kBaseColorName, .channels = 3, .coefficients = kShCount, .encoding = Encoding::Linear};
const AttributeInfo kOcclusion{.name = kOcclusionName, .coefficients = kShCount};

[[noreturn]] void bad(const AttributeInfo& info, const std::string& what) {
  throw Error(Error::Kind::Data, fmt::format("attribute \"{}\": {}", info.name, what));
}

}  // namespace

std::vector<AttributeSpan> attributesOf(const GaussianCloud& cloud, const Materials* m,
                                        const std::vector<Attribute>& own) {
  std::vector<AttributeSpan> all = {{kOpacity, cloud.opacity}, {kRadiance, cloud.color.coefficients}};
  if (m) {
    all.push_back({kRoughness, m->roughness});
    all.push_back({kBaseColor, m->base_color.coefficients});
    all.push_back({kOcclusion, m->ambient_occlusion.coefficients});
  }
  for (const Attribute& a : own) all.push_back({a.info, a.values});
  return all;
}

std::vector<AttributeSpan> attributesOf(const GaussianFrame& frame) {
  return attributesOf(frame.cloud, frame.materials ? &*frame.materials : nullptr, frame.attributes);
}

const Attribute* attributeNamed(const std::vector<Attribute>& all, std::string_view name) {
  for (const Attribute& a : all)
    if (a.info.name == name) return &a;
  return nullptr;
}

void validate(const Attribute& a, std::size_t gaussians) {
  for (const AttributeInfo* typed : {&kOpacity, &kRadiance, &kRoughness, &kBaseColor, &kOcclusion}) {
    if (typed->name == a.info.name)
      bad(a.info, "the name belongs to a value of its own kind; choose another");
  }
  if (a.info.channels != 1 && a.info.channels != 3)
    bad(a.info, fmt::format("expected 1 or 3 channels, found {}", a.info.channels));
  if (a.info.coefficients != 1 && a.info.coefficients != kShCount)
    bad(a.info, fmt::format("expected 1 or {} coefficients, found {}", kShCount, a.info.coefficients));
  const std::size_t each = static_cast<std::size_t>(a.info.channels) * a.info.coefficients;
  if (a.values.size() != gaussians * each)
    bad(a.info, fmt::format("expected {} values of {} Gaussians, found {}", gaussians * each, gaussians,
                            a.values.size()));
  const auto wrong =
      std::find_if_not(a.values.begin(), a.values.end(), [](float v) { return std::isfinite(v); });
  if (wrong != a.values.end())
    bad(a.info, fmt::format("expected finite values, found {} at Gaussian {}", *wrong,
                            static_cast<std::size_t>(wrong - a.values.begin()) / each));
}

}  // namespace beam
