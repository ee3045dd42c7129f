// SPDX-License-Identifier: Apache-2.0
#include "ui/player.h"

#include <algorithm>

namespace beam {
namespace {

constexpr int kPoll_ms = 3;
constexpr int kAhead = 32, kBehind = 4;  // frames that are read before they are asked for
constexpr double kTell_s = 0.25;

}  // namespace

Player::Player(ProjectModel& model, std::function<bool()> follows, QObject* parent)
    : QObject(parent), model_(model), follows_(std::move(follows)) {
  elapsed_.start();
  timer_.setTimerType(Qt::PreciseTimer);
  timer_.setInterval(kPoll_ms);
  connect(&timer_, &QTimer::timeout, this, &Player::poll);
  connect(&model_, &ProjectModel::sequenceChanged, this, [this] {
    const std::shared_ptr<const GaussianSequence> sequence = model_.sequence();
    if (!sequence) return;
    pause();
    clock_.setTake(model_.frameCount(), sequence->rate());
    Q_EMIT rangeChanged();
    Q_EMIT rateChanged();
  });
  connect(&model_, &ProjectModel::stagesChanged, this, &Player::prefetch);
}

void Player::play() {
  if (!model_.sequence() || playing()) return;
  clock_.start(model_.frame().value, now());
  if (!playing()) return;
  waiting_ = true;
  told_s_ = now();
  model_.setPassing(true);
  Q_EMIT playingChanged();
  timer_.start();
  showFrame(clock_.frameAt(now()));
}

void Player::pause() {
  timer_.stop();
  if (!playing() && !waiting_) return;
  waiting_ = false;
  clock_.stop();
  model_.setPassing(false);
  Q_EMIT playingChanged();
  Q_EMIT rateChanged();
}

void Player::poll() {
  if (!timer_.isActive()) return;
  if (waiting_) {
    if (!model_.valuesReady() || !follows_()) return;
    waiting_ = false;
    clock_.shown(now());
    if (now() - told_s_ > kTell_s) {
      told_s_ = now();
      Q_EMIT rateChanged();
    }
  }
  const int due = clock_.frameAt(now());
  if (due != model_.frame().value) showFrame(due);
  if (!playing()) {
    waiting_ = true;  // pause() says that play has ended
    pause();
  }
}

void Player::showFrame(int frame) {
  waiting_ = true;
  model_.setFrame(FrameIndex{frame});
}

void Player::goTo(int frame) {
  if (!model_.sequence() || clock_.frames() == 0) return;
  pause();
  model_.setFrame(FrameIndex{std::clamp(frame, 0, clock_.frames() - 1)});
}

void Player::setIn(int frame) {
  clock_.setIn(frame);
  prefetch();
  Q_EMIT rangeChanged();
}

void Player::setOut(int frame) {
  clock_.setOut(frame);
  prefetch();
  Q_EMIT rangeChanged();
}

void Player::clearRange() {
  clock_.clearRange();
  prefetch();
  Q_EMIT rangeChanged();
}

void Player::setLoop(bool loop) {
  clock_.setLoop(loop);
  Q_EMIT rangeChanged();
}

void Player::prefetch() {
  const std::shared_ptr<const GaussianSequence> sequence = model_.sequence();
  if (!sequence || clock_.frames() == 0) return;
  const FrameRange range = clock_.range();
  const int frame = model_.frame().value;
  std::vector<FrameIndex> wanted;
  const auto add = [&](int f) {
    if (f < 0 || f >= model_.frameCount()) return;
    const FrameIndex index{f};
    const std::optional<Digest> stamp = sequence->stamp(index);
    if (!stamp || *stamp == Digest{}) return;
    if (f != frame && std::find(wanted.begin(), wanted.end(), index) == wanted.end()) wanted.push_back(index);
  };
  for (int i = 1; i <= kAhead; ++i) {
    const int ahead = frame + i;
    if (range.contains(ahead) || !range.contains(frame)) {
      add(ahead);
    } else if (clock_.loop()) {
      add(range.first + (ahead - range.first) % range.size());
    }
  }
  for (int i = 1; i <= kBehind; ++i) add(frame - i);
  model_.prefetch(std::move(wanted));
}

QString Player::rateText() const {
  const QString target = QString::number(clock_.takeRate(), 'g', 4);
  if (clock_.rate() <= 0) return target + " fps";
  return QString("%1 of %2 fps").arg(clock_.rate(), 0, 'f', 1).arg(target);
}

}  // namespace beam
