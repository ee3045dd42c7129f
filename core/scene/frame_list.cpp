// SPDX-License-Identifier: Apache-2.0
#include "core/scene/frame_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "core/base/count_text.h"
#include "core/base/error.h"
#include "core/base/word_list.h"
#include "core/scene/gaussian_sequence.h"

namespace beam {
namespace {

[[noreturn]] void notUnderstood(std::string_view item) {
  throw Error(
      Error::Kind::Usage,
      fmt::format("frames: \"{}\" is not understood (expected for example 0-7, 1,5, 12-, 1-9x2 or all)",
                  item));
}

long long parseNumber(std::string_view text, std::string_view item) {
  long long value = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || failed != std::errc() || end != text.data() + text.size() || value < 0)
    notUnderstood(item);
  return value;
}

struct Span {
  long long first, last, stride;
};

// "5", "1-9", "1-" (to the last of `numbers`) or "1-9x2".
Span parseSpan(std::string_view item, const std::map<long long, FrameIndex>& numbers) {
  const std::size_t dash = item.find('-');
  if (dash == std::string_view::npos) {
    const long long n = parseNumber(item, item);
    return {n, n, 1};
  }
  const std::size_t times = item.find_first_of("xX", dash);
  const bool strided = times != std::string_view::npos;
  const std::string_view high =
      trimmed(item.substr(dash + 1, strided ? times - dash - 1 : std::string_view::npos));
  if (numbers.empty()) notUnderstood(item);
  const Span span{parseNumber(trimmed(item.substr(0, dash)), item),
                  high.empty() ? numbers.rbegin()->first : parseNumber(high, item),
                  strided ? parseNumber(trimmed(item.substr(times + 1)), item) : 1};
  if (span.last < span.first || span.stride < 1) notUnderstood(item);
  return span;
}

// "0 to 9" of the numbers that the capture has.
std::string numbersText(const std::map<long long, FrameIndex>& by_number) {
  if (by_number.empty()) return "no numbered frames";
  if (by_number.size() == 1) return fmt::format("frame {} alone", by_number.begin()->first);
  return fmt::format("{}, {} to {}", countText(by_number.size(), "frame"), by_number.begin()->first,
                     by_number.rbegin()->first);
}

}  // namespace

bool isAllFrames(std::string_view list) { return lowerCase(trimmed(list)) == "all"; }

std::vector<FrameIndex> parseFrameList(std::string_view list, const std::vector<std::string>& frames) {
  std::map<long long, FrameIndex> by_number;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    by_number.emplace(frameNumber(frames[i]), FrameIndex{static_cast<std::int32_t>(i)});
  }
  by_number.erase(-1);
  std::set<FrameIndex> chosen;
  while (true) {
    const std::size_t comma = list.find(',');
    const std::string_view item = trimmed(list.substr(0, comma));
    const auto named = std::find(frames.begin(), frames.end(), item);
    if (isAllFrames(item)) {
      for (std::size_t i = 0; i < frames.size(); ++i) chosen.insert(FrameIndex{static_cast<std::int32_t>(i)});
    } else if (named != frames.end()) {
      chosen.insert(FrameIndex{static_cast<std::int32_t>(named - frames.begin())});
    } else {
      const Span span = parseSpan(item, by_number);
      // Both ends must exist: a typo must not shrink a run silently. Gaps inside are the capture's own.
      if (!by_number.count(span.first) || by_number.rbegin()->first < span.last) {
        throw Error(Error::Kind::Usage, fmt::format("frames: \"{}\" reaches beyond the capture, which has {}",
                                                    item, numbersText(by_number)));
      }
      for (auto it = by_number.find(span.first); it != by_number.end() && it->first <= span.last; ++it) {
        if ((it->first - span.first) % span.stride == 0) chosen.insert(it->second);
      }
    }
    if (comma == std::string_view::npos) break;
    list.remove_prefix(comma + 1);
  }
  return {chosen.begin(), chosen.end()};
}

std::vector<std::string> frameRanges(const std::vector<std::string>& names,
                                     const std::vector<int>& positions) {
  std::vector<std::string> ranges;
  for (std::size_t begin = 0, end = 1; begin < names.size(); begin = end, ++end) {
    while (end < names.size() && positions[end] == positions[end - 1] + 1) ++end;
    ranges.push_back(end - begin > 1 ? fmt::format("{}-{}", names[begin], names[end - 1]) : names[begin]);
  }
  return ranges;
}

}  // namespace beam
