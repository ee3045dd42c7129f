// SPDX-License-Identifier: Apache-2.0
#include "viewers/image/image_view.h"

#include <QPainter>

#include <algorithm>
#include <cmath>

namespace beam {
namespace {

constexpr double kCrispFrom = 2;  // zoom at which pixels become squares
constexpr double kBeside_px = 10;

bool sameColours(const Picture& own, const Picture* other) {
  return other != nullptr && own.false_color && other->false_color && other->unit == own.unit;
}

// Same limits on both sides, so that colours compare: those of `other` where it has some of the same unit.
Limits limitsFor(const Picture& own, const Picture* other, const std::map<std::string, Limits>& locked) {
  if (!own.false_color) return {};
  if (const auto held = locked.find(own.unit); held != locked.end()) return held->second;
  return own.unit.empty() ? Limits{} : robustLimits((sameColours(own, other) ? *other : own).values.values);
}

bool same(const Limits& a, const Limits& b) { return a.low == b.low && a.high == b.high; }

void setLock(std::map<std::string, Limits>& locks, const std::string& unit, std::optional<Limits> limits) {
  if (limits) {
    locks[unit] = *limits;
  } else {
    locks.erase(unit);
  }
}

}  // namespace

ImageView::ImageView(QWidget* parent) : PictureCanvas(parent) {}
ImageView::~ImageView() = default;

void ImageView::setPicture(int side, const QString& label, PictureLoader loader, bool badged) {
  sides_[side].badged = badged;
  sides_[side].label = label;
  sides_[side].note.clear();
  sides_[side].loader = std::move(loader);
  sides_[side].picture = nullptr;
  sides_[side].pixels = nullptr;
  refresh(side);
  compare();
}

ImageView::Answer ImageView::answerOf(const PictureLoader& loader, std::shared_ptr<const Picture> loaded,
                                      const std::shared_ptr<const Picture>& other, float exposure_stops,
                                      const Locks& locked) {
  Answer answer;
  try {
    answer.picture = loaded ? std::move(loaded) : std::make_shared<const Picture>(loader());
    answer.limits = limitsFor(*answer.picture, other.get(), locked);
    answer.pixels =
        std::make_shared<Image<u8vec4>>(displayed(*answer.picture, exposure_stops, answer.limits));
  } catch (const std::exception& e) {  // the border of this thread: said in the view
    answer.note = QString::fromStdString(e.what());
  }
  return answer;
}

void ImageView::refresh(int side) {
  Side& s = sides_[side];
  const std::uint64_t ticket = ++s.ticket;
  if (!s.loader) {
    s.seen = ticket;
    arrange();
    Q_EMIT legendChanged();
    return;
  }
  const std::shared_ptr<const Picture> other = side == 1 ? sides_[0].picture : nullptr;
  workers_[side].submit([this, side, ticket, other, loader = s.loader, loaded = s.picture,
                         exposure = exposure_stops_, locked = locked_] {
    const Answer answer = answerOf(loader, loaded, other, exposure, locked);
    QMetaObject::invokeMethod(
        this, [this, side, ticket, answer] { take(side, ticket, answer); }, Qt::QueuedConnection);
  });
}

void ImageView::take(int side, std::uint64_t ticket, const Answer& answer) {
  Side& s = sides_[side];
  if (s.ticket != ticket) return;
  s.seen = ticket;
  s.picture = answer.picture;
  s.pixels = answer.pixels;
  s.limits = answer.limits;
  s.note = answer.note;
  arrange();
  compare();
  // B was encoded before A was there to give the limits.
  const Side& b = sides_[1];
  if (side == 0 && s.picture && b.picture && sameColours(*s.picture, b.picture.get()) &&
      !same(s.limits, b.limits)) {
    refresh(1);
  }
  Q_EMIT legendChanged();
  Q_EMIT pictureShown();
}

bool ImageView::settled() const {
  return compare_seen_ == compare_ticket_ &&
         std::all_of(sides_.begin(), sides_.end(), [](const Side& s) { return s.seen == s.ticket; });
}

ImageView::Compared ImageView::comparedOf(Compared c, const Locks& locked) {
  try {
    if (!c.difference) {
      const auto masked = std::find_if(c.of.begin(), c.of.end(),
                                       [](const auto& picture) { return static_cast<bool>(picture->mask); });
      const bool comparable = incomparable(*c.of[0], *c.of[1]).empty();
      c.difference = std::make_shared<const Difference>(
          differenceOf(*c.of[0], *c.of[1],
                       comparable && masked != c.of.end() ? (*masked)->mask() : Image<std::uint8_t>()));
    }
    const auto held = locked.find(c.difference->map.unit);
    c.limits = held != locked.end() ? held->second : limitsOf(*c.difference);
    c.pixels = std::make_shared<Image<u8vec4>>(displayed(*c.difference, c.limits));
  } catch (const std::exception& e) {  // the border of this thread: said in the view
    c.note = QString::fromStdString(e.what());
  }
  return c;
}

// Made of the pictures as they are, not as exposed; what is known of the same two is kept.
void ImageView::compare() {
  const std::uint64_t ticket = ++compare_ticket_;
  const std::array<std::shared_ptr<const Picture>, 2> pair{sides_[0].picture, sides_[1].picture};
  if (compared_.of != pair)
    compared_ = {.of = pair, .difference = {}, .limits = {}, .pixels = {}, .note = {}};
  arrange();
  if (!comparing()) {
    compare_seen_ = ticket;
    return;
  }
  compare_worker_.submit([this, ticket, known = compared_, locked = locked_differences_] {
    const Compared answer = comparedOf(known, locked);
    QMetaObject::invokeMethod(
        this,
        [this, ticket, answer] {
          if (ticket != compare_ticket_) return;
          compare_seen_ = ticket;
          compared_ = answer;
          arrange();
          Q_EMIT legendChanged();
          Q_EMIT pictureShown();
        },
        Qt::QueuedConnection);
  });
}

void ImageView::arrange() {
  PictureCanvas::setPicture(0, showsDifference() ? compared_.pixels : sides_[0].pixels);
  PictureCanvas::setPicture(1, sides_[1].pixels);
}

void ImageView::setWipe(bool on) {
  if (wipe_on_ == on) return;
  wipe_on_ = on;
  if (on) setDifference(false);
  update();
  Q_EMIT wipeChanged(on);
}

void ImageView::setDifference(bool on) {
  if (difference_on_ == on) return;
  difference_on_ = on;
  if (on) setWipe(false);
  compare();
  Q_EMIT differenceChanged(on);
  Q_EMIT legendChanged();
}

void ImageView::setExposure(float stops) {
  const float bounded = std::clamp(stops, -10.0f, 10.0f);
  if (bounded == exposure_stops_) return;
  exposure_stops_ = bounded;
  refresh(0);
  refresh(1);
  Q_EMIT exposureChanged(bounded);
}

void ImageView::fit() {
  zoom_ = 0;
  update();
}

void ImageView::swapSides() {
  std::swap(sides_[0].label, sides_[1].label);
  std::swap(sides_[0].loader, sides_[1].loader);
  std::swap(sides_[0].picture, sides_[1].picture);
  std::swap(sides_[0].pixels, sides_[1].pixels);
  std::swap(sides_[0].limits, sides_[1].limits);
  std::swap(sides_[0].note, sides_[1].note);
  std::swap(sides_[0].badged, sides_[1].badged);
  refresh(0);
  refresh(1);
  compare();
  Q_EMIT sidesSwapped();
}

void ImageView::resetState() {
  exposure_stops_ = 0;
  locked_.clear();
  locked_differences_.clear();
  wipe_share_ = 0.5;
  setWipe(false);
  setDifference(false);
  setBadge({});
  for (int side = 0; side < 2; ++side) setPicture(side, {}, {});
  fit();
  Q_EMIT legendChanged();
}

const ImageView::Side* ImageView::falseColored() const {
  const auto found = std::find_if(sides_.begin(), sides_.end(),
                                  [](const Side& s) { return s.picture && s.picture->false_color; });
  return found == sides_.end() ? nullptr : &*found;
}

LegendState ImageView::legend() const {
  if (apart()) {
    if (!compared_.pixels) return {};
    const std::string& unit = compared_.difference->map.unit;
    return {true, locked_differences_.contains(unit), compared_.limits, QString::fromStdString(unit)};
  }
  const Side* side = falseColored();
  if (side == nullptr) return {};
  const std::string& unit = side->picture->unit;
  return {true, locked_.contains(unit), side->limits, QString::fromStdString(unit)};
}

void ImageView::lockLimits(std::optional<Limits> limits) {
  const LegendState state = legend();
  if (!state.shown) return;
  const std::string unit = state.unit.toStdString();
  if (apart()) {
    setLock(locked_differences_, unit, limits);
    return compare();
  }
  setLock(locked_, unit, limits);
  refresh(0);
  refresh(1);
}

QString ImageView::verdict() const {
  if (!difference_on_) return {};
  if (!compared_.note.isEmpty()) return "No difference: " + compared_.note;
  if (comparing()) {
    return compared_.difference ? QString::fromStdString(describe(*compared_.difference))
                                : "Comparing A and B";
  }
  for (const Side& s : sides_) {
    if (!s.note.isEmpty()) return "No difference: " + s.note;
    if (!s.loader) return "No difference: choose a picture for A and one for B.";
  }
  return "Reading A and B";
}

const Picture* ImageView::anyPicture() const {
  return sides_[0].picture ? sides_[0].picture.get() : sides_[1].picture.get();
}

QRectF ImageView::pictureRect() const {
  const Picture* p = anyPicture();
  if (p == nullptr) return {};
  const double w = p->values.width, h = p->values.height;
  if (zoom_ == 0) {
    const double scale = std::min((width() - 24) / w, (height() - 24) / h);
    return {QPointF((width() - scale * w) / 2, (height() - scale * h) / 2), QSizeF(scale * w, scale * h)};
  }
  return {QPointF(width() / 2.0 - zoom_ * center_.x(), height() / 2.0 - zoom_ * center_.y()),
          QSizeF(zoom_ * w, zoom_ * h)};
}

PictureLayout ImageView::pictureLayout() const {
  PictureLayout layout;
  const QRectF target = pictureRect();
  layout.target = {target, target};
  const Picture* p = anyPicture();
  layout.crisp = p != nullptr && target.width() >= kCrispFrom * p->values.width;
  if (peek_ || !sides_[0].picture) {
    layout.over_opacity = 1;
  } else if (showsWipe()) {
    layout.wipe_x = wipe_share_ * width();
  }
  return layout;
}

QString ImageView::sideText(int side) const {
  const Side& s = sides_[side];
  QString text =
      (side == 0 ? "A  " : "B  ") + (s.picture ? QString::fromStdString(s.picture->label) : s.label);
  const bool exposed = s.picture && s.picture->encoding != Encoding::Data;
  if (exposure_stops_ != 0 && exposed) text += QString::asprintf(" · exposure %+.1f stops", exposure_stops_);
  return text;
}

// Of both; what they have in common, mostly camera and frame, stands once.
QString ImageView::pairText() const {
  QStringList a = sideText(0).split(" · "), b = sideText(1).split(" · "), common;
  while (a.size() > 1 && b.size() > 1 && a.last() == b.last()) {
    common.prepend(a.takeLast());
    b.removeLast();
  }
  return (a + b + common).join(" · ");
}

QString ImageView::footText() const {
  QStringList notes;
  for (const Side& s : sides_) {
    if (!s.note.isEmpty()) notes << s.note;
  }
  if (notes.isEmpty()) return apart() ? QString() : verdict();
  return notes.join("\n");
}

void ImageView::paintOver(QPainter& painter) {
  const QString foot = footText();
  if (anyPicture() == nullptr) {
    const QRectF area = rect();
    if (!settled()) {
      paintMessage(painter, area, "Reading", sides_[0].label);
    } else if (foot.isEmpty() || !(sides_[0].loader || sides_[1].loader)) {
      paintMessage(painter, area, "No picture chosen", "Choose a camera and a picture above.");
    } else {
      paintMessage(painter, area, "This picture cannot be shown", foot);
    }
    return;
  }
  if (showsWipe() && !peek_) {
    const double x = wipe_share_ * width();
    painter.setPen(QPen(QColor(255, 255, 255, 210), 1.5));
    painter.drawLine(QPointF(x, 0), QPointF(x, height()));
    painter.setBrush(QColor(255, 255, 255, 230));
    painter.setPen(Qt::NoPen);
    painter.drawEllipse(QPointF(x, height() / 2.0), 6, 6);
  }
  paintTitles(painter);
  paintFoot(painter, foot);
  const LegendState colors = legend();
  if (colors.shown && (!apart() || showsDifference())) paintLegend(painter, colors.limits, colors.unit);
}

void ImageView::paintTitles(QPainter& painter) {
  if (showsWipe() && !peek_) {
    const double x = wipe_share_ * width();
    const QRectF left = paintLabel(painter, {x - kBeside_px, kBeside_px}, Qt::AlignRight | Qt::AlignTop,
                                   sideText(0), {.width_px = x - 2 * kBeside_px});
    const QRectF right = paintLabel(painter, {x + kBeside_px, kBeside_px}, Qt::AlignLeft | Qt::AlignTop,
                                    sideText(1), {.width_px = width() - x - 2 * kBeside_px});
    titleIs(left | right);
    if (sides_[0].badged || sides_[1].badged)
      paintBadge(painter, (left | right).bottom(), sides_[0].badged ? 0 : x, sides_[1].badged ? width() : x);
    return;
  }
  const int side = peek_ || !sides_[0].picture ? 1 : 0;
  const QString title = apart() && !peek_ ? "|A − B| · " + pairText() + "\n" + verdict() : sideText(side);
  titleIs(paintLabel(painter, {kBeside_px, kBeside_px}, Qt::AlignLeft | Qt::AlignTop, title,
                     {.width_px = columnWidth()}));
  if (sides_[side].badged || (apart() && !peek_ && sides_[1].badged))
    paintBadge(painter, words().title.bottom(), 0, width());
}

}  // namespace beam
