// SPDX-License-Identifier: Apache-2.0
// The quality of a project over time as one HTML page (report_page.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/pipeline/project.h"
#include "core/render/device.h"

namespace beam {

struct ReportRequest {
  Project project;
  std::filesystem::path out;  // the page
  bool force = false;         // of OutputRule
  bool strict = false;        // of WantedResults
};

struct ReportOutcome {
  std::size_t solved = 0;  // frames, of those that the page is about
  std::size_t frames = 0;  // with a result or a failure
  // A sentence each, as the page has them: cameras left out of the fit, what that cost, cameras that do not
  // fit the others, an evaluation of other results.
  std::vector<std::string> findings;
};

// Throws Error{Usage} for a place that requireFileTarget refuses, Error{Data} when no frame is solved,
// Error{Storage}, Cancelled: then nothing is written.
ReportOutcome report(const ReportRequest& request, ComputeDevice& device, Progress& progress);

}  // namespace beam
