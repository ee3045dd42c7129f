// SPDX-License-Identifier: Apache-2.0
// Progress, cancellation and the stop token in one: to report is to check. Call it from the job's thread
// only, never inside a parallelFor body.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

namespace beam {

struct ProgressReport {
  double fraction = 0;     // of the whole job, [0, 1]
  std::string label;       // what is being done, deepest part that has a label
  std::int64_t done = 0;   // steps of that part
  std::int64_t total = 0;  // 0: not known
  std::string unit = {};   // what a step is, in the plural: "iterations"; empty: nothing a person knows
};

class Progress {
 public:
  using Listener = std::function<void(const ProgressReport&)>;

  // The root of a job. `listener` may be empty; it is called on the job's thread, at most every 50 ms and at
  // the end of parts.
  explicit Progress(std::stop_token stop = {}, Listener listener = {});
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // A child that covers the next `share` (of this part's whole, [0, 1]).
  Progress part(double share, std::string label);

  void expect(std::int64_t steps, std::string unit = {});  // steps of this part that follow
  void step(std::int64_t count = 1);                       // throws Cancelled when a stop was requested
  void check() const;                                      // throws Cancelled likewise, reports nothing
  bool stopRequested() const;  // for worker pieces, which must return early instead of throwing

 private:
  struct Root;
  Progress(std::shared_ptr<Root> root, double begin, double end, std::string label);
  void report(bool always) const;

  std::shared_ptr<Root> root_;
  double begin_ = 0, end_ = 1;  // of the whole job
  double used_ = 0;             // share handed to children so far
  std::int64_t done_ = 0, total_ = 0;
  std::string label_, unit_;
};

}  // namespace beam
