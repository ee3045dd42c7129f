// SPDX-License-Identifier: Apache-2.0
#include "app/cli/typed_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/word_list.h"

namespace beam {

const std::vector<TypedWords>& typedWords() {
  static const std::vector<TypedWords> all = {
      {{"import", "add", "create", "init"}, {"beam new", "beam check"}},
      {{"train", "fit", "solve", "compute", "start", "resume", "continue"}, {"beam run"}},
      {{"convert", "save", "write"}, {"beam export"}},
      {{"relight", "relit", "light"}, {"beam render --channels relight --environment FILE"}},
      {{"draw", "picture", "pictures"}, {"beam render"}},
      {{"view", "open", "gui", "window", "viewer"}, {"beam-studio"}},
      {{"info", "show", "list", "ls"}, {"beam status"}},
      {{"delete", "remove", "rm", "gc", "prune", "purge"}, {"beam clean"}},
      {{"metrics", "score", "scores", "eval", "compare"}, {"beam evaluate"}},
      {{"validate", "verify", "inspect"}, {"beam check"}},
      {{"settings", "config", "presets", "parameters"}, {"beam stages"}},
      {{"demo", "synthetic", "generate"}, {"beam sample"}},
      {{"summary", "html"}, {"beam report"}},
      {{"man", "usage"}, {"beam help"}}};
  return all;
}

std::optional<std::string> meantBy(std::string_view word) {
  const std::string typed = lowerCase(word);
  for (const TypedWords& known : typedWords()) {
    if (std::find(known.words.begin(), known.words.end(), typed) != known.words.end())
      return fmt::format("{}", fmt::join(known.lines, " or "));
  }
  return std::nullopt;
}

}  // namespace beam
