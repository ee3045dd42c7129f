// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/stage_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/message_of.h"
#include "tests/support/step_literal.h"

namespace beam::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// A stage "light" with one setting, in a group or in none.
struct Setting {
  std::string group = "";
  Effect effect = Effect::Result;
  double value = 1;
};
void describe(Fields& f, Setting& s) {
  const auto field = [&] {
    f.field({.name = "gain", .label = "Gain", .help = "Of light.", .effect = s.effect}, s.value);
  };
  s.group.empty() ? field() : f.group(s.group, field);
}

class OneSetting final : public StageOf<Setting> {
 public:
  OneSetting(std::vector<StepInfo> steps, const Setting& setting)
      : info_{"light", "Light", "", std::move(steps)} {
    options_ = setting;
  }
  const StageInfo& info() const override { return info_; }
  void run(std::string_view, StepContext&) const override {}

 private:
  StageInfo info_;
};

void add(const std::vector<StepInfo>& steps, const Setting& setting) {
  StageRegistry registry;
  registry.add([=] { return std::make_unique<OneSetting>(steps, setting); });
}

const std::vector<StepInfo> kOneStep = {{.id = "import", .title = "Import"}};
const std::vector<StepInfo> kWithLater = {
    {.id = "import", .title = "Import", .later = {.previous = {"light.import"_step}}}};

// A group of settings that enter no key.
TEST(StageRegistry, AStageWithoutStepsIsSettingsAlone) {
  StageRegistry registry;
  registry.add([] {
    return std::make_unique<OneSetting>(std::vector<StepInfo>(), Setting{.effect = Effect::Pictures});
  });
  EXPECT_TRUE(registry.infos().empty());
  ASSERT_EQ(registry.groups().size(), 1u);
  const auto fields = registry.allFields([&](std::string_view id) { return registry.make(id); });
  ASSERT_EQ(fields.size(), 1u);
  EXPECT_EQ(fields[0].info.name, "light.gain");
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { registry.info("light"); }),
              HasSubstr("nothing of it to run"));
  EXPECT_THAT(messageOf(Error::Kind::Usage, [&] { registry.make("lihgt"); }), HasSubstr("lihgt"));
  EXPECT_THAT(messageOf(Error::Kind::Bug, [] { add({}, {}); }), HasSubstr("enters no key"));
}

TEST(StepId, IsAStageAndANameAndComesFromTextOnlyWhereThatIsSaid) {
  const StepId step("surface", "fit");
  EXPECT_EQ(step, "surface.fit"_step);
  EXPECT_EQ(step.text(), "surface.fit");
  EXPECT_EQ(step.stage(), "surface");
  EXPECT_EQ(step.name(), "fit");
  EXPECT_TRUE(StepId().empty());
  EXPECT_EQ(StepId("surface").name(), "");
  static_assert(!std::is_convertible_v<std::string, StepId> && !std::is_convertible_v<StepId, std::string>);
}

TEST(StageRegistry, TakesSettingsThatEnterAKey) {
  EXPECT_NO_THROW(add(kOneStep, {}));
  EXPECT_NO_THROW(add(kOneStep, {.group = "import"}));
  EXPECT_NO_THROW(add(kWithLater, {.group = "later"}));
}

TEST(StageRegistry, RefusesASettingThatChangesResultsAndEntersNoKey) {
  const auto refusal = [](const std::vector<StepInfo>& steps, const Setting& setting) {
    return messageOf(Error::Kind::Bug, [&] { add(steps, setting); });
  };
  EXPECT_THAT(refusal(kOneStep, {.group = "polish"}),
              AllOf(HasSubstr("stage light"), HasSubstr("\"polish\""), HasSubstr("\"gain\"")));
  EXPECT_THAT(refusal(kOneStep, {.group = "later"}), HasSubstr("\"later\"")) << "no step has later frames";
  EXPECT_THAT(refusal({}, {}), HasSubstr("\"gain\"")) << "a stage without steps";
}

TEST(StageRegistry, LetsOtherSettingsStandWhereverTheyLike) {
  EXPECT_NO_THROW(add(kOneStep, {.group = "polish", .effect = Effect::SpeedOnly}));
  EXPECT_NO_THROW(add({}, {.effect = Effect::LaterResults}));
}

TEST(StageRegistry, RefusesAStepThatReadsWhatDoesNotStandBeforeIt) {
  EXPECT_THAT(
      messageOf(Error::Kind::Bug,
                [] { add({{.id = "import", .title = "Import", .inputs = {"light.bake"_step}}}, {}); }),
      AllOf(HasSubstr("light.import"), HasSubstr("light.bake")));
}

}  // namespace
}  // namespace beam::testing
