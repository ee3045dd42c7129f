// SPDX-License-Identifier: Apache-2.0
#include "viewers/gl/painted_words.h"

#include <QFontInfo>
#include <QPainter>

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

constexpr QRgb kBox = qRgba(16, 17, 19, 200), kWords = qRgb(226, 228, 232);
constexpr QRgb kWarningBox = qRgba(255, 190, 70, 235), kWarningWords = qRgb(32, 22, 4);
constexpr double kPadX_px = 8, kPadY_px = 4;
constexpr int kMostLines = 9;  // a message of an error may be long; the picture stays in view
constexpr double kBar_px = 14, kHighestBar_px = 180;
constexpr int kMostTicks = 4;

}  // namespace

QStringList labelLines(const QFontMetricsF& metrics, const QString& text, double width_px) {
  QStringList lines;
  QString line;
  const auto close = [&] {
    if (!line.isEmpty()) lines << line;
    line.clear();
  };
  // Whether `more` found room on the line.
  const auto grow = [&](const QString& between, const QString& more) {
    const QString grown = line.isEmpty() ? more : line + between + more;
    if (metrics.horizontalAdvance(grown) > width_px) return false;
    line = grown;
    return true;
  };
  for (const QString& paragraph : text.split('\n')) {
    for (const QString& part : paragraph.split(" · ")) {
      if (grow(" · ", part)) continue;
      close();
      for (const QString& word : part.split(' ')) {
        if (grow(" ", word)) continue;
        close();
        line = metrics.elidedText(word, Qt::ElideMiddle, width_px);
      }
    }
    close();
  }
  if (lines.size() > kMostLines) {
    lines = lines.mid(0, kMostLines);
    lines.last() = metrics.elidedText(lines.last() + " …", Qt::ElideRight, width_px);
  }
  return lines;
}

QRectF paintLabel(QPainter& painter, QPointF at, Qt::Alignment alignment, const QString& text,
                  const LabelStyle& style) {
  const QFontMetricsF metrics(painter.fontMetrics());
  const double room = style.width_px - 2 * kPadX_px;
  if (text.isEmpty() || room < metrics.horizontalAdvance("…")) return {};
  const QStringList lines = labelLines(metrics, text, room);
  double widest = 0;
  for (const QString& line : lines) widest = std::max(widest, metrics.horizontalAdvance(line));
  const double line_height = std::ceil(metrics.height());
  QRectF box(at, QSizeF(std::ceil(std::min(widest, room)) + 2 * kPadX_px,
                        line_height * lines.size() + 2 * kPadY_px));
  if (alignment & Qt::AlignRight) box.moveRight(at.x());
  if (alignment & Qt::AlignHCenter) box.moveLeft(at.x() - box.width() / 2);
  if (alignment & Qt::AlignBottom) box.moveBottom(at.y());
  const bool warns = style.tone == LabelTone::Warning;
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor::fromRgba(warns ? kWarningBox : kBox));
  painter.drawRoundedRect(box, 4, 4);
  painter.setPen(QColor::fromRgba(warns ? kWarningWords : kWords));
  for (int i = 0; i < lines.size(); ++i) {
    const QRectF where(box.left() + kPadX_px, box.top() + kPadY_px + i * line_height,
                       box.width() - 2 * kPadX_px, line_height);
    painter.drawText(where, Qt::AlignLeft | Qt::AlignVCenter | Qt::TextDontClip, lines[i]);
  }
  return box;
}

QString scaleText(float value, const Limits& limits, const QString& unit) {
  const double range = static_cast<double>(limits.high) - limits.low;
  const int digits = range > 0 ? std::clamp(2 - static_cast<int>(std::floor(std::log10(range))), 0, 5) : 2;
  const QString number = QString::number(value, 'f', digits);
  return unit.isEmpty() ? number : unit == "°" ? number + unit : number + " " + unit;
}

double scaleWidth(const QPainter& painter, const Limits& limits, const QString& unit) {
  const QFontMetricsF metrics(painter.fontMetrics());
  double widest = 0;
  for (int tick = 0; tick <= kMostTicks; ++tick) {
    const float value = std::lerp(limits.low, limits.high, static_cast<float>(tick) / kMostTicks);
    widest = std::max(widest, metrics.horizontalAdvance(scaleText(value, limits, unit)));
  }
  return std::ceil(widest) + kBar_px + 3 * kPadX_px;
}

QRectF paintScale(QPainter& painter, const QRectF& area, const Limits& limits, const QString& unit) {
  const double line = std::ceil(painter.fontMetrics().height());
  const double margin = line / 2 + kPadY_px;  // half a value stands out above and below the bar
  const double height = std::min(kHighestBar_px, area.height() - 2 * margin);
  if (height < line) return {};
  const double width = scaleWidth(painter, limits, unit);
  const QRectF box(area.right() - width, area.top(), width, height + 2 * margin);
  const QRectF bar(box.right() - kPadX_px - kBar_px, box.top() + margin, kBar_px, height);
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor::fromRgba(kBox));
  painter.drawRoundedRect(box, 4, 4);
  for (int y = 0; y < static_cast<int>(height); ++y) {
    const u8vec3 c = falseColor(1 - static_cast<float>(y) / static_cast<float>(height));
    painter.fillRect(QRectF(bar.left(), bar.top() + y, kBar_px, 1.2), QColor(c.x, c.y, c.z));
  }
  painter.setPen(QColor::fromRgba(kWords));
  const int ticks = std::clamp(static_cast<int>(height / (1.5 * line)), 1, kMostTicks);
  for (int tick = 0; tick <= ticks; ++tick) {
    const float value = std::lerp(limits.high, limits.low, static_cast<float>(tick) / ticks);
    const QRectF where(box.left(), bar.top() + height * tick / ticks - line / 2,
                       bar.left() - box.left() - kPadX_px, line);
    painter.drawText(where, Qt::AlignRight | Qt::AlignVCenter | Qt::TextDontClip,
                     scaleText(value, limits, unit));
  }
  return box;
}

void paintMessage(QPainter& painter, const QRectF& area, const QString& title, const QString& body) {
  constexpr double kGap_px = 12;
  const int wrapped = Qt::AlignHCenter | Qt::AlignTop | Qt::TextWordWrap;
  const QFont plain = painter.font();
  QFont large = plain;
  large.setPixelSize(QFontInfo(plain).pixelSize() * 3 / 2);
  const QRectF page = area.adjusted(kPadX_px, kPadY_px, -kPadX_px, -kPadY_px);
  painter.setFont(large);
  const double title_height = painter.boundingRect(page, wrapped, title).height();
  painter.setFont(plain);
  const double body_height = body.isEmpty() ? 0 : painter.boundingRect(page, wrapped, body).height();
  // The title stands above the middle, as it did without a body; a long text begins at the top.
  const double top = std::max(page.top(), std::min(page.center().y() - kGap_px / 2 - title_height,
                                                   page.bottom() - title_height - kGap_px - body_height));
  const QRectF upper(page.left(), top, page.width(), title_height);
  painter.setFont(large);
  painter.setPen(QColor(206, 210, 216));
  painter.drawText(upper, wrapped, title);
  painter.setFont(plain);
  painter.setPen(QColor(146, 152, 160));
  painter.drawText(
      QRectF(page.left(), upper.bottom() + kGap_px, page.width(), page.bottom() - upper.bottom() - kGap_px),
      wrapped, body);
}

}  // namespace beam
