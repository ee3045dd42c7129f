// SPDX-License-Identifier: Apache-2.0
#include "app/cli/answer.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/io/written_by.h"
#include "core/pipeline/output_target.h"

namespace beam {
namespace {

bool toFile(const AnswerFlags& flags) { return !flags.json_file.empty() && flags.json_file != "-"; }

}  // namespace

std::string signedBy(const std::string& command, const std::string& json) {
  using Json = nlohmann::ordered_json;
  const Json content = Json::parse(json);
  Json whole = {{"written_by", {{"program", writerOf(command)}}}};
  whole.update(content);
  return whole.dump(1, ' ', false, Json::error_handler_t::replace);
}

void addAnswerFlags(CLI::App& command, AnswerFlags& flags) {
  command.add_flag("--json", flags.json, "Print JSON instead of words");
  command.add_option("--json-file", flags.json_file, "Also write JSON to this file; -: as --json")
      ->type_name("FILE");
  addForceFlag(command, flags.force);
}

void requireAnswerTarget(const AnswerFlags& flags, const std::string& command) {
  if (toFile(flags)) requireFileTarget(flags.json_file, {command, flags.force});
}

void answer(const AnswerFlags& flags, const std::string& command, Console& console,
            const std::function<std::string()>& words, const std::function<std::string()>& json) {
  const bool print_json = flags.json || flags.json_file == "-";
  const std::string whole = print_json || toFile(flags) ? signedBy(command, json()) : std::string();
  std::exception_ptr not_written;  // it is told all the same
  try {
    if (toFile(flags)) writeFileAtomically(flags.json_file, whole + "\n");
  } catch (const Error&) {
    not_written = std::current_exception();
  }
  print_json ? console.print(whole) : console.tell(words());
  if (not_written) std::rethrow_exception(not_written);
}

}  // namespace beam
