// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gaussian_sequence.h"

#include <fmt/format.h>

#include <charconv>
#include <set>

#include "core/base/error.h"

namespace beam {

void validate(const GaussianFrame& frame) {
  validate(frame.cloud);
  if (frame.materials) validate(*frame.materials, frame.cloud);
  std::set<std::string> names;
  for (const Attribute& a : frame.attributes) {
    validate(a, frame.cloud.size());
    if (!names.insert(a.info.name).second)
      throw Error(Error::Kind::Data, fmt::format("attribute \"{}\" is there twice", a.info.name));
  }
}

long long frameNumber(std::string_view name) {
  const std::size_t last = name.find_last_of("0123456789");
  if (last == std::string_view::npos) return -1;
  std::size_t first = last;
  while (first > 0 && name[first - 1] >= '0' && name[first - 1] <= '9') --first;
  long long value = -1;
  std::from_chars(name.data() + first, name.data() + last + 1, value);
  return value;
}

std::vector<FrameLabel> labelled(const std::vector<std::string>& names) {
  std::vector<FrameLabel> labels;
  labels.reserve(names.size());
  for (const std::string& name : names) labels.push_back({name, frameNumber(name)});
  return labels;
}

std::shared_ptr<const GaussianFrame> solvedFrame(const GaussianSequence& sequence, FrameIndex frame) {
  std::shared_ptr<const GaussianFrame> loaded = sequence.load(frame);
  if (!loaded)
    throw Error(Error::Kind::Data,
                fmt::format("frame {} is not solved yet: run it first", nameOf(sequence, frame)));
  return loaded;
}

std::vector<std::string> namesOf(const GaussianSequence& sequence) {
  std::vector<std::string> names;
  names.reserve(sequence.frames().size());
  for (const FrameLabel& label : sequence.frames()) names.push_back(label.name);
  return names;
}

}  // namespace beam
