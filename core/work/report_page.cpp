// SPDX-License-Identifier: Apache-2.0
#include "core/work/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "core/base/count_text.h"
#include "core/base/duration_text.h"
#include "core/base/word_list.h"
#include "core/io/written_by.h"
#include "core/stages/step_ids.h"
#include "core/work/report_style.h"
#include "core/work/score_words.h"
#include "core/work/svg_chart.h"

namespace beam {
namespace {

constexpr std::size_t kWorstFrames = 5, kMarked = 3, kListed = 12;

std::string cell(const std::string& words, const char* css = "") {
  return fmt::format("<td{}>{}</td>", *css ? fmt::format(" class=\"{}\"", css) : std::string(),
                     escapedHtml(words));
}

std::string number(double value, int digits) { return cell(fmt::format("{:.{}f}", value, digits), "n"); }

std::string head(std::initializer_list<const char*> titles) {
  std::string row = "<thead><tr>";
  for (const char* t : titles) row += fmt::format("<th>{}</th>", escapedHtml(t));
  return row + "</tr></thead>\n";
}

// What a camera was like over the frames.
struct CameraRow {
  bool held_out = false;
  std::size_t left_out = 0;  // frames
  std::vector<PictureScore> scores;
  double least = 0;  // psnr
  std::string least_frame;
  std::vector<std::pair<std::size_t, double>> over_time;
};

class PageWriter {
 public:
  explicit PageWriter(const ReportPage& page) : page_(page), h_(page.history) {
    for (const FrameQuality& f : h_.frames) frames_.push_back(f.name);
    worst_ = worstFrames(h_, kWorstFrames);
  }

  std::string write() {
    out_ = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\"/><meta name=\"generator\" "
        "content=\"{2}\"/><title>{0}: quality report</title>\n"
        "<style>{1}</style></head>\n<body><main>\n<header><p class=\"kind\">Quality report</p><h1>{0}</h1>",
        escapedHtml(page_.project), kReportStyle, writerOf(kReportCommand));
    for (const auto& [label, words] : page_.facts) {
      if (label == "Capture") out_ += fmt::format("<p class=\"sub\">{}</p>", escapedHtml(words));
    }
    out_ += "</header>\n";
    tiles();
    findings();
    mainCurves();
    cameras();
    worstList();
    pictures();
    evaluation();
    otherCurves();
    settings();
    out_ += fmt::format(
        "<footer>beam {}. PSNR and SSIM: render against photograph inside the bounding box of "
        "the mask, sRGB-encoded, black background.</footer>\n</main></body></html>\n",
        escapedHtml(page_.version));
    return std::move(out_);
  }

 private:
  void section(const char* title, const std::string& lead = "") {
    out_ += fmt::format("<h2>{}</h2>\n", escapedHtml(title));
    if (!lead.empty()) out_ += fmt::format("<p>{}</p>\n", escapedHtml(lead));
  }

  void tile(const std::string& figure, const std::string& words, const char* css = "") {
    out_ += fmt::format("<div class=\"tile {}\"><b>{}</b><span>{}</span></div>", css, escapedHtml(figure),
                        escapedHtml(words));
  }

  // Mean over frames of the frames' means.
  std::pair<double, std::size_t> meanPsnr(bool held_out) const {
    double sum = 0;
    std::size_t n = 0;
    for (const FrameQuality& f : h_.frames) {
      const SplitScore s = meanOf(f.views, held_out);
      if (s.n > 0) sum += s.mean.psnr, ++n;
    }
    return {n > 0 ? sum / static_cast<double>(n) : 0, n};
  }

