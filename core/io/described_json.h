// SPDX-License-Identifier: Apache-2.0
// Values that describe() themselves <-> JSON objects, where "color.r" is the member r of the object color;
// for sources of core/io only. What is not taken while reading is of a later version and goes back in when
// the value is written. Messages begin with the place in the document: "lights[1].color: expected ...".
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/fields.h"

namespace beam {

// An object while it is read.
class JsonObject {
 public:
  // Throws Error{Data} unless `value` is an object.
  JsonObject(nlohmann::json value, std::string place);

  // Takes every field that is there; others keep what they have. Throws Error{Data} for a value of another
  // type; ranges and choices are not looked at.
  template <class T>
  void read(T& value) {
    Reader reader(*this);
    describe(reader, value);
  }
  // Takes the member of that path, and the objects around it that it leaves empty. None: it is not there.
  std::optional<nlohmann::json> take(std::string_view path);
  // Takes a text; throws Error{Data} when it is of another type, or not there.
  std::string takeText(const char* name);
  // Takes an array; an empty one when it is not there. Throws Error{Data} for another type and for more than
  // `most` elements.
  nlohmann::json takeArray(const char* name, std::size_t most);
  // What is left, for the `unknown` of a value.
  std::string rest() const { return value_.dump(); }
  // What is left of a member that is an object, likewise; takes it.
  std::string restOf(const char* name);
  // "lights[1].color" for the member color.
  std::string placeOf(std::string_view name) const;

 private:
  class Reader final : public Fields {
   public:
    explicit Reader(JsonObject& object) : object_(object) {}

   protected:
    void visit(const FieldInfo& info, FieldPointer target) override;

   private:
    JsonObject& object_;
  };

  nlohmann::json value_;
  std::string place_;
};

// Throws Error{Data}: "<place>: expected <expected>, found <found>"; without a place for the whole document.
[[noreturn]] void refuseJson(const std::string& place, const std::string& expected,
                             const nlohmann::json& found);

// Paths of the members of an `unknown` of a value at that place.
std::vector<std::string> membersOf(const std::string& place, const std::string& unknown);

// Sets the member of that path, in objects that are made where they are missing.
void putMember(nlohmann::ordered_json& object, std::string_view path, nlohmann::ordered_json value);
// Members of a later version, of objects inside as well; what is there already stays.
void putUnknown(nlohmann::ordered_json& object, const std::string& unknown);

template <class T>
nlohmann::ordered_json jsonOfFields(const T& value) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const Field& field : fieldsOf(value)) {
    std::visit([&](const auto& v) { putMember(object, field.info.name, v); }, field.value);
  }
  return object;
}

// Documents of their own. Their first member tells what they are: "format": {"name", "major", "minor"}.
std::string documentText(const char* format_name, const nlohmann::ordered_json& members);
// Its members without the format. Throws Error{Data} that names `where`: no JSON, nested deeper than any of
// ours, of another format, or of a newer major one.
nlohmann::json parseDocument(std::string_view text, const char* format_name, std::string_view where);

// body(members), whose complaints name `where`, too.
template <class Body>
auto readDocument(std::string_view text, const char* format_name, std::string_view where, Body&& body) {
  nlohmann::json members = parseDocument(text, format_name, where);
  try {
    return body(std::move(members));
  } catch (const Error& e) {
    throw Error(e.kind(), fmt::format("\"{}\": {}", where, e.what()));
  }
}

}  // namespace beam
