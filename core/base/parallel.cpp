// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <memory>
#include <mutex>

namespace beam {
namespace {

std::mutex mutex;
std::unique_ptr<tbb::global_control> control;
int wanted = 0;

}  // namespace

void setThreadCount(int threads) {
  std::lock_guard lock(mutex);
  wanted = threads;
  control.reset();
  if (threads > 0) {
    control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<std::size_t>(threads));
  }
}

int threadCount() {
  std::lock_guard lock(mutex);
  return wanted > 0 ? wanted : tbb::info::default_concurrency();
}

namespace detail {

void runPieces(std::size_t pieces, const std::function<void(std::size_t)>& piece) {
  if (pieces == 1) return piece(0);
  tbb::parallel_for(
      std::size_t{0}, pieces, [&](std::size_t p) { piece(p); }, tbb::simple_partitioner());
}

}  // namespace detail
}  // namespace beam