  void tiles() {
    std::size_t failed = 0, scored = 0;
    for (const FrameQuality& f : h_.frames) failed += !f.failures.empty(), scored += !f.views.empty();
    out_ += "<div class=\"tiles\">";
    tile(fmt::format("{} of {}", scored, page_.frames_in_capture),
         nounText(page_.frames_in_capture, "frame solved and scored", "frames solved and scored"));
    if (failed > 0) tile(std::to_string(failed), nounText(failed, "frame failed", "frames failed"), "bad");
    for (const bool held_out : {false, true}) {
      const auto [psnr, n] = meanPsnr(held_out);
      if (n > 0) tile(fmt::format("{:.2f} dB", psnr), held_out ? "PSNR, held out" : "PSNR, training views");
    }
    if (!worst_.empty()) tile(frames_[worst_.front()], "worst frame");
    tile(std::to_string(h_.defects.size()),
         nounText(h_.defects.size(), "finding about the capture", "findings about the capture"),
         h_.defects.empty() ? "" : "bad");
    tile(durationText(h_.seconds), "computing time");
    tile(fmt::format("{:.1f} GB", h_.peak_memory_bytes / 1e9), "peak memory");
    out_ += "</div>\n";
  }

  void findings() {
    section("Findings");
    leftOut();
    const bool failed = failures() > 0;
    if (h_.left_out.empty() && h_.defects.empty() && h_.warnings.empty() && !failed) {
      out_ += "<p>No camera and no frame stands out, and no step warned.</p>\n";
      return;
    }
    if (!h_.defects.empty()) {
      out_ += "<table>" + head({"Camera", "Finding", "Frames", "PSNR with", "without"}) + "<tbody>";
      for (const Defect& d : h_.defects) {
        const bool known = d.psnr_with > 0 || d.psnr_without > 0;
        out_ +=
            "<tr>" + cell(d.camera, "name") + cell(fmt::format("{} {}.", d.camera, d.text)) +
            cell(shortList(d.frames, kListed)) +
            (known ? number(d.psnr_with, 2) + number(d.psnr_without, 2) : cell("-", "n") + cell("-", "n")) +
            "</tr>\n";
      }
      out_ +=
          "</tbody></table>\n<p class=\"note\">PSNR in dB: mean of the training views of these frames, with "
          "and without the camera’s own pictures.</p>\n";
    }
    if (!h_.warnings.empty()) {
      out_ += "<ul class=\"warnings\">";
      for (const std::string& w : h_.warnings) out_ += fmt::format("<li>{}</li>\n", escapedHtml(w));
      out_ += "</ul>\n";
    }
  }

  void leftOut() {
    if (h_.left_out.empty()) return;
    out_ += "<h3>Left out of the fit</h3>\n<ul class=\"left-out\">";
    for (const LeftOutCamera& c : h_.left_out)
      out_ += fmt::format("<li>{}.</li>\n", escapedHtml(toText(c, h_.defects)));
    out_ += "</ul>\n";
    if (const std::string loss = toText(h_.loss); !loss.empty())
      out_ += fmt::format("<p>{}</p>\n", escapedHtml(loss));
  }

  // Failed steps as a list; how many there are.
  std::size_t failures() {
    std::size_t count = 0;
    std::string list;
    for (const FrameQuality& f : h_.frames) {
      for (const auto& [step, message] : f.failures) {
        ++count;
        list += fmt::format("<li>Frame {}, {}: {}</li>\n", escapedHtml(f.name),
                            escapedHtml(titleOfStep(page_.stages, step)), escapedHtml(message));
      }
    }
    if (count > 0) out_ += "<ul class=\"failures\">" + list + "</ul>\n";
    return count;
  }

  Chart chart(std::string title, std::string unit) const {
    Chart c;
    c.title = std::move(title);
    c.unit = std::move(unit);
    c.frames = frames_;
    return c;
  }

