// SPDX-License-Identifier: Apache-2.0
// Values of several scalars as fields: each scalar stands under the name of the whole ("color.r"). Label,
// help and bounds are those of the whole.
#pragma once

#include <string_view>
#include <vector>

#include "core/base/fields.h"
#include "core/base/file_reference.h"
#include "core/math/types.h"

namespace beam {

// name.r, name.g, name.b: scene-linear Rec.709, at least 0, at most of_whole.max.
void describeColor(Fields& f, std::string_view name, const FieldInfo& of_whole, dvec3& color);
// name.x, name.y, name.z: world axes, metres.
void describePosition(Fields& f, std::string_view name, const FieldInfo& of_whole, dvec3& position_m);
// name.relative, name.absolute.
void describeFile(Fields& f, std::string_view name, const FieldInfo& of_whole, FileReference& file);

// Throws Error{Data} that names the first number out of its range. A word that is not among its choices may
// be of a later version and is let through.
void validateFields(const std::vector<Field>& fields);

}  // namespace beam
