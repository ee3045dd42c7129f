// SPDX-License-Identifier: Apache-2.0
// Two programs that change one project.json: what each changed stays.
#pragma once

#include <string>
#include <vector>

#include "core/pipeline/project_document.h"

namespace beam {

struct MergedDocument {
  ProjectDocument document;
  std::vector<std::string> both;  // what both changed to different values, in words: ours holds
};

// `ours` and `theirs` both come from `base`. Settings are merged one by one, looks by their names; takes are
// theirs, for they change on the disk alone.
MergedDocument merged(const ProjectDocument& base, const ProjectDocument& ours,
                      const ProjectDocument& theirs);

}  // namespace beam
