// SPDX-License-Identifier: Apache-2.0
#include "core/io/described_json.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/field_text.h"
#include "core/base/json_words.h"

namespace beam {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr int kMajor = 1, kMinor = 0;

std::string joined(const std::string& place, std::string_view name) {
  return place.empty() ? std::string(name) : fmt::format("{}.{}", place, name);
}

std::optional<Json> takeFrom(Json& object, std::string_view path, const std::string& place) {
  const std::size_t dot = path.find('.');
  const std::string first(path.substr(0, dot));
  const auto found = object.find(first);
  if (found == object.end()) return std::nullopt;
  if (dot == std::string_view::npos) {
    Json taken = std::move(*found);
    object.erase(found);
    return taken;
  }
  const std::string inside = joined(place, first);
  if (!found->is_object()) refuseJson(inside, "an object", *found);
  std::optional<Json> taken = takeFrom(*found, path.substr(dot + 1), inside);
  if (taken && found->empty()) object.erase(found);
  return taken;
}

void merge(OrderedJson& object, const OrderedJson& more) {
  for (const auto& [name, value] : more.items()) {
    const auto there = object.find(name);
    if (there == object.end()) {
      object[name] = value;
    } else if (there->is_object() && value.is_object()) {
      merge(*there, value);
    }
  }
}

bool fitsInt(const Json& value) {
  if (!value.is_number_integer()) return false;
  if (value.is_number_unsigned()) return value.get<std::uint64_t>() <= std::numeric_limits<int>::max();
  return value.get<std::int64_t>() >= std::numeric_limits<int>::min();
}

void checkFormat(const Json& format, const char* name) {
  JsonObject tells(format, "format");
  if (const std::string found = tells.takeText("name"); found != name)
    refuseJson("format.name", fmt::format("\"{}\"", name), found);
  const Json major = tells.take("major").value_or(Json());
  if (!fitsInt(major)) refuseJson("format.major", "a whole number", major);
  if (major.get<int>() <= kMajor) return;
  throw Error(Error::Kind::Data, fmt::format("it has the format {}.x, this program reads up to {}.x; open it "
                                             "with a newer BEAM Studio",
                                             major.get<int>(), kMajor));
}

}  // namespace

void refuseJson(const std::string& place, const std::string& expected, const Json& found) {
  throw Error(Error::Kind::Data, fmt::format("{}{}expected {}, found {}", place, place.empty() ? "" : ": ",
                                             expected, shortJson(found.dump(-1, ' ', true))));
}

JsonObject::JsonObject(Json value, std::string place) : value_(std::move(value)), place_(std::move(place)) {
  if (!value_.is_object()) refuseJson(place_, "an object", value_);
}

std::string JsonObject::placeOf(std::string_view name) const { return joined(place_, name); }

std::optional<Json> JsonObject::take(std::string_view path) { return takeFrom(value_, path, place_); }

std::string JsonObject::takeText(const char* name) {
  const std::optional<Json> taken = take(name);
  if (!taken) throw Error(Error::Kind::Data, fmt::format("{}: expected a text, found none", placeOf(name)));
  if (!taken->is_string()) refuseJson(placeOf(name), "a text", *taken);
  return taken->get<std::string>();
}

Json JsonObject::takeArray(const char* name, std::size_t most) {
  std::optional<Json> taken = take(name);
  if (!taken) return Json::array();
  if (!taken->is_array()) refuseJson(placeOf(name), "an array", *taken);
  if (taken->size() > most) {
    throw Error(Error::Kind::Data, fmt::format("{}: expected at most {} elements, found {}", placeOf(name),
                                               most, taken->size()));
  }
  return std::move(*taken);
}

std::string JsonObject::restOf(const char* name) {
  std::optional<Json> taken = take(name);
  return taken ? JsonObject(std::move(*taken), placeOf(name)).rest() : "{}";
}

void JsonObject::Reader::visit(const FieldInfo& info, FieldPointer target) {
  const std::optional<Json> taken = object_.take(info.name);
  if (!taken) return;
  const auto take = [&](bool fits, auto* to) {
    if (!fits) refuseJson(object_.placeOf(info.name), expectedText(info, *to), *taken);
    taken->get_to(*to);
  };
  if (bool* const* on = std::get_if<bool*>(&target)) take(taken->is_boolean(), *on);
  if (int* const* count = std::get_if<int*>(&target)) take(fitsInt(*taken), *count);
  if (double* const* number = std::get_if<double*>(&target)) take(taken->is_number(), *number);
  if (std::string* const* text = std::get_if<std::string*>(&target)) take(taken->is_string(), *text);
}

void putMember(OrderedJson& object, std::string_view path, OrderedJson value) {
  const std::size_t dot = path.find('.');
  OrderedJson& member = object[std::string(path.substr(0, dot))];
  if (dot == std::string_view::npos) {
    member = std::move(value);
  } else {
    putMember(member, path.substr(dot + 1), std::move(value));
  }
}

void putUnknown(OrderedJson& object, const std::string& unknown) {
  const OrderedJson more = OrderedJson::parse(unknown, nullptr, /*allow_exceptions=*/false);
  if (!more.is_object()) {
    throw Error(Error::Kind::Bug,
                fmt::format("members of a later version: expected a JSON object, found {}", unknown));
  }
  merge(object, more);
}

std::string documentText(const char* format_name, const OrderedJson& members) {
  OrderedJson document;
  document["format"] = {{"name", format_name}, {"major", kMajor}, {"minor", kMinor}};
  document.update(members);
  return document.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

std::vector<std::string> membersOf(const std::string& place, const std::string& unknown) {
  std::vector<std::string> paths;
  const Json members = Json::parse(unknown, nullptr, false);
  if (!members.is_object()) return paths;
  for (const auto& member : members.items()) paths.push_back(joined(place, member.key()));
  return paths;
}

Json parseDocument(std::string_view text, const char* format_name, std::string_view where) {
  try {
    Json document = Json::parse(text, shallowJson<Json>);
    if (!document.is_object()) refuseJson("", "an object", document);
    checkFormat(document["format"], format_name);
    document.erase("format");
    return document;
  } catch (const Json::exception& e) {
    throw Error(Error::Kind::Data, fmt::format("\"{}\" is no valid JSON: {}", where, jsonComplaint(e)));
  } catch (const Error& e) {
    throw Error(e.kind(), fmt::format("\"{}\": {}", where, e.what()));
  }
}

}  // namespace beam
