// SPDX-License-Identifier: Apache-2.0
#include "core/base/duration_text.h"

#include <fmt/format.h>

#include <cmath>

namespace beam {

std::string durationText(double seconds) {
  const long s = std::lround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

}  // namespace beam