  // psnr or ssim of both splits, the worst frames marked.
  template <class Figure>
  void splitCurve(const char* title, const char* unit, Figure figure) {
    Chart c = chart(title, unit);
    for (const bool held_out : {false, true}) {
      ChartSeries s{held_out ? "held out" : "training", {}};
      for (std::size_t f = 0; f < h_.frames.size(); ++f) {
        const SplitScore split = meanOf(h_.frames[f].views, held_out);
        const std::optional<double> value =
            split.n > 0 ? std::optional<double>(split.mean.*figure) : std::nullopt;
        if (value) s.points.emplace_back(f, *value);
      }
      if (s.points.empty()) continue;
      for (std::size_t p = 0; p < s.points.size() && h_.frames.size() > kMarked; ++p) {
        const auto end = worst_.begin() + static_cast<std::ptrdiff_t>(std::min(kMarked, worst_.size()));
        if (!held_out && std::find(worst_.begin(), end, s.points[p].first) != end)
          c.worst.emplace_back(c.series.size(), p);
      }
      c.series.push_back(std::move(s));
    }
    if (!c.series.empty()) out_ += "<figure>" + svgOf(c) + "</figure>";
  }

  void secondsCurve() {
    Chart c = chart("Computing time", "s");
    ChartSeries s{"Computing time", {}};
    for (std::size_t f = 0; f < h_.frames.size(); ++f) {
      double sum = 0;
      for (const auto& [step, seconds] : h_.frames[f].seconds) sum += seconds;
      s.points.emplace_back(f, sum);
    }
    c.series.push_back(std::move(s));
    out_ += "<figure>" + svgOf(c) + "</figure>";
  }

  void mainCurves() {
    if (h_.frames.empty()) return;
    section("Quality over time",
            !worst_.empty() && h_.frames.size() > kMarked ? "Rings mark the worst frames." : "");
    out_ += "<div class=\"charts\">";
    splitCurve("PSNR", "dB", &PictureScore::psnr);
    splitCurve("SSIM", "", &PictureScore::ssim);
    splitCurve("PSNR inside the mask", "dB", &PictureScore::psnr_mask);
    secondsCurve();
    out_ += "</div>\n";
  }

  std::map<std::string, CameraRow> cameraRows() const {
    std::map<std::string, CameraRow> rows;
    for (std::size_t f = 0; f < h_.frames.size(); ++f) {
      for (const ViewScore& v : h_.frames[f].views) {
        CameraRow& r = rows[v.camera];
        r.held_out = v.held_out;
        r.left_out += v.left_out;
        if (r.scores.empty() || v.score.psnr < r.least) r.least = v.score.psnr, r.least_frame = frames_[f];
        r.scores.push_back(v.score);
        r.over_time.emplace_back(f, v.score.psnr);
      }
    }
    return rows;
  }

  // A line without axes, all cameras on one scale.
  std::string sparkline(const CameraRow& row, double low, double high) const {
    constexpr double kWidth = 140, kHeight = 24;
    const auto x = [&](std::size_t f) {
      return frames_.size() < 2 ? kWidth / 2
                                : 2 + (kWidth - 4) * static_cast<double>(f) / (frames_.size() - 1.0);
    };
    const auto y = [&](double v) {
      return high > low ? 2 + (kHeight - 4) * (high - v) / (high - low) : kHeight / 2;
    };
    std::string path;
    for (const auto& [f, v] : row.over_time)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(f), y(v));
    const auto& last = row.over_time.back();
    return fmt::format(
        "<svg class=\"spark\" viewBox=\"0 0 {} {}\"><path class=\"s{}\" d=\"{}\"/><circle "
        "class=\"s{} dot\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\"/></svg>",
        kWidth, kHeight, row.held_out ? 1 : 0, path, row.held_out ? 1 : 0, x(last.first), y(last.second));
  }

  static std::string useOf(const CameraRow& row) {
    if (row.held_out) return "held out";
    if (row.left_out == 0) return "training";
    return row.left_out == row.scores.size()
               ? "left out"
               : fmt::format("training, left out of {}", countText(row.left_out, "frame"));
  }

