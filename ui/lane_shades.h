// SPDX-License-Identifier: Apache-2.0
// What a cell of the timeline shows, and how: each state by a shape that is seen without colours, too, and
// where many frames share a pixel the one that asks for attention.
#pragma once

#include <QColor>
#include <QRectF>
#include <QString>

#include <string>
#include <vector>

#include "core/pipeline/take_survey.h"

class QPainter;

namespace beam {

// What the run that is going on has before it; the survey knows only what is on the disk.
struct RunOverlay {
  std::vector<int> frames;  // in the run; empty: no run
  std::string until;        // its last stage; empty: all
  std::string running_stage;
  int running_frame = -1;  // -1: a step of the whole project
  bool active = false;
};

enum class LaneShade { Empty, Queued, Running, Done, Stale, Failed, Blocked, Interpolated };
constexpr int kLaneShades = 8;

// What lane `lane` shows of a frame.
LaneShade shadeOf(const TakeSurvey& survey, std::size_t lane, int frame, const RunOverlay& run);
// "to do", "stale: made with other settings", ...
QString wordsOf(LaneShade shade);

// A stretch of a lane, in device pixels from its left end: [begin, end).
struct LanePiece {
  int begin = 0, end = 0;
  LaneShade shade = LaneShade::Empty;
  bool operator==(const LanePiece&) const = default;
};
// Frames of `shades` over `pixels`: a piece a frame where these are wide enough to tell apart, else stretches
// of equal columns, each column the worst of all frames that reach into it.
std::vector<LanePiece> lanePieces(const std::vector<LaneShade>& shades, int pixels);

// The lane's box, its pieces in it; `overshoot`: how far a failed piece reaches above and below it.
void paintLane(QPainter& painter, const QRectF& box, const std::vector<LanePiece>& pieces, double pixel,
               double overshoot);
// Every state with its sign and words, as rich text for a tooltip.
QString laneLegend(int line_px);

}  // namespace beam
