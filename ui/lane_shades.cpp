// SPDX-License-Identifier: Apache-2.0
#include "ui/lane_shades.h"

#include <QBuffer>
#include <QPainter>
#include <QPixmap>

#include <algorithm>

#include "ui/theme.h"

namespace beam {
namespace {

constexpr int kWide = 4;          // pixels of a cell that is drawn as one
constexpr int kFailedPixels = 3;  // of a failed piece, at the least
constexpr double kSign = 7;       // width from which on a piece has a sign in it

// Where several frames share a pixel the one that asks for attention is seen.
int rankOf(LaneShade shade) {
  constexpr int kRanks[kLaneShades] = {3, 4, 7, 0, 5, 8, 2, 1};  // by LaneShade
  return kRanks[static_cast<int>(shade)];
}

void drawCross(QPainter& p, const QRectF& box) {
  const double r = std::min(box.width(), box.height()) / 2 - 2;
  const QPointF c = box.center();
  p.setPen(QPen(colors().on_mark, 1.6));
  p.drawLine(c + QPointF(-r, -r), c + QPointF(r, r));
  p.drawLine(c + QPointF(-r, r), c + QPointF(r, -r));
}

void drawChevrons(QPainter& p, const QRectF& band) {
  p.setPen(QPen(colors().on_mark, 1.4));
  const double h = band.height() / 2 - 1;
  for (double x = band.left() + 2; x + h <= band.right() - 1; x += 2 * h + 2) {
    p.drawPolyline(
        QPolygonF({{x, band.center().y() - h}, {x + h, band.center().y()}, {x, band.center().y() + h}}));
  }
}

// Failed pieces are drawn after all others, and higher than the lane.
void paintFailed(QPainter& p, const QRectF& piece, double overshoot) {
  p.fillRect(piece.adjusted(0, -overshoot, 0, overshoot), colors().failed);
  if (piece.width() >= kSign) drawCross(p, piece);
}

void paintPiece(QPainter& p, const QRectF& piece, LaneShade shade, double pixel) {
  const Colors& c = colors();
  const double h = piece.height();
  switch (shade) {
    case LaneShade::Empty:  // a line at the foot
      return p.fillRect(piece.adjusted(0, h - 3, 0, 0), c.lane_empty);
    case LaneShade::Queued:  // a frame: lines above and below, and around where there is room
      p.fillRect(QRectF(piece.left(), piece.top(), piece.width(), 2), c.lane_queued);
      p.fillRect(QRectF(piece.left(), piece.bottom() - 2, piece.width(), 2), c.lane_queued);
      if (piece.width() < kSign) return;
      p.fillRect(QRectF(piece.left(), piece.top(), 1, h), c.lane_queued);
      return p.fillRect(QRectF(piece.right() - 1, piece.top(), 1, h), c.lane_queued);
    case LaneShade::Running: {  // a band in the middle, chevrons in it
      const QRectF band = piece.adjusted(0, h * 0.2, 0, -h * 0.2);
      p.fillRect(band, c.running);
      if (piece.width() >= kSign) drawChevrons(p, band);
      return;
    }
    case LaneShade::Done:  // full
      return p.fillRect(piece, c.lane_done);
    case LaneShade::Stale:  // hatched, with a dashed line on top
      p.fillRect(piece, QBrush(c.stale, Qt::BDiagPattern));
      for (double x = piece.left(); x < piece.right(); x += 6 * pixel)
        p.fillRect(QRectF(x, piece.top(), std::min(4 * pixel, piece.right() - x), 2), c.stale);
      return;
    case LaneShade::Blocked:  // dots
      return p.fillRect(piece, QBrush(c.warning, Qt::Dense6Pattern));
    case LaneShade::Interpolated:  // the lower half
      return p.fillRect(piece.adjusted(0, h / 2, 0, 0), c.lane_done);
    case LaneShade::Failed:
      break;
  }
}

}  // namespace

LaneShade shadeOf(const TakeSurvey& survey, std::size_t lane, int frame, const RunOverlay& run) {
  const SurveyLane& row = survey.lanes[lane];
  const CellState cell = row.cells[static_cast<std::size_t>(frame)];
  const bool in_run =
      run.active && std::find(run.frames.begin(), run.frames.end(), frame) != run.frames.end();
  if (run.active && row.stage == run.running_stage && cell != CellState::Done &&
      (run.running_frame == frame || (run.running_frame < 0 && in_run))) {
    return LaneShade::Running;
  }
  bool before_end = true;
  for (std::size_t i = 0; i < lane; ++i) before_end = before_end && survey.lanes[i].stage != run.until;
  switch (cell) {
    case CellState::Running:
      return LaneShade::Running;
    case CellState::Done:
      return LaneShade::Done;
    case CellState::Failed:
      return LaneShade::Failed;
    case CellState::Blocked:
      return LaneShade::Blocked;
    case CellState::Stale:
      return in_run && before_end ? LaneShade::Queued : LaneShade::Stale;
    case CellState::NotNeeded:
      return LaneShade::Empty;
    case CellState::Interpolated:
      return in_run && before_end ? LaneShade::Queued : LaneShade::Interpolated;
    case CellState::Empty:
      break;
  }
  return in_run && before_end ? LaneShade::Queued : LaneShade::Empty;
}

QString wordsOf(LaneShade shade) {
  constexpr const char* kWords[kLaneShades] = {"to do",
                                               "queued: this run will compute it",
                                               "running",
                                               "done",
                                               "stale: made with other settings",
                                               "failed",
                                               "blocked: needs something that is not there",
                                               "interpolated between solved frames"};
  return kWords[static_cast<int>(shade)];
}

std::vector<LanePiece> lanePieces(const std::vector<LaneShade>& shades, int pixels) {
  std::vector<LanePiece> pieces;
  const auto frames = static_cast<std::int64_t>(shades.size());
  if (frames == 0 || pixels <= 0) return pieces;
  if (pixels >= kWide * frames) {
    for (std::int64_t f = 0; f < frames; ++f) {
      const auto begin = static_cast<int>(f * pixels / frames),
                 end = static_cast<int>((f + 1) * pixels / frames);
      pieces.push_back({begin, end - 1, shades[static_cast<std::size_t>(f)]});  // a seam between frames
    }
    return pieces;
  }
  for (int x = 0; x < pixels; ++x) {
    // Every frame that reaches into the column, so that none falls between two.
    const std::int64_t first = x * frames / pixels, last = ((x + 1) * frames - 1) / pixels;
    LaneShade worst = shades[static_cast<std::size_t>(first)];
    for (std::int64_t f = first + 1; f <= last; ++f) {
      const LaneShade other = shades[static_cast<std::size_t>(f)];
      if (rankOf(other) > rankOf(worst)) worst = other;
    }
    if (pieces.empty() || pieces.back().shade != worst) pieces.push_back({x, x, worst});
    pieces.back().end = x + 1;
  }
  return pieces;
}

void paintLane(QPainter& p, const QRectF& box, const std::vector<LanePiece>& pieces, double pixel,
               double overshoot) {
  p.fillRect(box, colors().inside);
  const auto boxOf = [&](int begin, int end) {
    return QRectF(box.left() + begin * pixel, box.top(), (end - begin) * pixel, box.height());
  };
  for (const LanePiece& piece : pieces) paintPiece(p, boxOf(piece.begin, piece.end), piece.shade, pixel);
  const int pixels = pieces.empty() ? 0 : pieces.back().end;
  for (const LanePiece& piece : pieces) {
    if (piece.shade != LaneShade::Failed) continue;
    const int more = std::max(0, kFailedPixels - (piece.end - piece.begin));
    const int begin = std::clamp(piece.begin - more / 2, 0, std::max(0, pixels - kFailedPixels));
    paintFailed(p, boxOf(begin, std::max(piece.end, begin + kFailedPixels)), overshoot);
  }
}

QString laneLegend(int line_px) {
  QString rows;
  for (const LaneShade shade :
       {LaneShade::Done, LaneShade::Interpolated, LaneShade::Running, LaneShade::Queued, LaneShade::Empty,
        LaneShade::Stale, LaneShade::Blocked, LaneShade::Failed}) {
    QPixmap sign(2 * line_px, line_px);
    sign.fill(colors().inside);
    QPainter p(&sign);
    paintLane(p, QRectF(2, 2, sign.width() - 4, sign.height() - 4), {{0, sign.width() - 4, shade}}, 1, 2);
    p.end();
    QByteArray png;
    QBuffer buffer(&png);
    buffer.open(QIODevice::WriteOnly);
    sign.save(&buffer, "PNG");
    rows += QString("<tr><td><img src='data:image/png;base64,%1'/></td><td>&nbsp;%2</td></tr>")
                .arg(QString::fromLatin1(png.toBase64()), wordsOf(shade));
  }
  return "<table>" + rows + "</table>";
}

}  // namespace beam
