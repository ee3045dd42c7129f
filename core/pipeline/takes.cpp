// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/takes.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace beam {
namespace {

// `last` a member, and one way only to write a take of one frame; one that was cut off keeps its step, by
// which it is put back.
Take normal(Take take) {
  take.last.value -= (take.last.value - take.first.value) % take.step;
  if (take.count() == 1 && !take.cut) take.step = 1;
  return take;
}

class TakeReader {
 public:
  explicit TakeReader(const std::vector<std::string>& frames) {
    for (std::size_t i = 0; i < frames.size(); ++i) at_.emplace(frames[i], static_cast<std::int32_t>(i));
  }

  std::optional<Take> read(const SavedTake& take) const {
    const auto first = at_.find(take.first), last = at_.find(take.last);
    if (first == at_.end() || last == at_.end() || last->second < first->second || take.step < 1)
      return std::nullopt;
    const Take read =
        normal({{first->second}, {last->second}, take.step, take.lead, take.cut, take.lost_lead});
    const bool may_be = read.lead >= 0 && read.lead < read.count() && read.lost_lead >= 0 &&
                        read.lost_lead <= first->second / read.step;
    return may_be ? std::optional(read) : std::nullopt;
  }

  std::string why(const SavedTake& take) const {
    std::string reason = "its last frame comes before its first, or its step or lead cannot be";
    for (const std::string& name : {take.last, take.first})
      if (!at_.contains(name)) reason = fmt::format("the capture has no frame {}", name);
    return fmt::format("the take {} to {} is left out: {}", take.first, take.last, reason);
  }

 private:
  std::unordered_map<std::string, std::int32_t> at_;
};

// What `inner` claims `outer` does, too.
bool covers(const Take& outer, const Take& inner) {
  if (!outer.claims(inner.begin()) || !outer.claims(inner.last)) return false;
  return inner.begin() == inner.last || inner.step % outer.step == 0;
}

// By frame: the position of its owner, -1: none.
std::vector<int> ownersOf(const std::vector<Take>& takes, int frames) {
  std::vector<int> owners(static_cast<std::size_t>(frames), -1);
  for (std::size_t t = 0; t < takes.size(); ++t) {
    for (const FrameIndex f : takes[t].claimed())
      owners[static_cast<std::size_t>(f.value)] = static_cast<int>(t);
  }
  return owners;
}

// Those that can stay in a list over all frames.
std::vector<Take> segmentsOf(const std::vector<Take>& takes, int frames) {
  std::vector<Take> kept;
  for (std::size_t t = 0; t < takes.size(); ++t) {
    const Take& take = takes[t];
    if (take.step != 1 || take.count() < 2 || take.first.value < 0 || take.last.value >= frames) continue;
    bool inside = false;
    for (std::size_t other = 0; other < takes.size() && !inside; ++other) {
      const bool larger = takes[other].count() > take.count() || other > t;
      inside = other != t && takes[other].step == 1 && larger && covers(takes[other], take);
    }
    if (!inside) kept.push_back(take);
  }
  const std::vector<int> owners = ownersOf(kept, frames);
  std::vector<Take> owning;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (std::find(owners.begin(), owners.end(), static_cast<int>(t)) != owners.end())
      owning.push_back(kept[t]);
  }
  return owning;
}

// Takes for the unowned frames from `begin` to before `end`; `before`: the take that ends there, or null.
void fillGap(std::vector<Take>& takes, int before, int begin, int end, int segment_frames, int overlap) {
  const auto room = [&](int length) {
    return segment_frames == 0 ? end - begin : std::clamp(segment_frames - length, 0, end - begin);
  };
  if (before >= 0) {
    Take& take = takes[static_cast<std::size_t>(before)];
    const int grown = room(take.count() - take.lead);
    take.last.value += grown;
    begin += grown;
  }
  while (begin < end) {
    const int length = room(0);
    const Take segment = withLead({{begin}, {begin + length - 1}}, overlap);
    if (segment.count() > 1) takes.push_back(segment);
    begin += length;
  }
}

}  // namespace

bool Take::holds(FrameIndex frame) const {
  return frame.value >= first.value && frame.value <= last.value && (frame.value - first.value) % step == 0;
}

std::vector<FrameIndex> Take::claimed() const {
  std::vector<FrameIndex> all = frames();
  all.erase(all.begin(), all.begin() + lead);
  return all;
}

std::optional<FrameIndex> Take::before(FrameIndex frame) const {
  if (frame.value <= first.value) return std::nullopt;
  return FrameIndex{frame.value - step};
}

std::vector<FrameIndex> Take::frames() const {
  std::vector<FrameIndex> all;
  for (std::int32_t f = first.value; f <= last.value; f += step) all.push_back({f});
  return all;
}

std::vector<Take> readTakes(const std::vector<SavedTake>& saved, const std::vector<std::string>& frames) {
  const TakeReader reader(frames);
  std::vector<Take> takes;
  for (const SavedTake& take : saved)
    if (const std::optional<Take> read = reader.read(take)) takes.push_back(*read);
  return takes;
}

std::vector<std::string> takesNotUnderstood(const std::vector<SavedTake>& saved,
                                            const std::vector<std::string>& frames) {
  const TakeReader reader(frames);
  std::vector<std::string> words;
  for (const SavedTake& take : saved)
    if (!reader.read(take)) words.push_back(reader.why(take));
  return words;
}

std::vector<SavedTake> saveTakes(const std::vector<Take>& takes, const std::vector<std::string>& frames) {
  const auto name = [&](FrameIndex f) { return frames.at(static_cast<std::size_t>(f.value)); };
  std::vector<SavedTake> saved;
  saved.reserve(takes.size());
  for (const Take& take : takes)
    saved.push_back({name(take.first), name(take.last), take.step, take.lead, take.cut, take.lost_lead});
  return saved;
}

