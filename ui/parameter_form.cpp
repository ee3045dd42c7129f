// SPDX-License-Identifier: Apache-2.0
#include "ui/parameter_form.h"

#include <QEvent>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

#include "ui/field_editors.h"
#include "ui/field_row.h"
#include "ui/words.h"

namespace beam {
namespace {

QVBoxLayout* columnOf(QWidget* owner) {
  auto* column = new QVBoxLayout(owner);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(6);
  return column;
}

}  // namespace

ParameterForm::ParameterForm(QWidget* parent) : QWidget(parent) { columnOf(this); }

void ParameterForm::setFields(const std::vector<Field>& fields, const std::vector<FieldValue>& standard,
                              const std::vector<QString>& headings) {
  std::vector<std::string> names;
  for (const Field& field : fields) names.push_back(field.info.name);
  if (names != names_ || !body_) {
    restore();
    names_ = names;
    rebuild(fields, headings);
  }
  for (std::size_t i = 0; i < fields.size(); ++i)
    rows_.at(names[i])->update(fields[i], standard[i], why_not_);
}

void ParameterForm::rebuild(const std::vector<Field>& fields, const std::vector<QString>& headings) {
  delete body_;
  rows_.clear();
  body_ = new QWidget;
  layout()->addWidget(body_);
  QVBoxLayout* column = columnOf(body_);
  column->addWidget(makePart(fields, headings, false));
  fold_ = new QToolButton;
  fold_->setObjectName("flat");
  fold_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  fold_->setText(
      QString("Advanced (%1)").arg(std::count_if(fields.begin(), fields.end(), [](const Field& field) {
        return field.info.advanced;
      })));
  fold_->setToolTip("Settings that seldom need a change");
  connect(fold_, &QToolButton::clicked, this, [this] { unfold(!unfolded_); });
  column->addWidget(fold_);
  advanced_ = makePart(fields, headings, true);
  column->addWidget(advanced_);
  fold_->setVisible(
      std::any_of(fields.begin(), fields.end(), [](const Field& f) { return f.info.advanced; }));
  unfold(unfolded_);
  if (fields.empty()) {
    auto* nothing = new QLabel("This stage has no settings.");
    nothing->setObjectName("quiet");
    nothing->setWordWrap(true);
    column->addWidget(nothing);
  }
  agreeOnStacking();
}

QWidget* ParameterForm::makePart(const std::vector<Field>& fields, const std::vector<QString>& headings,
                                 bool advanced) {
  auto* part = new QWidget;
  QVBoxLayout* column = columnOf(part);
  QString heading;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].info.advanced != advanced) continue;
    if (i < headings.size() && headings[i] != heading) {
      heading = headings[i];
      auto* words = new QLabel(heading);
      words->setObjectName("quiet");
      words->setWordWrap(true);
      column->addSpacing(6);
      column->addWidget(words);
    }
    addRow(*part, fields[i]);
  }
  return part;
}

void ParameterForm::addRow(QWidget& part, const Field& field) {
  const std::string name = field.info.name;
  auto* row = new FieldRow(field);
  connect(row->editor(), &FieldEditor::edited, this,
          [this, name](const FieldValue& value) { Q_EMIT edited(name, value); });
  connect(row->editor(), &FieldEditor::refused, this, [this, name](const QString& why) { note(name, why); });
  connect(row, &FieldRow::resetWanted, this, [this, name] { Q_EMIT resetWanted(name); });
  part.layout()->addWidget(row);
  rows_[name] = row;
}

void ParameterForm::unfold(bool on) {
  unfolded_ = on;
  advanced_->setVisible(on);
  fold_->setArrowType(on ? Qt::DownArrow : Qt::RightArrow);
}

// All beside or all above: a form of both is ragged.
void ParameterForm::agreeOnStacking() {
  int beside = 0;
  for (const auto& [name, row] : rows_) beside = std::max(beside, row->besideWidth());
  for (const auto& [name, row] : rows_) row->setStackedBelow(beside);
}

void ParameterForm::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) agreeOnStacking();
}

void ParameterForm::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  agreeOnStacking();  // styles are on only now
}

void ParameterForm::note(const std::string& name, const QString& why) {
  const QString before = trouble();
  std::erase_if(troubles_, [&](const Trouble& t) { return t.name == name; });
  if (!why.isEmpty()) troubles_.push_back({name, why});
  if (trouble() != before) Q_EMIT troubleChanged(trouble());
}

QString ParameterForm::trouble() const {
  if (troubles_.empty()) return {};
  const std::size_t more = troubles_.size() - 1;
  if (more == 0) return troubles_.back().why;
  const QString others = countText(static_cast<std::int64_t>(more), "more field");
  return QString("%1 (and %2)").arg(troubles_.back().why, others);
}

FieldEditor* ParameterForm::troubledEditor() const {
  return troubles_.empty() ? nullptr : editor(troubles_.back().name);
}

std::optional<QString> ParameterForm::takeOver() {
  FieldEditor* const last = troubledEditor();
  for (const auto& [name, row] : rows_) {
    if (row->editor() != last) row->editor()->takeOver();
  }
  if (last) last->takeOver();  // stays the last touched one
  if (troubles_.empty()) return std::nullopt;
  if (advanced_->isAncestorOf(troubledEditor())) unfold(true);
  return trouble();
}

void ParameterForm::restore() {
  for (const auto& [name, row] : rows_) row->editor()->restore();
}

FieldEditor* ParameterForm::editor(const std::string& name) const {
  const auto row = rows_.find(name);
  return row == rows_.end() ? nullptr : row->second->editor();
}

bool ParameterForm::isMarkedChanged(const std::string& name) const { return rows_.at(name)->isChanged(); }

std::vector<std::string> ParameterForm::changedNames() const {
  std::vector<std::string> changed;
  for (const std::string& name : names_) {
    if (rows_.at(name)->isChanged()) changed.push_back(name);
  }
  return changed;
}

bool ParameterForm::advancedShown() const { return unfolded_; }

}  // namespace beam
