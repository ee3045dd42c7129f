// SPDX-License-Identifier: Apache-2.0
// The quality report as one self-contained HTML page: style, curves (SVG) and pictures (JPEG) inside, nothing
// to load, no script. Well-formed XML too. A pure function of what it shows.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/pipeline/stage.h"
#include "core/work/contact_sheet.h"
#include "core/work/quality_history.h"
#include "core/work/scores.h"

namespace beam {

struct ReportSetting {
  std::string label, key, value, unit;  // the key as typed; unit: empty without
};

struct ReportPage {
  std::string project, version;
  std::vector<StageInfo> stages;                           // whose steps and scores the page names
  std::vector<std::pair<std::string, std::string>> facts;  // label, words
  std::vector<ReportSetting> settings;                     // what differs from the preset
  std::size_t frames_in_capture = 0;
  QualityHistory history;
  std::vector<ContactRow> pictures;
  ScoreTable evaluation;        // the last one of the project
  std::string evaluation_note;  // that it is of other results than the page's; empty: it is of these
};

inline constexpr const char* kReportCommand = "report";  // pages say that it wrote them
std::string toHtml(const ReportPage& page);

}  // namespace beam
