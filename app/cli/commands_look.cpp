// SPDX-License-Identifier: Apache-2.0
// beam check and beam sample: look at inputs, make one.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/answer.h"
#include "app/cli/commands.h"
#include "app/cli/picture_size.h"
#include "app/cli/run_flags.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/io/capture_check.h"
#include "core/pipeline/output_target.h"
#include "core/pipeline/path_kind.h"
#include "core/sample/make_sample.h"

namespace beam {
namespace {

struct CheckFlags {
  std::string path, up, unit;
  std::optional<std::string> hold_out;
  AnswerFlags answer;
  bool strict = false;
};

int runCheck(const CheckFlags& flags, Console& console) {
  ImportOptions options;
  requireCheckable(flags.path);
  if (flags.hold_out) options.hold_out = parseHoldOut(*flags.hold_out);
  if (!flags.up.empty()) options.up = parseUpAxis(flags.up);
  if (!flags.unit.empty()) options.unit_m = parseUnit(flags.unit);
  requireAnswerTarget(flags.answer, "check");
  const CheckReport report = checkPath(flags.path, options);
  for (const std::string& w : report.warnings) console.warning(w);
  answer(
      flags.answer, "check", console, [&] { return toText(report); }, [&] { return toJson(report); });
  if (const std::string refusal = refusalOf(report); !refusal.empty())
    throw Error(Error::Kind::Data, refusal);
  return flags.strict && !report.warnings.empty() ? exitCode(Error::Kind::Data) : 0;
}

struct SampleFlags {
  std::string folder;
  std::vector<std::string> defects;
  SampleOptions options;
  std::string size = fmt::format("{}x{}", options.width, options.height);
  DeviceChoice device;
};

void applySize(std::string_view size, SampleOptions& options) {
  const ivec2 pixels = parsePictureSize(size);
  options.width = pixels.x;
  options.height = pixels.y;
}

}  // namespace

void addCheckCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<CheckFlags>();
  CLI::App* command = app.add_subcommand(
      "check", "Say what is understood of a capture, a panorama or a splat file, and what is wrong");
  command->add_option("PATH", flags->path, "Capture folder, panorama (.exr, .hdr) or splats (.ply)")
      ->required();
  addAnswerFlags(*command, flags->answer);
  command->add_flag("--strict", flags->strict, "End with 65 when there is a warning");
  command->add_option("--up", flags->up, "Up axis of the capture: +Y, +Z or -Y")->type_name("AXIS");
  command->add_option("--unit", flags->unit, kUnitHelp)->type_name("m|cm|mm|NUMBER");
  command->add_option("--hold-out", flags->hold_out, kHoldOutHelp)->type_name("N|NAMES");
  command->callback([flags, &context] {
    context.action = [flags, &context] { return runCheck(*flags, context.console); };
  });
}

void addSampleCommand(CLI::App& app, CommandContext& context) {
  auto flags = std::make_shared<SampleFlags>();
  CLI::App* command = app.add_subcommand("sample", "Make a synthetic dome capture with full ground truth");
  command->add_option("FOLDER", flags->folder, "Where it is written; must not exist or be empty")->required();
  command
      ->add_option("--frames", flags->options.frames,
                   "Number of frames, 30 a second; from two on the figure moves")
      ->type_name("N")
      ->check(CLI::Range(1, 10000));
  command
      ->add_option("--cameras", flags->options.cameras,
                   "Number of training cameras; two test cameras join them")
      ->type_name("N")
      ->check(CLI::Range(2, 200));
  command->add_option("--size", flags->size, fmt::format("Size of the pictures, {}", kPictureSizeHelp))
      ->type_name("WxH");
  command->add_option("--samples", flags->options.samples, "Light paths a pixel")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  command
      ->add_option(
          "--defect", flags->defects,
          "Faults of a camera, KIND or KIND:CAMERA: dropped (every fourth frame is missing), late (by "
          "three frames), blurred, black (the middle frame)")
      ->type_name("KIND")
      ->delimiter(',');
  addDeviceFlags(*command, flags->device);
  command->callback([flags, &context] {
    context.action = [flags, &context] {
      applySize(flags->size, flags->options);
      requireOutside(flags->folder);
      context.interrupted = fmt::format(
          "interrupted; \"{}\" is not whole: remove it before the sample is made again", flags->folder);
      for (const std::string& d : flags->defects) flags->options.defects.push_back(parseDefect(d));
      setThreadCount(flags->device.threads);
      Progress progress(context.stop, context.console.listener());
      makeSample(flags->folder, flags->options, progress);
      context.console.endProgress();
      context.console.print(fmt::format("wrote the sample capture \"{}\"", flags->folder));
      return 0;
    };
  });
}

}  // namespace beam
