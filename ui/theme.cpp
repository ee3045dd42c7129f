// SPDX-License-Identifier: Apache-2.0
#include "ui/theme.h"

#include <QApplication>
#include <QFile>
#include <QFont>
#include <QPalette>
#include <QRegularExpression>
#include <QStyleFactory>

#include <algorithm>
#include <cmath>
#include <map>

// Resources of a static library are linked only when named; the macro must stand outside of namespaces.
static void nameTheme() { Q_INIT_RESOURCE(theme); }

namespace beam {
namespace {

constexpr double kText_px = 13, kTitle_px = 22, kMono_px = 12, kBox_px = 14, kBar_px = 16;
constexpr double kSmall = 11.5 / 13;

Colors darkColors() {
  Colors c;
  c.window = "#232529", c.chrome = "#1d1f22", c.edge = "#17181a", c.field = "#1d1f22", c.inside = "#222428";
  c.card = "#26292d", c.control = "#2d3035", c.control_edge = "#3d4148", c.hover = "#363a40";
  c.hover_edge = "#555b64", c.chosen = "#2f4a6b";
  c.text = "#d9dce1", c.strong = "#f0f2f5", c.muted = "#a7adb6", c.quiet = "#8d939c", c.disabled = "#6f757e";
  c.accent = "#5b9bf0", c.primary = "#2f6cc0", c.primary_text = "#ffffff", c.selection = "#3d6fb4",
  c.progress = "#3d6fb4";
  c.done = "#6fbf73", c.failed = "#f0796c", c.warning = "#e0b35c", c.stale = "#d9a84e", c.running = "#5b9bf0";
  c.on_mark = "#15171a";
  c.lane_empty = "#363a40", c.lane_done = "#5b9a5f", c.lane_queued = "#40536d", c.lane_blocked = "#3c3527";
  c.lane_interpolated = "#39493b";
  c.error_back = "#3b2523", c.error_edge = "#7c423c", c.error_text = "#f3d9d6";
  c.notice_back = "#24313f", c.notice_edge = "#3c5a7c", c.notice_text = "#d4e2f3";
  return c;
}

Colors lightColors() {
  Colors c;
  c.window = "#eceef1", c.chrome = "#e2e5e9", c.edge = "#c9cdd3", c.field = "#fafbfc", c.inside = "#f3f5f7";
  c.card = "#f4f5f7", c.control = "#fbfcfd", c.control_edge = "#b9bec6", c.hover = "#dfe4ea";
  c.hover_edge = "#8d949e", c.chosen = "#c5dbf7";
  c.text = "#22262b", c.strong = "#0d0f12", c.muted = "#4a515a", c.quiet = "#5d646e", c.disabled = "#8f959e";
  c.accent = "#1f6fd6", c.primary = "#2467bd", c.primary_text = "#ffffff", c.selection = "#3d6fb4",
  c.progress = "#85b5f0";
  c.done = "#2f8a3a", c.failed = "#c3392b", c.warning = "#8f6200", c.stale = "#a87400", c.running = "#1f6fd6";
  c.on_mark = "#ffffff";
  c.lane_empty = "#d3d7dc", c.lane_done = "#58a661", c.lane_queued = "#b7cbe6", c.lane_blocked = "#ddd2ba";
  c.lane_interpolated = "#cfe3d1";
  c.error_back = "#fbe3e0", c.error_edge = "#d9968e", c.error_text = "#5a1811";
  c.notice_back = "#dfeaf8", c.notice_edge = "#92b4dd", c.notice_text = "#14304f";
  return c;
}

struct Look {
  Colors colors = darkColors();
  bool dark = true;
};
Look& look() {
  static Look the_look;
  return the_look;
}

// What the desktop said before this program chose its own palette.
bool desktopIsDark() {
  static const bool dark = QApplication::palette().color(QPalette::Window).lightnessF() < 0.5;
  return dark;
}

QPalette paletteOf(const Colors& c) {
  QPalette palette;  // for what the sheet does not reach: indicators, disabled text, native drawing
  palette.setColor(QPalette::Window, c.window);
  palette.setColor(QPalette::WindowText, c.text);
  palette.setColor(QPalette::Base, c.field);
  palette.setColor(QPalette::AlternateBase, c.inside);
  palette.setColor(QPalette::Text, c.text);
  palette.setColor(QPalette::Button, c.control);
  palette.setColor(QPalette::ButtonText, c.text);
  palette.setColor(QPalette::Highlight, c.selection);
  palette.setColor(QPalette::HighlightedText, Qt::white);
  palette.setColor(QPalette::ToolTipBase, c.control);
  palette.setColor(QPalette::ToolTipText, c.strong);
  palette.setColor(QPalette::PlaceholderText, c.quiet);
  palette.setColor(QPalette::Link, c.accent);  // the ring of a view, too
  return palette;
}

std::map<QString, QString> wordsOfSheet(const Look& look, double scale) {
  const Colors& c = look.colors;
  const auto px = [scale](double size) { return QString("%1px").arg(std::lround(size * scale)); };
  std::map<QString, QString> words{{"title_px", px(kTitle_px)},
                                   {"mono_px", px(kMono_px)},
                                   {"box_px", px(kBox_px)},
                                   {"bar_px", px(kBar_px)}};
  const std::map<QString, QColor> named{{"window", c.window},
                                        {"chrome", c.chrome},
                                        {"edge", c.edge},
                                        {"field", c.field},
                                        {"inside", c.inside},
                                        {"card", c.card},
                                        {"card_edge", c.control_edge.darker(look.dark ? 120 : 95)},
                                        {"control", c.control},
                                        {"control_edge", c.control_edge},
                                        {"hover", c.hover},
                                        {"hover_edge", c.hover_edge},
                                        {"chosen", c.chosen},
                                        {"chosen_edge", c.accent.darker(140)},
                                        {"text", c.text},
                                        {"strong", c.strong},
                                        {"muted", c.muted},
                                        {"quiet", c.quiet},
                                        {"disabled", c.disabled},
                                        {"accent", c.accent},
                                        {"primary", c.primary},
                                        {"primary_edge", c.primary.lighter(120)},
                                        {"primary_off", look.dark ? QColor("#2a3645") : QColor("#c9d4e2")},
                                        {"primary_text", c.primary_text},
                                        {"focus_on_primary", c.strong},
                                        {"selection", c.selection},
                                        {"progress", c.progress},
                                        {"failed", c.failed},
                                        {"error_back", c.error_back},
                                        {"error_edge", c.error_edge},
                                        {"error_text", c.error_text},
                                        {"notice_back", c.notice_back},
                                        {"notice_edge", c.notice_edge},
                                        {"notice_text", c.notice_text}};
  for (const auto& [name, color] : named) words[name] = color.name();
  for (const char* icon : {"down", "close"}) words[icon] = QString(icon) + (look.dark ? ".png" : "-dark.png");
  return words;
}

QString filledIn(const QString& sheet, const std::map<QString, QString>& words) {
  static const QRegularExpression kName("@([a-z_]+)");
  QString filled;
  int at = 0;
  for (auto it = kName.globalMatch(sheet); it.hasNext();) {
    const QRegularExpressionMatch match = it.next();
    const auto word = words.find(match.captured(1));
    filled += sheet.mid(at, match.capturedStart() - at) + (word == words.end() ? QString() : word->second);
    at = match.capturedEnd();
  }
  return filled + sheet.mid(at);
}

}  // namespace

const Colors& colors() { return look().colors; }

void applyTheme(QApplication& application, Theme theme, double text_scale) {
  nameTheme();
  const bool desktop_dark = desktopIsDark();
  look().dark = theme == Theme::Dark || (theme == Theme::System && desktop_dark);
  look().colors = look().dark ? darkColors() : lightColors();
  const double scale = std::clamp(text_scale, 0.5, 3.0);
  QApplication::setStyle(QStyleFactory::create("Fusion"));
  QApplication::setPalette(paletteOf(colors()));
  QFont font = QApplication::font();
  font.setPixelSize(static_cast<int>(std::lround(kText_px * scale)));
  QApplication::setFont(font);
  QFile sheet(":/theme/studio.qss");
  if (sheet.open(QIODevice::ReadOnly))
    application.setStyleSheet(filledIn(QString::fromUtf8(sheet.readAll()), wordsOfSheet(look(), scale)));
}

WithoutSheet::WithoutSheet() : sheet_(qApp->styleSheet()) {
  if (!sheet_.isEmpty()) qApp->setStyleSheet({});
}

WithoutSheet::~WithoutSheet() {
  if (!sheet_.isEmpty()) qApp->setStyleSheet(sheet_);
}

QFont smallFont(const QFont& font) {
  QFont small = font;
  if (font.pixelSize() > 0) {
    small.setPixelSize(std::max(1, static_cast<int>(std::lround(font.pixelSize() * kSmall))));
  } else {
    small.setPointSizeF(font.pointSizeF() * kSmall);
  }
  return small;
}

}  // namespace beam
