// SPDX-License-Identifier: Apache-2.0
#include "core/base/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace beam {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

[[noreturn]] void wrongType(const FieldInfo& info, std::string_view expected, const FieldValue& found) {
  throw Error(Error::Kind::Usage, fmt::format("{} expects {}, found {}", info.name, expected, toText(found)));
}

int asInt(const FieldInfo& info, const FieldValue& value) {
  if (const int* i = std::get_if<int>(&value)) return *i;
  if (const double* d = std::get_if<double>(&value);
      d && *d == std::floor(*d) && std::abs(*d) < 2147483647.0) {
    return static_cast<int>(*d);
  }
  wrongType(info, "a whole number", value);
}

double asDouble(const FieldInfo& info, const FieldValue& value) {
  if (const double* d = std::get_if<double>(&value)) return *d;
  if (const int* i = std::get_if<int>(&value)) return *i;
  wrongType(info, "a number", value);
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
                          if (!b) wrongType(info, "true or false", value_);
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
                          if (!s) wrongType(info, "text", value_);
                          checkRange(info, *s);
                          *p = *s;
                        }},
             target);
}

void checkRange(const FieldInfo& info, const FieldValue& value) {
  const auto number = [&](double v) {
    if (std::isfinite(v) && v >= info.min && v <= info.max) return;
    throw Error(Error::Kind::Usage, fmt::format("{} expects {} to {}{}{}, found {}", info.name, info.min,
                                                info.max, info.unit.empty() ? "" : " ", info.unit, v));
  };
  std::visit(Overloaded{[](bool) {}, [&](int v) { number(v); }, [&](double v) { number(v); },
                        [&](const std::string& s) {
                          if (info.choices.empty()) return;
                          if (std::find(info.choices.begin(), info.choices.end(), s) != info.choices.end())
                            return;
                          throw Error(Error::Kind::Usage,
                                      fmt::format("{} expects one of {}, found \"{}\"", info.name,
                                                  fmt::join(info.choices, ", "), s));
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
  const auto distance = [](std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const std::size_t above = row[j];
        row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
        diagonal = above;
      }
    }
    return row[b.size()];
  };
  std::string best;
  std::size_t bestDistance = std::string::npos;
  for (const std::string& k : known) {
    if (const std::size_t d = distance(name, k); d < bestDistance) best = k, bestDistance = d;
  }
  return best;
}

}  // namespace beam
