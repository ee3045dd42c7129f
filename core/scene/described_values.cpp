// SPDX-License-Identifier: Apache-2.0
#include "core/scene/described_values.h"

#include <array>

#include "core/base/error.h"

namespace beam {
namespace {

struct Part {
  const char *name, *word;
};

void describeParts(Fields& f, std::string_view name, const FieldInfo& of_whole,
                   const std::array<Part, 3>& parts, dvec3& value) {
  f.group(name, [&] {
    for (int i = 0; i < 3; ++i) {
      FieldInfo info = of_whole;
      info.name = parts[i].name;
      info.label = of_whole.label + ", " + parts[i].word;
      f.field(std::move(info), value[i]);
    }
  });
}

}  // namespace

void describeColor(Fields& f, std::string_view name, const FieldInfo& of_whole, dvec3& color) {
  FieldInfo info = of_whole;
  info.min = 0;
  describeParts(f, name, info, {{{"r", "red"}, {"g", "green"}, {"b", "blue"}}}, color);
}

void describePosition(Fields& f, std::string_view name, const FieldInfo& of_whole, dvec3& position_m) {
  FieldInfo info = of_whole;
  info.unit = std::string("m");
  describeParts(f, name, info, {{{"x", "X"}, {"y", "Y"}, {"z", "Z"}}}, position_m);
}

void describeFile(Fields& f, std::string_view name, const FieldInfo& of_whole, FileReference& file) {
  f.group(name, [&] {
    FieldInfo info = of_whole;
    info.name = "relative";
    info.label = of_whole.label + ", beside the document";
    f.field(info, file.relative);
    info.name = "absolute";
    info.label = of_whole.label;
    f.field(std::move(info), file.absolute);
  });
}

void validateFields(const std::vector<Field>& fields) {
  for (const Field& field : fields) {
    if (std::holds_alternative<std::string>(field.value)) continue;
    try {
      checkRange(field.info, field.value);
    } catch (const Error& e) {
      throw Error(Error::Kind::Data, e.what());
    }
  }
}

}  // namespace beam
