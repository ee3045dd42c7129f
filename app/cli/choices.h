// SPDX-License-Identifier: Apache-2.0
// The closed sets of words that flags take: a flag of one of these names takes them in every command.
#pragma once

#include "app/services.h"

namespace CLI {
class App;
}

namespace beam {

// After all commands were added.
void addChoices(CLI::App& app, const Services& services);

}  // namespace beam
