// SPDX-License-Identifier: Apache-2.0
// Scenes of several performances as JSON files: the fields by their paths, similarities as {"rotation" (three
// rows), "scale", "translation_m"}, the look as in io/look_json.h. References are relative to the file's
// folder where they can be. Members of a later version come back as they were.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_document.h"

namespace beam {

std::string toJson(const SceneDocument& document);
// Whether it says that it is one, of whichever version; false for what is no JSON.
bool isSceneDocument(std::string_view json);
// Throws Error{Data} that names `where`, the place in it, what was expected and found; also for a document
// that is not valid or of a newer major format.
SceneDocument parseSceneDocument(std::string_view json, std::string_view where);

// As of a look (io/look_json.h), those of the scene's own look among them.
std::vector<std::string> unknownMembers(const SceneDocument& document);

}  // namespace beam
