// SPDX-License-Identifier: Apache-2.0
#include "ui/field_row.h"

#include <QLabel>
#include <QStyle>
#include <QToolButton>
#include <QVariant>

#include <algorithm>

#include "core/base/field_text.h"
#include "ui/field_editors.h"

namespace beam {
namespace {

constexpr int kGap = 6;
constexpr double kEditorShare = 0.42;  // of the width, where the label stands beside it

QString escaped(const std::string& text) { return QString::fromStdString(text).toHtmlEscaped(); }

QString tipOf(const Field& field, const FieldValue& standard) {
  const FieldInfo& info = field.info;
  QString facts = QString("preset value %1").arg(valueText(standard).toHtmlEscaped());
  if (const std::string range = rangeText(info); !range.empty()) facts += ", range " + escaped(range);
  QStringList lines{QString("<b>%1</b>").arg(escaped(info.label)), escaped(info.help), facts,
                    QString("<code>--set %1=…</code>").arg(escaped(info.name))};
  switch (info.effect) {
    case Effect::Result:
      break;
    case Effect::LaterResults:
      lines << "Changes frames that are computed from now on; results that are there stay as they are.";
      break;
    case Effect::Pictures:
      lines << "Changes how results are drawn, never results.";
      break;
    case Effect::SpeedOnly:
      lines << "Changes speed only, never results.";
      break;
  }
  return lines.join("<br>");
}

QString labelOf(const FieldInfo& info) {
  const QString label = QString::fromStdString(info.label), unit = QString::fromStdString(info.unit);
  return unit.isEmpty() || label.contains(unit, Qt::CaseInsensitive) ? label
                                                                     : QString("%1 (%2)").arg(label, unit);
}

}  // namespace

FieldRow::FieldRow(const Field& field, QWidget* parent)
    : QWidget(parent),
      label_(new QLabel(labelOf(field.info), this)),
      editor_(makeFieldEditor(field, this)),
      reset_(new QToolButton(this)) {
  label_->setWordWrap(true);
  label_->setBuddy(editor_->focusProxy());
  QSizePolicy policy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  policy.setHeightForWidth(true);
  setSizePolicy(policy);
  reset_->setObjectName("flat");
  reset_->setText("↺");
  connect(reset_, &QToolButton::clicked, this, [this] {
    editor_->restore();
    Q_EMIT resetWanted();
  });
}

void FieldRow::update(const Field& field, const FieldValue& standard, const QString& why_not) {
  changed_ = field.value != standard;
  editor_->show(field.value);
  QString tip = tipOf(field, standard);
  if (!why_not.isEmpty()) tip += "<br><i>" + why_not.toHtmlEscaped() + "</i>";
  label_->setToolTip(tip);
  editor_->setTip(tip);
  editor_->setReadOnly(!why_not.isEmpty());
  showChanged();
  // The button keeps its place, so that nothing jumps under the hand.
  reset_->setEnabled(changed_ && why_not.isEmpty());
  reset_->setText(changed_ ? "↺" : " ");
  const QString value = valueText(standard);
  reset_->setToolTip(!why_not.isEmpty() ? why_not
                     : changed_         ? "Back to the preset's value, " + value
                                        : "This is the preset's value, " + value);
  updateGeometry();
}

// By the sheet: a font that is set by hand does not outlive a change of theme.
void FieldRow::showChanged() {
  if (label_->property("changed").toBool() == changed_) return;
  label_->setProperty("changed", changed_);
  label_->style()->unpolish(label_);
  label_->style()->polish(label_);
}

int FieldRow::longestWord() const {
  QFont bold = label_->font();  // becoming bold must not break the row
  bold.setBold(true);
  const QFontMetrics metrics(bold);
  int longest = 0;
  for (const QString& word : label_->text().split(' '))
    longest = std::max(longest, metrics.horizontalAdvance(word));
  return longest + 1;
}

int FieldRow::besideWidth() const {
  const int editor = editor_->minimumSizeHint().width(), reset = reset_->sizeHint().width();
  if (editor_->isSmall()) return longestWord() + editor + reset + 2 * kGap;
  const int by_editor = static_cast<int>(editor / kEditorShare);
  const int by_label = static_cast<int>((longestWord() + reset + 2 * kGap) / (1 - kEditorShare));
  return std::max(by_editor, by_label) + 1;
}

void FieldRow::setStackedBelow(int width) {
  stacked_below_ = width;
  updateGeometry();
  place();
}

void FieldRow::place() {
  const Places places = placesAt(width());
  label_->setGeometry(places.label);
  editor_->setGeometry(places.editor);
  reset_->setGeometry(places.reset);
}

FieldRow::Places FieldRow::placesAt(int width) const {
  const bool stacked = width < stacked_below_;
  const QSize reset = reset_->sizeHint();
  const int editor_height = editor_->sizeHint().height();
  const int right = width - reset.width(), beside = static_cast<int>(width * kEditorShare);
  int label_width = width, editor_x = 0, editor_width = right - kGap;
  if (editor_->isSmall()) {
    editor_width = editor_->sizeHint().width();
    editor_x = right - kGap - (stacked ? editor_width : beside);
    label_width = editor_x - kGap;
  } else if (!stacked) {
    editor_width = beside;
    editor_x = right - kGap - beside;
    label_width = editor_x - kGap;
  }
  const int label_height = label_->heightForWidth(std::max(label_width, 1));
  if (label_width == width) {
    const int row = std::max(editor_height, reset.height());
    return {{0, 0, width, label_height},
            {0, label_height + 2, editor_width, editor_height},
            {right, label_height + 2 + (row - reset.height()) / 2, reset.width(), reset.height()},
            label_height + 2 + row};
  }
  const int height = std::max({label_height, editor_height, reset.height()});
  const auto middle = [height](int of) { return (height - of) / 2; };
  return {{0, middle(label_height), label_width, label_height},
          {editor_x, middle(editor_height), editor_width, editor_height},
          {right, middle(reset.height()), reset.width(), reset.height()},
          height};
}

int FieldRow::heightForWidth(int width) const { return placesAt(width).height; }

QSize FieldRow::sizeHint() const {
  const int width = std::max(stacked_below_, minimumSizeHint().width());
  return {width, placesAt(width).height};
}

QSize FieldRow::minimumSizeHint() const {
  const int reset = reset_->sizeHint().width();
  const int editor = editor_->minimumSizeHint().width() + kGap + reset;
  const int width = editor_->isSmall() ? longestWord() + kGap + editor : std::max(longestWord(), editor);
  return {width, editor_->sizeHint().height()};
}

void FieldRow::resizeEvent(QResizeEvent*) { place(); }

}  // namespace beam
