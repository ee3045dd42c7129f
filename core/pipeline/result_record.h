// SPDX-License-Identifier: Apache-2.0
// result.json: what a result is made of and how it came about. It is written last and makes the result count.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/hash.h"
#include "core/pipeline/result_key.h"

namespace beam {

struct FileEntry {
  std::uint64_t bytes = 0;
  Digest digest;
};

struct ResultRecord {
  Digest key;
  KeyIngredients ingredients;
  std::map<std::string, FileEntry> files;  // by path inside the result's folder
  std::string frame;                       // the capture's name; empty for results of the whole project
  bool lead = false;                       // made for a take that does not own the frame (Take::lead)
  std::string program_version;
  std::string device;  // and the instruction set; does not enter the key
  int threads = 0;
  double seconds = 0;
  double work = 0;                      // Project::workOf; 0: of a version that did not tell
  std::uint64_t peak_memory_bytes = 0;  // of the process so far
  std::vector<std::string> warnings;
  std::map<std::string, double> scores;
  std::map<std::string, std::string> pictures = {};  // picturesRead; of earlier versions empty
};

// The key for people: "surface.refine of frame 000002; differs from the defaults in surface.iterations =
// 500".
std::string aboutText(const ResultRecord& record);

// With aboutText beside the key, which nobody reads back.
std::string toJson(const ResultRecord& record);
// Throws Error{Data} naming what is missing.
ResultRecord parseResultRecord(std::string_view json);

// Why a step failed the last time; kept under failures/ until it succeeds.
struct FailureNote {
  StepId step;
  std::string frame, message;
};
std::string toJson(const FailureNote& note);
FailureNote parseFailureNote(std::string_view json);

}  // namespace beam
