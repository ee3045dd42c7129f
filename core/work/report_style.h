// SPDX-License-Identifier: Apache-2.0
// The style sheet of the quality report: light, dark by the reader's choice, and print.
#pragma once

namespace beam {

inline constexpr const char* kReportStyle = R"css(
:root { color-scheme: light dark; --paper: #fcfcfa; --ink: #1d2126; --soft: #666d75; --line: #dcdcd6;
  --tile: #f3f3ee; --bad: #b3261e; --c0: #1f5fa8; --c1: #c2570c; --c2: #2c7a4b; --c3: #7a4ba0; --c4: #8a6d00;
  --c5: #a03a5b; }
@media (prefers-color-scheme: dark) { :root { --paper: #17191c; --ink: #e6e7e8; --soft: #9aa1a9;
  --line: #34383d; --tile: #202327; --bad: #ff8a80; --c0: #7fb2f0; --c1: #f2a35e; --c2: #79c99a; --c3: #c39be6;
  --c4: #d9bf5b; --c5: #e88bac; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 15px/1.5 "Inter", "Helvetica Neue", "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 1120px; margin: 0 auto; padding: 40px 32px 64px; }
header { border-bottom: 2px solid var(--ink); padding-bottom: 14px; margin-bottom: 22px; }
.kind { margin: 0; color: var(--soft); letter-spacing: .08em; text-transform: uppercase; font-size: 12px; }
h1 { margin: 2px 0 4px; font-size: 32px; line-height: 1.2; }
h2 { margin: 44px 0 12px; font-size: 20px; border-bottom: 1px solid var(--line); padding-bottom: 6px; }
h3 { margin: 22px 0 6px; font-size: 15px; color: var(--soft); }
.sub, .note, footer { color: var(--soft); } .sub { margin: 0; } .note, footer { font-size: 13px; } .warn { color: var(--bad); }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(150px, 1fr)); gap: 10px; }
.tile { background: var(--tile); padding: 12px 14px; border-radius: 6px; }
.tile b { display: block; font-size: 21px; font-variant-numeric: tabular-nums; }
.tile span { color: var(--soft); font-size: 13px; } .tile.bad b, td.bad { color: var(--bad); }
table { border-collapse: collapse; width: 100%; font-size: 14px; margin: 8px 0; }
th { text-align: left; font-weight: 600; color: var(--soft); font-size: 12.5px; }
th, td { padding: 5px 14px 5px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td.n { font-variant-numeric: tabular-nums; } td.name { font-weight: 600; white-space: nowrap; }
td.code { font-family: "DejaVu Sans Mono", monospace; font-size: 13px; font-weight: 400; }
ul { padding-left: 20px; } .failures li { color: var(--bad); }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(440px, 1fr)); gap: 14px 22px; }
.charts.small { grid-template-columns: repeat(auto-fill, minmax(300px, 1fr)); }
figure { margin: 0; } svg.chart { width: 100%; height: auto; display: block; } svg.spark { width: 140px; }
svg text { fill: var(--soft); font-size: 11px; } svg text.title { fill: var(--ink); font-size: 13px;
  font-weight: 600; }
svg path { fill: none; stroke-width: 1.8; stroke-linejoin: round; }
.grid { stroke: var(--line); } .axis { stroke: var(--soft); }
.s0 { stroke: var(--c0); } .s1 { stroke: var(--c1); } .s2 { stroke: var(--c2); } .s3 { stroke: var(--c3); }
.s4 { stroke: var(--c4); } .s5 { stroke: var(--c5); }
.s0.dot { fill: var(--c0); } .s1.dot { fill: var(--c1); } .s2.dot { fill: var(--c2); }
svg line.s0, svg line.s1, svg line.s2 { stroke-width: 2.4; }
.worst { fill: none; stroke: var(--bad); stroke-width: 1.8; }
.sheet { display: flex; gap: 8px; margin: 6px 0 12px; align-items: flex-start; }
.sheet p { width: 84px; flex: none; margin: 0; font-weight: 600; font-size: 13px; overflow-wrap: anywhere; }
.sheet small { font-weight: 400; color: var(--soft); }
.sheet figure { flex: 1 1 0; min-width: 0; max-width: 170px; }
.sheet img { width: 100%; display: block; background: #000; border-radius: 3px; }
figcaption { color: var(--soft); font-size: 12px; padding-top: 2px; }
footer { margin-top: 48px; border-top: 1px solid var(--line); padding-top: 10px; }
@media (max-width: 600px) { main { padding: 20px 14px; } .charts { grid-template-columns: 1fr; }
  .sheet { flex-wrap: wrap; } .sheet p { width: 100%; } .sheet figure { flex-basis: 30%; }
  table { display: block; overflow-x: auto; } }
@media print { main { max-width: none; padding: 0; } h2 { break-after: avoid; }
  .sheet, figure, tr { break-inside: avoid; } }
)css";

}  // namespace beam