  void cameras() {
    const std::map<std::string, CameraRow> rows = cameraRows();
    if (rows.empty()) return;
    double low = rows.begin()->second.least, high = low;
    std::set<std::string> accused;
    for (const Defect& d : h_.defects) accused.insert(d.camera);
    for (const auto& [name, r] : rows) {
      for (const auto& [f, v] : r.over_time) low = std::min(low, v), high = std::max(high, v);
    }
    section("Cameras");
    out_ += "<table>" + head({"Camera", "Use", "PSNR, dB", "SSIM", "Least PSNR", "in frame", "Over time"}) +
            "<tbody>";
    for (const auto& [name, r] : rows) {
      const PictureScore mean = meanOf(r.scores);
      out_ += "<tr>" + cell(name, accused.contains(name) ? "name bad" : "name") + cell(useOf(r)) +
              number(mean.psnr, 2) + (mean.ssim ? number(*mean.ssim, 4) : cell("-", "n")) +
              number(r.least, 2) + cell(r.least_frame) + "<td>" + sparkline(r, low, high) + "</td></tr>\n";
    }
    out_ += fmt::format("</tbody></table>\n<p class=\"note\">Lines: PSNR from {:.1f} to {:.1f} dB.</p>\n",
                        low, high);
  }

  void worstList() {
    if (worst_.empty()) return;
    section("Worst frames");
    out_ += "<table>" +
            head({"Frame", "PSNR training, dB", "PSNR held out, dB", "Worst camera", "its PSNR"}) + "<tbody>";
    for (const std::size_t f : worst_) {
      const FrameQuality& q = h_.frames[f];
      const SplitScore train = meanOf(q.views, false), test = meanOf(q.views, true);
      const ViewScore& camera = q.views[train.worst];
      out_ += "<tr>" + cell(q.name, "name") + number(train.mean.psnr, 2) +
              (test.n > 0 ? number(test.mean.psnr, 2) : cell("-", "n")) + cell(camera.camera) +
              number(camera.score.psnr, 2) + "</tr>\n";
    }
    out_ += "</tbody></table>\n";
  }

  void pictures() {
    if (page_.pictures.empty()) return;
    section("Contact sheet");
    std::string frame;
    for (const ContactRow& row : page_.pictures) {
      if (row.frame != frame) out_ += fmt::format("<h3>Frame {}</h3>\n", escapedHtml(row.frame));
      frame = row.frame;
      out_ += fmt::format("<div class=\"sheet\"><p>{}{}</p>", escapedHtml(row.camera),
                          row.held_out ? "<br/><small>held out</small>" : "");
      for (const auto& [title, bytes] : row.cells) {
        out_ += fmt::format(
            "<figure><img alt=\"{0}, {1}, frame {2}\" src=\"data:image/jpeg;base64,{3}\"/>"
            "<figcaption>{0}</figcaption></figure>",
            escapedHtml(title), escapedHtml(row.camera), escapedHtml(row.frame), base64(bytes));
      }
      out_ += "</div>\n";
    }
  }

  void evaluation() {
    if (page_.evaluation.empty() && page_.evaluation_note.empty()) return;
    section("Last evaluation",
            page_.evaluation.empty() ? "" : "As beam evaluate wrote it, means over pictures.");
    if (!page_.evaluation_note.empty())
      out_ += fmt::format("<p class=\"warn\">Attention: {}.</p>\n", escapedHtml(page_.evaluation_note));
    if (page_.evaluation.empty()) return;
    static constexpr std::pair<const char*, int> kColumns[] = {
        {"psnr", 2}, {"ssim", 4}, {"psnr_mask", 2}, {"pictures", 0}};
    out_ += "<table>" + head({"Map", "PSNR, dB", "SSIM", "PSNR in mask, dB", "Pictures", "Other figures"}) +
            "<tbody>";
    for (const auto& [map, scores] : page_.evaluation) {
      out_ += "<tr>" + cell(mapTitle(map), "name");
      std::map<std::string, double> others = scores;
      for (const auto& [name, digits] : kColumns) {
        const auto found = scores.find(name);
        out_ += found == scores.end() ? cell("-", "n") : number(found->second, digits);
        others.erase(name);
      }
      std::string words;
      for (const auto& [name, value] : others) {
        words +=
            fmt::format("{}{} {}", words.empty() ? "" : ", ", titleOf(scoreWords(name)), figureText(value));
      }
      out_ += cell(words) + "</tr>\n";
    }
    out_ += "</tbody></table>\n";
  }