Take takeOf(const std::vector<Take>& takes, FrameIndex frame) {
  const auto owner =
      std::find_if(takes.rbegin(), takes.rend(), [&](const Take& t) { return t.claims(frame); });
  return owner == takes.rend() ? Take{frame, frame, 1} : *owner;
}

std::optional<Between> betweenOf(const std::vector<Take>& takes, FrameIndex frame) {
  for (auto take = takes.rbegin(); take != takes.rend(); ++take) {
    const std::optional<Between> found = betweenOf(*take, frame);
    if (found && takeOf(takes, found->before) == *take && takeOf(takes, found->after) == *take) return found;
  }
  return std::nullopt;
}

std::optional<Between> betweenOf(const Take& take, FrameIndex frame) {
  if (frame <= take.first || frame >= take.last || take.holds(frame)) return std::nullopt;
  const int past = (frame.value - take.first.value) % take.step;
  return Between{
      {frame.value - past}, {frame.value - past + take.step}, static_cast<double>(past) / take.step};
}

std::vector<Take> takesOfFrames(const std::vector<FrameIndex>& frames, int every) {
  std::vector<Take> takes;
  for (std::size_t begin = 0, end = 0; begin < frames.size(); begin = end) {
    while (end < frames.size() && frames[end].value - frames[begin].value == static_cast<int>(end - begin))
      ++end;
    takes.push_back(normal({frames[begin], frames[end - 1], std::max(every, 1)}));
  }
  return takes;
}

Take withLead(Take take, int overlap) {
  if (take.step != 1) return take;
  take.lead = std::min(overlap, take.first.value);
  take.first.value -= take.lead;
  return take;
}

std::vector<Take> addTake(std::vector<Take> takes, const Take& wanted) {
  const Take take = normal(wanted);
  const std::vector<FrameIndex> claimed = take.claimed();
  if (std::all_of(claimed.begin(), claimed.end(), [&](FrameIndex f) { return takeOf(takes, f) == take; }))
    return takes;
  std::erase_if(takes, [&](const Take& older) { return covers(take, older); });
  takes.push_back(take);
  return takes;
}

std::vector<Take> healed(std::vector<Take> takes) {
  for (std::size_t t = 0; t < takes.size();) {
    const Take cut = takes[t];
    takes[t].first.value -= cut.lost_lead * cut.step;
    takes[t].lead += cut.lost_lead;
    takes[t].lost_lead = 0;
    const FrameIndex before{takes[t].first.value - cut.step};
    // By its shape, whoever owns its frames meanwhile.
    const auto other = std::find_if(takes.rbegin(), takes.rend(), [&](const Take& take) {
      return take.last == before && take.step == cut.step && take.count() > 1;
    });
    if (cut.cut && other != takes.rend()) {
      other->last = cut.last;
      takes.erase(takes.begin() + static_cast<std::ptrdiff_t>(t));
      continue;
    }
    const Take owner = takeOf(takes, before);
    if (cut.cut && before.value >= 0 && owner.count() == 1) {
      takes[t].first = before;
      takes[t].cut = owner.cut;
      const auto here = takes.begin() + static_cast<std::ptrdiff_t>(t);
      t -= static_cast<std::size_t>(std::count(takes.begin(), here, owner));
      std::erase(takes, owner);
    }
    ++t;
  }
  return takes;
}

std::vector<Take> joinTakes(std::vector<Take> takes, int frames, int segment_frames, int overlap) {
  takes = segmentsOf(healed(std::move(takes)), frames);
  const std::vector<int> owners = ownersOf(takes, frames);
  for (int begin = 0; begin < frames; ++begin) {
    if (owners[static_cast<std::size_t>(begin)] >= 0) continue;
    int end = begin;
    while (end < frames && owners[static_cast<std::size_t>(end)] < 0) ++end;
    const int before = begin > 0 ? owners[static_cast<std::size_t>(begin) - 1] : -1;
    fillGap(takes, before, begin, end, segment_frames, overlap);
    begin = end;
  }
  return takes;
}

std::vector<Take> withEarlier(std::vector<Take> earlier, const std::vector<Take>& before,
                              const std::vector<Take>& after) {
  const auto isIn = [](const std::vector<Take>& takes, const Take& take) {
    return std::find(takes.begin(), takes.end(), take) != takes.end();
  };
  std::erase_if(earlier, [&](const Take& take) { return isIn(after, take) || isIn(before, take); });
  for (const Take& take : before)
    if (!isIn(after, take)) earlier.push_back(take);
  if (earlier.size() > kMostEarlierTakes)
    earlier.erase(earlier.begin(), earlier.end() - static_cast<std::ptrdiff_t>(kMostEarlierTakes));
  return earlier;
}

std::vector<Take> splitTake(std::vector<Take> takes, const Take& take, FrameIndex frame) {
  const auto owner = std::find_if(takes.rbegin(), takes.rend(), [&](const Take& t) { return t == take; });
  if (owner == takes.rend() || !take.holds(frame) || frame == take.first) return takes;
  const auto at = owner.base() - 1;
  const int members = (frame.value - take.first.value) / take.step;
  if (frame <= take.begin()) {
    *at = normal({frame, take.last, take.step, take.lead - members, take.cut, take.lost_lead + members});
    return takes;
  }
  const Take rest = normal({frame, take.last, take.step, 0, true});
  *at = normal({take.first, *take.before(frame), take.step, take.lead, take.cut, take.lost_lead});
  takes.insert(at + 1, rest);
  return takes;
}

}  // namespace beam
