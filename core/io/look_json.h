// SPDX-License-Identifier: Apache-2.0
// Looks as JSON: in files of their own, in scenes, in projects. What describe() lists is there under its
// path, "lights" is an array of {"id", "kind", ...}, "curves" an object of {"keys": [{"time_s", ...}]} by
// path. Members of a later version, lights of unknown kinds and words that are not among the choices of
// their field come back as they were.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/look.h"

namespace beam {

std::string toJson(const Look& look);
// Throws Error{Data} that names `where`, the place in it, what was expected and found; also for a look that
// is not valid or of a newer major format. A look without a name has an empty one.
Look parseLook(std::string_view json, std::string_view where);

// Paths of its members that this program does not know, "environment.gian": they are kept and have no effect.
std::vector<std::string> unknownMembers(const Look& look);

// For a document that holds several: an array. Their order is kept.
std::string looksToJson(const std::vector<Look>& looks);
// Throws Error{Data} that begins with the place, "looks[1].lights[0]: ...", also for more than kMostLooks, a
// name that is none (isLookName) or is there twice.
std::vector<Look> parseLooks(std::string_view json);

}  // namespace beam
