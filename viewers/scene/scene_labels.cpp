// SPDX-License-Identifier: Apache-2.0
// Words over the picture of the scene view. A widget of its own: QPainter and VTK in one OpenGL context would
// each have to restore what the other one set.
#include <QPainter>

#include <algorithm>

#include "viewers/false_color.h"
#include "viewers/focus_ring.h"
#include "viewers/scene/scene_state.h"

namespace beam {
namespace {

constexpr int kMargin_px = 10;
const QColor kBox(16, 17, 19, 200), kWords(226, 228, 232), kMark(kMarkColor.x, kMarkColor.y, kMarkColor.z);

// Inside of `area`, whatever is asked for; what is too long is cut with an ellipsis.
void paintWords(QPainter& painter, const QRect& area, QPoint at, const QString& text, const QColor& color) {
  const QFontMetrics metrics = painter.fontMetrics();
  const QString words = metrics.elidedText(text, Qt::ElideRight, area.width() - 16);
  QRect box(at, QSize(metrics.horizontalAdvance(words) + 16, metrics.height() + 8));
  box.moveLeft(std::clamp(box.left(), area.left(), std::max(area.left(), area.right() + 1 - box.width())));
  box.moveTop(std::clamp(box.top(), area.top(), std::max(area.top(), area.bottom() + 1 - box.height())));
  painter.setPen(Qt::NoPen);
  painter.setBrush(kBox);
  painter.drawRoundedRect(box, 4, 4);
  painter.setPen(color);
  painter.drawText(box, Qt::AlignCenter, words);
}

QString nameOf(const View& view) {
  return QString("camera %1 (%2)")
      .arg(QString::fromStdString(view.name), view.split == Split::Test ? "test" : "train");
}

}  // namespace

SceneLabels::SceneLabels(const SceneView::State& state, QWidget* parent) : QWidget(parent), state_(state) {
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setAttribute(Qt::WA_NoSystemBackground);
  setFocusPolicy(Qt::NoFocus);
}

void SceneLabels::setRing(bool shown) {
  ring_ = shown;
  update();
}

void SceneLabels::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  paintAxisNames(painter);
  paintLookThrough(painter);
  paintMarkedName(painter);
  if (ring_) paintFocusRing(painter, *this);
  if (!state_.influenceFits() || state_.picked_joint < 0) return;
  paintPickedJoint(painter);
  paintLegend(painter);
}

void SceneLabels::paintAxisNames(QPainter& painter) const {
  if (!state_.shown[static_cast<int>(SceneLayer::Grid)]) return;
  const std::array<const char*, 3> names{"X", "Y up", "Z"};
  for (int axis = 0; axis < 3; ++axis) {
    vec3 end(0);
    end[axis] = 0.52f * kGridExtent_m;
    const auto at = state_.onScreen(end);
    if (!at) continue;
    // A name that the border would cut is none.
    const QRectF words = QRectF(painter.fontMetrics().boundingRect(names[axis])).translated(*at);
    if (!QRectF(rect()).contains(words.adjusted(-1, -1, 2, 2))) continue;
    for (const QPointF& shadow : {QPointF(1, 1), QPointF(0, 0)}) {
      painter.setPen(shadow.isNull() ? kWords : QColor(16, 17, 19));
      painter.drawText(*at + shadow, names[axis]);
    }
  }
}

void SceneLabels::paintLookThrough(QPainter& painter) const {
  if (!state_.look_through) return;
  const View& view = state_.capture->views[state_.look_through->value];
  const double scale = std::min(static_cast<double>(width()) / view.camera.width,
                                static_cast<double>(height()) / view.camera.height);
  QRectF frame(0, 0, scale * view.camera.width, scale * view.camera.height);
  frame.moveCenter(QRectF(rect()).center());
  painter.setPen(QPen(QColor(255, 255, 255, 90), 1));
  painter.setBrush(Qt::NoBrush);
  painter.drawRect(frame.adjusted(0.5, 0.5, -0.5, -0.5));
  const QRect area = rect().adjusted(kMargin_px, kMargin_px, -kMargin_px, -kMargin_px);
  paintWords(painter, area, area.topLeft(), "through " + nameOf(view) + " · Esc or a drag leaves it", kWords);
}

void SceneLabels::paintMarkedName(QPainter& painter) const {
  constexpr int kBeside_px = 8;
  if (!state_.markShown()) return;
  const View& view = state_.capture->views[state_.marked->value];
  const auto at = state_.onScreen(vec3(centerOf(view.camera)));
  if (!at || !rect().contains(at->toPoint())) return;
  paintWords(painter, rect().adjusted(2, 2, -2, -2), at->toPoint() + QPoint(kBeside_px, kBeside_px),
             nameOf(view), kMark);
}

// A ring: a filled sign would hide the skin that the joint moves most.
void SceneLabels::paintPickedJoint(QPainter& painter) const {
  constexpr double kRadius_px = 7;
  const auto joint = static_cast<std::size_t>(state_.picked_joint);
  if (state_.trails.empty() || joint >= state_.trails.back().size() ||
      !state_.shown[static_cast<int>(SceneLayer::Joints)])
    return;
  const auto at = state_.onScreen(state_.trails.back()[joint]);
  if (!at) return;
  painter.setBrush(Qt::NoBrush);
  for (const auto& [color, pen_px] :
       {std::pair(QColor(0, 0, 0, 170), 3.5), std::pair(QColor(Qt::white), 1.5)}) {
    painter.setPen(QPen(color, pen_px));
    painter.drawEllipse(*at, kRadius_px, kRadius_px);
  }
}

void SceneLabels::paintLegend(QPainter& painter) const {
  constexpr int kPad_px = 6, kWidest_px = 260;
  const QFontMetrics metrics = painter.fontMetrics();
  const int width_px = std::min(kWidest_px, width() - 2 * kMargin_px - 2 * kPad_px);
  const int bar_px = std::max(10, metrics.height() / 2);
  QRect box(0, 0, width_px + 2 * kPad_px, metrics.height() + bar_px + 3 * kPad_px);
  if (width_px < 2 * bar_px || box.height() > height()) return;
  box.moveBottomLeft(QPoint(kMargin_px, height() - std::min(kMargin_px, height() - box.height())));
  painter.setPen(Qt::NoPen);
  painter.setBrush(kBox);
  painter.drawRoundedRect(box, 4, 4);
  const QRect inside = box.adjusted(kPad_px, kPad_px, -kPad_px, -kPad_px);
  const QRect bar(inside.left(), inside.bottom() + 1 - bar_px, inside.width(), bar_px);
  for (int x = 0; x < bar.width(); ++x) {
    const u8vec3 c = falseColor(static_cast<float>(x) / static_cast<float>(bar.width() - 1));
    painter.fillRect(bar.left() + x, bar.top(), 1, bar.height(), QColor(c.x, c.y, c.z));
  }
  painter.setPen(kWords);
  const QRect words(inside.left(), inside.top(), inside.width(), metrics.height());
  const int ends_px = metrics.horizontalAdvance("0  1  ");
  painter.drawText(words, Qt::AlignLeft, "0");
  painter.drawText(words, Qt::AlignRight, "1");
  painter.drawText(words, Qt::AlignHCenter,
                   metrics.elidedText(QString("share of joint %1").arg(state_.picked_joint), Qt::ElideRight,
                                      inside.width() - ends_px));
}

}  // namespace beam
