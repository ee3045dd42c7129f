// SPDX-License-Identifier: Apache-2.0
#include "core/base/progress.h"

#include <algorithm>
#include <chrono>

#include "core/base/error.h"

namespace beam {

struct Progress::Root {
  std::stop_token stop;
  Listener listener;
  std::chrono::steady_clock::time_point last{};
};

Progress::Progress(std::stop_token stop, Listener listener)
    : root_(std::make_shared<Root>(Root{std::move(stop), std::move(listener), {}})) {}

Progress::Progress(std::shared_ptr<Root> root, double begin, double end, std::string label)
    : root_(std::move(root)), begin_(begin), end_(end), label_(std::move(label)) {
  report(true);
}

Progress::~Progress() = default;

Progress Progress::part(double share, std::string label) {
  check();
  const double begin = begin_ + (end_ - begin_) * std::min(used_, 1.0);
  used_ += share;
  const double end = begin_ + (end_ - begin_) * std::min(used_, 1.0);
  return Progress(root_, begin, end, label.empty() ? label_ : std::move(label));
}

void Progress::expect(std::int64_t steps, std::string unit) {
  unit_ = std::move(unit);
  total_ = steps;
  done_ = 0;
}

void Progress::step(std::int64_t count) {
  check();
  done_ += count;
  report(done_ == total_);
}

void Progress::check() const {
  if (stopRequested()) throw Cancelled();
}

bool Progress::stopRequested() const { return root_->stop.stop_requested(); }

void Progress::report(bool always) const {
  if (!root_->listener) return;
  const auto now = std::chrono::steady_clock::now();
  if (!always && now - root_->last < std::chrono::milliseconds(50)) return;
  root_->last = now;
  const double inside =
      total_ > 0 ? std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_)) : 0.0;
  root_->listener({begin_ + (end_ - begin_) * inside, label_, done_, total_, unit_});
}

}  // namespace beam
