// SPDX-License-Identifier: Apache-2.0
// How an options struct tells what it holds. One declaration, describe(Fields&, Options&), serves the command
// line, the form, JSON, the cache key, the range check and the manual; each of these is a reader of Fields.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace beam {

enum class Effect {
  Result,        // changes numbers: enters the key
  LaterResults,  // changes numbers of what is computed from then on; results that are there stay: in no key
  Pictures,      // changes what is drawn of results: in no key
  SpeedOnly,     // changes time or memory only
};

struct FieldInfo {
  std::string name;   // snake_case, dots for groups: "refine.normal_weight"
  std::string label;  // sentence case
  std::string help;   // one sentence; the paper's value and place where it has one
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string unit = "";
  Effect effect = Effect::Result;
  bool advanced = false;
  std::vector<std::string> choices = {};  // for std::string fields: the closed list
};

using FieldPointer = std::variant<bool*, int*, double*, std::string*>;

// A reader of fields. It may read or write through the pointers.
class Fields {
 public:
  virtual ~Fields() = default;
  template <class T>
  void field(FieldInfo info, T& value) {
    info.name = prefix_ + info.name;
    visit(info, FieldPointer(&value));
  }
  // Fields declared inside carry "name." before their own.
  template <class Body>
  void group(std::string_view name, Body&& body) {
    const std::string outer = prefix_;
    prefix_ += std::string(name) + ".";
    body();
    prefix_ = outer;
  }

 protected:
  virtual void visit(const FieldInfo& info, FieldPointer value) = 0;

 private:
  std::string prefix_;
};

using FieldValue = std::variant<bool, int, double, std::string>;

struct Field {
  FieldInfo info;
  FieldValue value;
};

// Lists every field with its present value, in order of declaration.
class FieldList final : public Fields {
 public:
  std::vector<Field> fields;

 protected:
  void visit(const FieldInfo& info, FieldPointer value) override;
};

// Sets one field by name; throws Error{Usage} for a wrong type or a value out of range. `found` tells whether
// a field of that name was there.
class FieldSetter final : public Fields {
 public:
  FieldSetter(std::string name, FieldValue value) : name_(std::move(name)), value_(std::move(value)) {}
  bool found = false;

 protected:
  void visit(const FieldInfo& info, FieldPointer value) override;

 private:
  std::string name_;
  FieldValue value_;
};

// Throws Error{Usage} when `value` lies outside the range or the choices of `info`.
void checkRange(const FieldInfo& info, const FieldValue& value);

// "true", "7000", "0.03" (shortest round trip), "text".
std::string toText(const FieldValue& value);

// The known name nearest to `name` by edit distance, in which two letters that changed places count once;
// empty when `known` is.
std::string nearestName(std::string_view name, const std::vector<std::string>& known);

// Likewise, where it may be what was meant: at most max(1, a third of the letters) apart.
std::optional<std::string> similarName(std::string_view name, const std::vector<std::string>& known);

// "the cameras are cam00, cam01"; of many "the cameras nearest to it are cam00, cam01 (of 60)".
std::string knownNames(std::string_view many, std::string_view name, const std::vector<std::string>& known);

// "there is no camera \"cam0\"; did you mean \"cam00\"?", and where none is similar
// "there is no camera \"door\"; " and `where`, which says where the known ones are found.
std::string noSuchName(std::string_view kind, std::string_view name, const std::vector<std::string>& known,
                       std::string_view where);

template <class Options>
std::vector<Field> fieldsOf(const Options& options) {
  Options copy = options;
  FieldList list;
  describe(list, copy);
  return std::move(list.fields);
}

}  // namespace beam
