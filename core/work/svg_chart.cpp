// SPDX-License-Identifier: Apache-2.0
#include "core/work/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace beam {
namespace {

constexpr int kLeft = 52, kRight = 12, kTop = 30, kBottom = 26;
constexpr std::size_t kSeriesColors = 6;
constexpr double kTicks = 5;
constexpr double kTitleLetter = 7.2;   // mean width of a letter of 13 px, bold
constexpr std::size_t kMostDots = 60;  // frames

struct Range {
  double low = 0, high = 1, step = 0.2;
};

// 1, 2 or 5 times a power of ten, at least `rough`.
double roundStep(double rough) {
  const double power = std::pow(10.0, std::floor(std::log10(rough))), mantissa = rough / power;
  return power * (mantissa <= 1 ? 1 : mantissa <= 2 ? 2 : mantissa <= 5 ? 5 : 10);
}

// Values that are as good as one: a round step to either side of it, of counts at least 1. Nothing below 0
// that has no reason to be.
Range rangeAround(double value, bool whole) {
  if (value == 0) return {0, 1, 1};
  const double step = std::max(roundStep(0.05 * std::abs(value)), whole ? 1.0 : 0.0);
  const double low = std::floor(value / step) * step - step, high = std::ceil(value / step) * step + step;
  if (value > 0) return {std::max(0.0, low), high, step};
  return {low, std::min(0.0, high), step};
}

// Round numbers around the values; counts have no ticks between two of them.
Range rangeOf(const Chart& chart) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool whole = true;
  for (const ChartSeries& s : chart.series) {
    for (const auto& [frame, value] : s.points) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value), high = std::max(high, value);
      whole &= value == std::floor(value);
    }
  }
  if (low > high) return {};
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low < 1e-3 * size || high == low) return rangeAround(0.5 * low + 0.5 * high, whole);
  const double step = std::max(roundStep((high - low) / kTicks), whole ? 1.0 : 0.0);
  return {std::floor(low / step) * step, std::ceil(high / step) * step, step};
}

// As many decimals as tell neighbouring ticks apart.
std::string tickText(double value, double step) {
  constexpr double kMostDecimals = 5;
  if (std::abs(value) < 1e-9 * step) return "0";
  const double decimals = std::max(0.0, -std::floor(std::log10(step) + 1e-9));
  return decimals > kMostDecimals ? figureText(value)
                                  : fmt::format("{:.{}f}", value, static_cast<int>(decimals));
}

class ChartWriter {
 public:
  explicit ChartWriter(const Chart& chart) : chart_(chart), range_(rangeOf(chart)) {}

