// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/result_record.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json_words.h"

namespace beam {
namespace {

using Json = nlohmann::ordered_json;

Json digests(const std::map<std::string, Digest>& named) {
  Json j = Json::object();
  for (const auto& [name, digest] : named) j[name] = digest.hex();
  return j;
}

std::map<std::string, Digest> parseDigests(const Json& j) {
  std::map<std::string, Digest> named;
  for (const auto& [name, hex] : j.items()) named[name] = parseDigest(hex.get<std::string>());
  return named;
}

template <class Body>
auto parsed(std::string_view what, std::string_view json, Body&& body) {
  try {
    return body(Json::parse(json));
  } catch (const nlohmann::json::exception& e) {
    throw Error(Error::Kind::Data, fmt::format("{} cannot be understood: {}", what, jsonComplaint(e)));
  }
}

}  // namespace

std::string aboutText(const ResultRecord& r) {
  const std::string of = r.frame.empty() ? "the whole project" : fmt::format("frame {}", r.frame);
  const std::string text = fmt::format("{} of {}{}{}", r.ingredients.step.text(), of,
                                       r.ingredients.later ? ", built on the frame before" : "",
                                       r.lead ? ", as a lead of a take" : "");
  if (r.ingredients.parameters.empty()) return text + "; every setting has its default";
  std::vector<std::string> differing;
  for (const auto& [name, value] : r.ingredients.parameters)
    differing.push_back(fmt::format("{} = {}", name, value));
  return fmt::format("{}; differs from the defaults in {}", text, fmt::join(differing, ", "));
}

std::string toJson(const ResultRecord& r) {
  Json j;
  j["format"] = 1;
  j["key"] = r.key.hex();
  j["about"] = aboutText(r);
  j["step"] = r.ingredients.step.text();
  j["version"] = r.ingredients.version;
  j["parameters"] = r.ingredients.parameters;
  j["inputs"] = digests(r.ingredients.inputs);
  j["upstream"] = digests(namedResults(r.ingredients));
  if (r.ingredients.later) j["later"] = true;
  j["frame"] = r.frame;
  if (r.lead) j["lead"] = true;
  j["files"] = Json::object();
  for (const auto& [name, entry] : r.files) {
    j["files"][name] = {{"bytes", entry.bytes}, {"xxh3_128", entry.digest.hex()}};
  }
  j["program_version"] = r.program_version;
  j["device"] = r.device;
  j["threads"] = r.threads;
  j["seconds"] = r.seconds;
  if (r.work > 0) j["work"] = r.work;
  j["peak_memory_bytes"] = r.peak_memory_bytes;
  j["warnings"] = r.warnings;
  j["scores"] = r.scores;
  if (!r.pictures.empty()) j["pictures"] = r.pictures;
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ResultRecord parseResultRecord(std::string_view json) {
  return parsed("result.json", json, [](const Json& j) {
    ResultRecord r;
    r.key = parseDigest(j.at("key").get<std::string>());
    r.ingredients.step = StepId(j.at("step").get<std::string>());
    r.ingredients.version = j.at("version").get<int>();
    r.ingredients.parameters = j.at("parameters").get<std::map<std::string, std::string>>();
    r.ingredients.inputs = parseDigests(j.at("inputs"));
    setNamedResults(r.ingredients, parseDigests(j.at("upstream")));
    r.ingredients.later = j.value("later", false);
    r.frame = j.at("frame").get<std::string>();
    r.lead = j.value("lead", false);
    for (const auto& [name, entry] : j.at("files").items()) {
      r.files[name] = {entry.at("bytes").get<std::uint64_t>(),
                       parseDigest(entry.at("xxh3_128").get<std::string>())};
    }
    r.program_version = j.at("program_version").get<std::string>();
    r.device = j.at("device").get<std::string>();
    r.threads = j.at("threads").get<int>();
    r.seconds = j.at("seconds").get<double>();
    r.work = j.value("work", 0.0);
    r.peak_memory_bytes = j.at("peak_memory_bytes").get<std::uint64_t>();
    r.warnings = j.at("warnings").get<std::vector<std::string>>();
    r.scores = j.at("scores").get<std::map<std::string, double>>();
    if (j.contains("pictures")) r.pictures = j["pictures"].get<std::map<std::string, std::string>>();
    return r;
  });
}

std::string toJson(const FailureNote& note) {
  const Json j = {{"step", note.step.text()}, {"frame", note.frame}, {"message", note.message}};
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

FailureNote parseFailureNote(std::string_view json) {
  return parsed("failure note", json, [](const Json& j) {
    return FailureNote{StepId(j.at("step").get<std::string>()), j.at("frame").get<std::string>(),
                       j.at("message").get<std::string>()};
  });
}

}  // namespace beam
