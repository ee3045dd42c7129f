// SPDX-License-Identifier: Apache-2.0
// The quality report as one self-contained HTML page: style, curves (SVG) and pictures (JPEG) inside, nothing
// to load, no script. Well-formed XML too. A pure function of what it shows.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/contact_sheet.h"
#include "app/cli/quality_history.h"

namespace beam {

struct ReportPage {
  std::string project, version;
  std::vector<std::pair<std::string, std::string>> facts;     // label, words
  std::vector<std::pair<std::string, std::string>> settings;  // what differs: key, value
  std::size_t frames_in_capture = 0;
  QualityHistory history;
  std::vector<ContactRow> pictures;
  // The last evaluation of the project: map, scores by name.
  std::vector<std::pair<std::string, std::map<std::string, double>>> evaluation;
};

std::string toHtml(const ReportPage& page);

}  // namespace beam