  std::string write() {
    out_ = fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">",
                       chart_.width, chart_.height, escapedHtml(chart_.title));
    heading();
    valueAxis();
    frameAxis();
    for (std::size_t i = 0; i < chart_.series.size(); ++i) series(i);
    for (const auto& [s, p] : chart_.worst) worst(s, p);
    return out_ + "</svg>\n";
  }

 private:
  double x(std::size_t frame) const {
    const double inside = chart_.width - kLeft - kRight;
    const std::size_t n = chart_.frames.size();
    return n < 2 ? kLeft + inside / 2 : kLeft + inside * static_cast<double>(frame) / (n - 1.0);
  }
  double y(double value) const {
    const double inside = chart_.height - kTop - kBottom;
    return kTop + inside * (range_.high - value) / (range_.high - range_.low);
  }
  void text(const char* css, double at_x, double at_y, const char* anchor, const std::string& words) {
    out_ += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", css,
                        at_x, at_y, anchor, escapedHtml(words));
  }

  // The legend stands right of the title, last series at the border.
  void heading() {
    const std::string title =
        chart_.unit.empty() ? chart_.title : fmt::format("{}, {}", chart_.title, chart_.unit);
    // A long one begins left of the axis, so that it ends inside.
    const double wide = kTitleLetter * static_cast<double>(title.size());
    text("title", std::clamp(chart_.width - kRight - wide, 2.0, double{kLeft}), 16, "start", title);
    if (chart_.series.size() < 2) return;
    double right = chart_.width - kRight;
    for (std::size_t i = chart_.series.size(); i-- > 0;) {
      text("label", right, 16, "end", chart_.series[i].label);
      right -= 6.2 * static_cast<double>(chart_.series[i].label.size()) + 8;
      out_ += fmt::format("<line class=\"s{}\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"12\" y2=\"12\"/>",
                          i % kSeriesColors, right - 12, right);
      right -= 24;
    }
  }

  void valueAxis() {
    const int count = static_cast<int>(std::lround((range_.high - range_.low) / range_.step));
    for (int i = 0; i <= count; ++i) {
      const double value = range_.low + i * range_.step;
      out_ += fmt::format("<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>", kLeft,
                          chart_.width - kRight, y(value), y(value));
      text("label", kLeft - 6, y(value) + 3.5, "end", tickText(value, range_.step));
    }
  }

  void frameAxis() {
    const double bottom = chart_.height - kBottom;
    out_ += fmt::format("<line class=\"axis\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>", kLeft,
                        chart_.width - kRight, bottom, bottom);
    const std::size_t n = chart_.frames.size();
    if (n == 0) return;
    const std::size_t widest =
        std::max_element(chart_.frames.begin(), chart_.frames.end(), [](const auto& a, const auto& b) {
          return a.size() < b.size();
        })->size();
    const auto fitting = static_cast<std::size_t>(
        std::max(1.0, (chart_.width - kLeft - kRight) / (7.0 * static_cast<double>(widest) + 16)));
    const std::size_t every = (n + fitting - 1) / fitting;
    for (std::size_t f = 0; f < n; f += every) {
      const bool at_border = n > 1 && f + 1 == n;
      text("label", at_border ? chart_.width - 2.0 : x(f), bottom + 15, at_border ? "end" : "middle",
           chart_.frames[f]);
    }
  }

  // A dot a value, of long curves only where no line shows it.
  void series(std::size_t i) {
    std::vector<std::pair<std::size_t, double>> points;
    std::copy_if(chart_.series[i].points.begin(), chart_.series[i].points.end(), std::back_inserter(points),
                 [](const auto& p) { return std::isfinite(p.second); });
    std::string path;
    const auto follows = [&](std::size_t p) {
      return p > 0 && p < points.size() && points[p].first == points[p - 1].first + 1;
    };
    for (std::size_t p = 0; p < points.size(); ++p) {
      const auto& [frame, value] = points[p];
      path += fmt::format("{}{:.1f} {:.1f}", follows(p) ? "L" : "M", x(frame), y(value));
      if (chart_.frames.size() > kMostDots && (follows(p) || follows(p + 1))) continue;
      out_ += fmt::format(
          "<circle class=\"s{} dot\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\"><title>{}: {}</title>"
          "</circle>",
          i % kSeriesColors, x(frame), y(value), escapedHtml(chart_.frames[frame]), figureText(value));
    }
    if (!path.empty()) out_ += fmt::format("<path class=\"s{}\" d=\"{}\"/>", i % kSeriesColors, path);
  }

  void worst(std::size_t s, std::size_t p) {
    const auto& [frame, value] = chart_.series[s].points[p];
    if (!std::isfinite(value)) return;
    out_ += fmt::format(
        "<circle class=\"worst\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\"><title>{}: {}</title>"
        "</circle>",
        x(frame), y(value), escapedHtml(chart_.frames[frame]), figureText(value));
  }

  const Chart& chart_;
  Range range_;
  std::string out_;
};

}  // namespace

std::string svgOf(const Chart& chart) { return ChartWriter(chart).write(); }

std::string escapedHtml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string base64(std::span<const std::byte> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (k < n ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) out += k <= n ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string figureText(double value) {
  if (!std::isfinite(value)) return "-";
  if (std::abs(value) >= 1000) return fmt::format("{:.0f}", value);
  return fmt::format("{:.4g}", value);
}

}  // namespace beam
