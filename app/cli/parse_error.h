// SPDX-License-Identifier: Apache-2.0
// What the user is told of words that could not be parsed, as a sentence.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace beam {

// "beam run: there is no flag "--frame"; did you mean "--frames"? See beam run --help". `app` has parsed.
std::string parseErrorText(const CLI::App& app, const CLI::ParseError& error);

}  // namespace beam
