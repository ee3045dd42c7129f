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
  std::size_t frames = 0;  // that the page is about
  // A sentence each, as the page has them: cameras left out of the fit, what that cost, cameras that do not
  // fit the others.
  std::vector<std::string> findings;
};

// Throws Error{Usage} for a place that requireFileTarget refuses, Error{Data} when no frame has a result,
// Error{Storage}, Cancelled: then nothing is written.
ReportOutcome report(const ReportRequest& request, ComputeDevice& device, Progress& progress);

}  // namespace beam
