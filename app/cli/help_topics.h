// SPDX-License-Identifier: Apache-2.0
// What `beam help TOPIC` says: subjects that several commands share. Lists come from the tables of the
// program.
#pragma once

#include <string>
#include <vector>

namespace beam {

struct HelpTopic {
  const char* name;
  const char* summary;
  std::string (*text)();
};

const std::vector<HelpTopic>& helpTopics();

}  // namespace beam
