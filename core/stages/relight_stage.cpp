// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "core/stages/builtin_stages.h"
#include "core/stages/relight_settings.h"

namespace beam {
namespace {

struct RelightOptions {
  std::string environment_shadows = EnvironmentLight{}.shadows;
};

void describe(Fields& fields, RelightOptions& options) {
  FieldInfo info = environmentShadowsInfo(kEnvironmentShadows);
  info.effect = Effect::Pictures;
  fields.field(std::move(info), options.environment_shadows);
}

// No steps: light is put on what is solved when it is drawn.
class RelightStage final : public StageOf<RelightOptions> {
 public:
  const StageInfo& info() const override {
    static const StageInfo kInfo{.id = kRelightStage,
                                 .title = "Relight",
                                 .summary = "How other light falls on what is solved.",
                                 .steps = {}};
    return kInfo;
  }
  void run(std::string_view, StepContext&) const override {}
};

}  // namespace

std::unique_ptr<Stage> makeRelightStage() { return std::make_unique<RelightStage>(); }

Lighting plainLighting(const Project& project) {
  Lighting lighting;
  const auto& groups = project.setup().stages.groups();
  const bool has = std::any_of(groups.begin(), groups.end(),
                               [](const StageInfo& group) { return group.id == kRelightStage; });
  if (has) {
    const FieldValue value = project.value(fmt::format("{}.{}", kRelightStage, kEnvironmentShadows));
    lighting.environment.shadows = std::get<std::string>(value);
  }
  return lighting;
}

}  // namespace beam
