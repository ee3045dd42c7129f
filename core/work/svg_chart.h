// SPDX-License-Identifier: Apache-2.0
// Curves over frames as inline SVG, and the few words of HTML that go with them. Colours come from the page's
// style sheet: classes s0 to s5 for the series, axis, grid, worst.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace beam {

std::string escapedHtml(std::string_view text);
std::string base64(std::span<const std::byte> bytes);
// Four significant digits: "31.42", "0.0123", "14210".
std::string figureText(double value);

struct ChartSeries {
  std::string label;
  std::vector<std::pair<std::size_t, double>> points;  // index of the frame, value; in order
};

struct Chart {
  std::string title, unit;
  std::vector<std::string> frames;  // names, by index
  std::vector<ChartSeries> series;
  std::vector<std::pair<std::size_t, std::size_t>> worst;  // series, index of a point: marked and named
  int width = 520, height = 220;
};

// Values that are not finite are left out; points of frames that are not neighbours are not joined. A curve
// that stays where it is has an axis of round numbers around it.
std::string svgOf(const Chart& chart);

}  // namespace beam
