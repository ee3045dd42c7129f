// SPDX-License-Identifier: Apache-2.0
#include "core/stages/track_files.h"

#include <nlohmann/json.hpp>

#include "core/base/json_words.h"
#include "core/io/file.h"
#include "core/stages/unclear_file.h"

namespace beam {
namespace {

constexpr const char* kNoteFile = "track.json";

}  // namespace

void writeTrackNote(const std::filesystem::path& folder, const TrackNote& note) {
  const nlohmann::json json = {{"restarted", note.restarted},
                               {"reference_residual", note.reference_residual}};
  writeFileAtomically(folder / kNoteFile, json.dump(1) + "\n");
}

TrackNote readTrackNote(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kNoteFile;
  try {
    const nlohmann::json json = nlohmann::json::parse(readTextFile(file));
    return {json.at("restarted").get<bool>(), json.at("reference_residual").get<double>()};
  } catch (const nlohmann::json::exception& e) {
    throw unclearFile(file, jsonComplaint(e));
  }
}

}  // namespace beam
