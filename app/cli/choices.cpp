// SPDX-License-Identifier: Apache-2.0
#include "app/cli/choices.h"

#include <CLI/CLI.hpp>
#include <map>

#include "app/cli/commands.h"
#include "app/cli/flag_facts.h"
#include "core/pipeline/presets.h"
#include "core/scene/channel.h"
#include "core/work/export_frames.h"

namespace beam {
namespace {

constexpr const char* kListFlag = "channels";  // takes several

using Choices = std::map<std::string, std::vector<std::string>>;  // by the flag's long name, without dashes

Choices choicesOf(const Services& services) {
  std::vector<std::string> stages, formats;
  for (const StageInfo& stage : services.pipeline->stages.infos()) stages.push_back(stage.id);
  for (const ExportFormat& format : exportFormats()) formats.push_back(format.id);
  return {{"preset", presetNamesIn(services.pipeline->presets)},
          {"stage", stages},
          {"until", stages},
          {"channels", channelIds()},
          {"format", formats},
          {"renderer", rendererNames()},
          {"frame-of", {"capture", "world"}},
          {"simd", {"auto", "avx512", "avx2", "scalar"}},
          {"device", {"cpu"}}};
}

// Keys of settings, as they are typed behind these flags.
Choices keysOf(const Services& services) {
  std::vector<std::string> keys, assignments;
  const StageRegistry& stages = services.pipeline->stages;
  for (const Field& field : stages.allFields([&](std::string_view id) { return stages.make(id); })) {
    keys.push_back(field.info.name);
    assignments.push_back(field.info.name + "=");
  }
  return {{"set", assignments}, {"unset", keys}};
}

void addTo(CLI::App& command, const Choices& choices, const Choices& keys) {
  for (CLI::Option* option : command.get_options({})) {
    for (const std::string& name : option->get_lnames()) {
      if (const auto found = choices.find(name); found != choices.end())
        option->check(name == kListFlag ? listOf(found->second) : oneOf(found->second));
      if (const auto found = keys.find(name); found != keys.end()) option->check(offeringOf(found->second));
    }
  }
  for (CLI::App* below : command.get_subcommands({})) addTo(*below, choices, keys);
}

}  // namespace

void addChoices(CLI::App& app, const Services& services) {
  addTo(app, choicesOf(services), keysOf(services));
}

}  // namespace beam
