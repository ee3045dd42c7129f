// SPDX-License-Identifier: Apache-2.0
#include "core/base/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/field_text.h"

namespace beam {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

[[noreturn]] void refuse(const FieldInfo& info, const FieldValue& like, const std::string& found) {
  throw Error(Error::Kind::Usage,
              fmt::format("{} expects {}, found {}", info.name, expectedText(info, like), found));
}

// 1,000,000 and 0.00005: no powers of ten.
std::string plainNumber(double v) {
  std::string text = fmt::format("{:.12f}", v);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  const std::size_t first = v < 0 ? 1 : 0;
  for (std::size_t at = std::min(text.find('.'), text.size()); at > first + 3;) text.insert(at -= 3, 1, ',');
  return text;
}

int asInt(const FieldInfo& info, const FieldValue& value) {
  if (const int* i = std::get_if<int>(&value)) return *i;
  if (const double* d = std::get_if<double>(&value);
      d && *d == std::floor(*d) && std::abs(*d) < 2147483647.0) {
    return static_cast<int>(*d);
  }
  refuse(info, FieldValue(0), toText(value));
}

double asDouble(const FieldInfo& info, const FieldValue& value) {
  if (const double* d = std::get_if<double>(&value)) return *d;
  if (const int* i = std::get_if<int>(&value)) return *i;
  refuse(info, FieldValue(0.0), toText(value));
}

// Letters put in, left out, changed, or changed places with the next (optimal string alignment).
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, above, row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = std::exchange(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

void FieldList::visit(const FieldInfo& info, FieldPointer value) {
  fields.push_back({info, std::visit([](auto* p) { return FieldValue(*p); }, value)});
}

void FieldSetter::visit(const FieldInfo& info, FieldPointer target) {
  if (info.name != name_) return;
  found = true;
  std::visit(Overloaded{[&](bool* p) {
                          const bool* b = std::get_if<bool>(&value_);
                          if (!b) refuse(info, FieldValue(false), toText(value_));
                          *p = *b;
                        },
                        [&](int* p) {
                          const int v = asInt(info, value_);
                          checkRange(info, v);
                          *p = v;
                        },
                        [&](double* p) {
                          const double v = asDouble(info, value_);
                          checkRange(info, v);
                          *p = v;
                        },
                        [&](std::string* p) {
                          const std::string* s = std::get_if<std::string>(&value_);
                          if (!s) refuse(info, FieldValue(std::string()), toText(value_));
                          checkRange(info, *s);
                          *p = *s;
                        }},
             target);
}

std::string rangeText(const FieldInfo& info) {
  const bool low = std::isfinite(info.min), high = std::isfinite(info.max);
  std::string text;
  if (low && high) text = fmt::format("{} to {}", plainNumber(info.min), plainNumber(info.max));
  if (low && !high) text = fmt::format("at least {}", plainNumber(info.min));
  if (high && !low) text = fmt::format("at most {}", plainNumber(info.max));
  return text.empty() || info.unit.empty() ? text : fmt::format("{} {}", text, info.unit);
}

std::string expectedText(const FieldInfo& info, const FieldValue& like) {
  if (std::holds_alternative<bool>(like)) return "true or false";
  if (std::holds_alternative<std::string>(like))
    return info.choices.empty() ? "text" : fmt::format("one of {}", fmt::join(info.choices, ", "));
  const std::string kind = std::holds_alternative<int>(like) ? "a whole number" : "a number";
  const std::string range = rangeText(info);
  if (range.empty()) return kind;
  return fmt::format("{} {} {}", kind, range.starts_with("at ") ? "of" : "from", range);
}

void checkRange(const FieldInfo& info, const FieldValue& value) {
  const auto number = [&](double v) {
    if (!std::isfinite(v) || v < info.min || v > info.max) refuse(info, value, toText(value));
  };
  std::visit(Overloaded{[](bool) {}, [&](int v) { number(v); }, [&](double v) { number(v); },
                        [&](const std::string& s) {
                          if (info.choices.empty()) return;
                          if (std::find(info.choices.begin(), info.choices.end(), s) == info.choices.end())
                            refuse(info, value, fmt::format("\"{}\"", s));
                        }},
             value);
}

std::string toText(const FieldValue& value) {
  return std::visit(
      Overloaded{[](bool v) { return std::string(v ? "true" : "false"); },
                 [](int v) { return fmt::format("{}", v); }, [](double v) { return fmt::format("{}", v); },
                 [](const std::string& v) { return v; }},
      value);
}

std::string nearestName(std::string_view name, const std::vector<std::string>& known) {
  const auto nearest = std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
    return editDistance(name, a) < editDistance(name, b);
  });
  return nearest == known.end() ? std::string() : *nearest;
}

std::optional<std::string> similarName(std::string_view name, const std::vector<std::string>& known) {
  const std::string nearest = nearestName(name, known);
  if (nearest.empty() || editDistance(name, nearest) > std::max<std::size_t>(1, name.size() / 3)) return {};
  return nearest;
}

std::string knownNames(std::string_view many, std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t kFew = 12, kNearest = 5;
  if (known.size() <= kFew) return fmt::format("the {} are {}", many, fmt::join(known, ", "));
  std::vector<std::pair<std::size_t, std::string>> by_distance;
  for (const std::string& k : known) by_distance.emplace_back(editDistance(name, k), k);
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<std::string> nearest;
  for (std::size_t i = 0; i < kNearest; ++i) nearest.push_back(by_distance[i].second);
  return fmt::format("the {} nearest to it are {} (of {})", many, fmt::join(nearest, ", "), known.size());
}

std::string noSuchName(std::string_view kind, std::string_view name, const std::vector<std::string>& known,
                       std::string_view where) {
  const std::optional<std::string> similar = similarName(name, known);
  return fmt::format("there is no {} \"{}\"; {}", kind, name,
                     similar ? fmt::format("did you mean \"{}\"?", *similar) : std::string(where));
}

}  // namespace beam
