// SPDX-License-Identifier: Apache-2.0
// StepId: which step, by its full id "surface.fit": a stage and the step's own name in it. Never renamed:
// results are found by it. A text becomes one only where that is said.
#pragma once

#include <compare>
#include <string>
#include <string_view>
#include <utility>

namespace beam {

class StepId {
 public:
  StepId() = default;  // of no step
  explicit StepId(std::string full) : text_(std::move(full)) {}
  explicit StepId(std::string_view stage, std::string_view name)
      : text_(std::string(stage) + "." + std::string(name)) {}

  // As keys, records, paths and messages have it.
  const std::string& text() const { return text_; }
  bool empty() const { return text_.empty(); }
  std::string_view stage() const { return std::string_view(text_).substr(0, text_.find('.')); }
  // Nothing of a text without a dot.
  std::string_view name() const {
    const std::size_t dot = text_.find('.');
    return dot == std::string::npos ? std::string_view() : std::string_view(text_).substr(dot + 1);
  }

  auto operator<=>(const StepId&) const = default;  // in the order of the texts

 private:
  std::string text_;
};

}  // namespace beam