  // Every other score of every step and of the evaluation, below where they come from: energies, flicker,
  // losses, counts.
  void otherCurves() {
    std::map<std::string, std::string> charts;  // by place, in order of names
    std::vector<std::string> places;
    for (const ScoreCurve& curve : curvesOf(h_)) {
      if (curve.name.starts_with(kScoreStep.text() + ".")) continue;
      const CurveWords words = curveWords(page_.stages, curve.name);
      if (!charts.contains(words.where)) places.push_back(words.where);
      charts[words.where] += fmt::format("<figure>{}</figure>", svgOf(smallChart(curve, words.score)));
    }
    if (places.empty()) return;
    section("Energies, flicker and other figures over time",
            "Evaluation: as beam evaluate last found it, of frames that were not solved anew since; the "
            "others: from the records of the steps.");
    for (const std::string& place : places) {
      if (!place.empty()) out_ += fmt::format("<h3>{}</h3>\n", escapedHtml(place));
      out_ += fmt::format("<div class=\"charts small\">{}</div>\n", charts[place]);
    }
  }

  // The worst value marked, where one is better than another.
  Chart smallChart(const ScoreCurve& curve, const ScoreWords& words) const {
    Chart c = chart(words.label, words.unit);
    c.width = 340, c.height = 160;
    c.series.push_back({words.label, curve.points});
    const Better better = betterOf(curve.name);
    if (better != Better::Neither && curve.points.size() > kMarked) {
      const auto worse = [&](const auto& a, const auto& b) {
        return better == Better::More ? a.second < b.second : a.second > b.second;
      };
      const auto at = std::min_element(curve.points.begin(), curve.points.end(), worse);
      c.worst.emplace_back(0, static_cast<std::size_t>(at - curve.points.begin()));
    }
    return c;
  }

  void settings() {
    section("Project");
    out_ += "<table class=\"facts\"><tbody>";
    for (const auto& [label, words] : page_.facts)
      out_ += "<tr>" + cell(label, "name") + cell(words) + "</tr>\n";
    out_ += "</tbody></table>\n";
    if (!page_.settings.empty()) {
      out_ += "<h3>Settings that differ from the preset</h3>\n<table>" +
              head({"Setting", "Value", "Unit", "Key"}) + "<tbody>";
      for (const ReportSetting& s : page_.settings) {
        out_ += "<tr>" + cell(s.label, "name") + cell(s.value, "n") + cell(s.unit) + cell(s.key, "code") +
                "</tr>\n";
      }
      out_ += "</tbody></table>\n";
    }
    std::map<StepId, std::pair<double, std::size_t>> steps;
    for (const FrameQuality& f : h_.frames) {
      for (const auto& [step, seconds] : f.seconds) steps[step].first += seconds, ++steps[step].second;
    }
    if (steps.empty()) return;
    out_ += "<table>" + head({"Step", "Frames", "Time a frame, s", "Together"}) + "<tbody>";
    for (const auto& [step, sum] : steps) {
      out_ += "<tr>" + cell(titleOfStep(page_.stages, step), "name") + cell(std::to_string(sum.second), "n") +
              number(sum.first / static_cast<double>(sum.second), 2) + cell(durationText(sum.first), "n") +
              "</tr>\n";
    }
    out_ += "</tbody></table>\n";
  }

  const ReportPage& page_;
  const QualityHistory& h_;
  std::vector<std::string> frames_;
  std::vector<std::size_t> worst_;
  std::string out_;
};

}  // namespace

std::string toHtml(const ReportPage& page) { return PageWriter(page).write(); }

}  // namespace beam
