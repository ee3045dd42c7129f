// SPDX-License-Identifier: Apache-2.0
// The only starter of compute threads (oneTBB underneath). Work is cut into pieces whose borders do not
// depend on the number of threads, and reductions join the pieces in index order: any thread count gives the
// same bits.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace beam {

// 0: all that the machine has. Holds for the process until called again.
void setThreadCount(int threads);
int threadCount();

namespace detail {
void runPieces(std::size_t pieces, const std::function<void(std::size_t)>& piece);
}

// Calls body(begin, end) for consecutive pieces of at most `grain` indices of [0, count), in any order. The
// first exception thrown by a piece is rethrown here.
template <class Body>
void parallelFor(std::size_t count, std::size_t grain, Body&& body) {
  if (count == 0) return;
  const std::size_t pieces = (count + grain - 1) / grain;
  detail::runPieces(pieces, [&](std::size_t p) {
    const std::size_t begin = p * grain, end = begin + grain < count ? begin + grain : count;
    body(begin, end);
  });
}

// Joins map(begin, end) of the pieces in index order: join(join(identity, piece 0), piece 1) ...
template <class T, class Map, class Join>
T parallelReduce(std::size_t count, std::size_t grain, T identity, Map&& map, Join&& join) {
  const std::size_t pieces = count == 0 ? 0 : (count + grain - 1) / grain;
  std::vector<T> partial(pieces, identity);
  parallelFor(count, grain,
              [&](std::size_t begin, std::size_t end) { partial[begin / grain] = map(begin, end); });
  T total = identity;
  for (const T& p : partial) total = join(total, p);
  return total;
}

}  // namespace beam
