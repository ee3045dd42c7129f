// SPDX-License-Identifier: Apache-2.0
#include "ui/parameter_form.h"

#include <QGridLayout>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

#include "ui/field_editors.h"

namespace beam {
namespace {

QString tipOf(const Field& field, const FieldValue& standard) {
  const FieldInfo& info = field.info;
  QStringList lines{QString("<b>%1</b>").arg(QString::fromStdString(info.label).toHtmlEscaped()),
                    QString::fromStdString(info.help).toHtmlEscaped()};
  QString facts = QString("preset value %1").arg(valueText(standard).toHtmlEscaped());
  if (const QString range = rangeText(info); !range.isEmpty()) facts += ", " + range;
  if (!info.unit.empty()) facts += " " + QString::fromStdString(info.unit).toHtmlEscaped();
  lines << facts << QString("<code>--set %1=…</code>").arg(QString::fromStdString(info.name).toHtmlEscaped());
  if (info.effect == Effect::SpeedOnly) lines << "Changes speed only, never results.";
  return lines.join("<br>");
}

}  // namespace

ParameterForm::ParameterForm(QWidget* parent) : QWidget(parent) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
}

void ParameterForm::setFields(const std::vector<Field>& fields, const std::vector<FieldValue>& standard) {
  std::vector<std::string> names;
  for (const Field& field : fields) names.push_back(field.info.name);
  if (names != names_) {
    names_ = names;
    rebuild(fields, standard);
  }
  for (std::size_t i = 0; i < fields.size(); ++i) update(rows_.at(names[i]), fields[i], standard[i]);
}

void ParameterForm::rebuild(const std::vector<Field>& fields, const std::vector<FieldValue>& standard) {
  delete body_;
  rows_.clear();
  body_ = new QWidget;
  layout()->addWidget(body_);
  auto* column = new QVBoxLayout(body_);
  column->setContentsMargins(0, 0, 0, 0);
  const auto newGrid = [](QWidget* owner) {
    auto* grid = new QGridLayout(owner);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setVerticalSpacing(6);
    grid->setColumnStretch(1, 1);
    return grid;
  };
  auto* basic = new QWidget;
  QGridLayout* basic_grid = newGrid(basic);
  advanced_ = new QWidget;
  QGridLayout* advanced_grid = newGrid(advanced_);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    addRow(fields[i].info.advanced ? *advanced_grid : *basic_grid, fields[i], standard[i]);
  }
  fold_ = new QToolButton;
  fold_->setObjectName("flat");
  fold_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  fold_->setText(QString("Advanced (%1)").arg(advanced_grid->rowCount() / 2));
  const auto show = [this](bool on) {
    unfolded_ = on;
    advanced_->setVisible(on);
    fold_->setArrowType(on ? Qt::DownArrow : Qt::RightArrow);
  };
  connect(fold_, &QToolButton::clicked, this, [this, show] { show(!unfolded_); });
  column->addWidget(basic);
  column->addWidget(fold_);
  column->addWidget(advanced_);
  show(unfolded_);
  fold_->setVisible(advanced_grid->count() > 0);
  if (fields.empty()) {
    auto* nothing = new QLabel("This stage has no settings.");
    nothing->setObjectName("quiet");
    column->addWidget(nothing);
  }
}

void ParameterForm::addRow(QGridLayout& grid, const Field& field, const FieldValue& standard) {
  Row row;
  row.label = new QLabel(QString::fromStdString(field.info.label));
  row.label->setToolTip(tipOf(field, standard));
  row.label->setWordWrap(true);
  row.editor = makeFieldEditor(field);
  row.editor->setToolTip(row.label->toolTip());
  row.editor->setMinimumWidth(90);
  row.reset = new QToolButton;
  row.reset->setObjectName("flat");
  row.reset->setText("↺");
  row.reset->setToolTip("Back to the preset's value, " + valueText(standard));
  row.trouble = new QLabel;
  row.trouble->setStyleSheet("color: #ee8d83");
  row.trouble->setWordWrap(true);
  row.trouble->hide();
  auto* unit = new QLabel(QString::fromStdString(field.info.unit));
  unit->setObjectName("quiet");
  const std::string name = field.info.name;
  connect(row.editor, &FieldEditor::edited, this,
          [this, name](const FieldValue& value) { Q_EMIT edited(name, value); });
  connect(row.editor, &FieldEditor::refused, row.trouble, [label = row.trouble](const QString& why) {
    label->setText(why);
    label->setVisible(!why.isEmpty());
  });
  connect(row.reset, &QToolButton::clicked, this, [this, name] { Q_EMIT resetWanted(name); });
  const int at = grid.rowCount();
  grid.addWidget(row.label, at, 0);
  grid.addWidget(row.editor, at, 1);
  grid.addWidget(unit, at, 2);
  grid.addWidget(row.reset, at, 3);
  grid.addWidget(row.trouble, at + 1, 0, 1, 4);
  rows_[name] = row;
}

void ParameterForm::update(Row& row, const Field& field, const FieldValue& standard) {
  row.changed = field.value != standard;
  row.editor->show(field.value);
  QFont font = row.label->font();
  font.setBold(row.changed);
  row.label->setFont(font);
  // The button keeps its place, so that nothing jumps under the hand.
  row.reset->setEnabled(row.changed);
  row.reset->setText(row.changed ? "↺" : " ");
  row.reset->setToolTip("Back to the preset's value, " + valueText(standard));
}

FieldEditor* ParameterForm::editor(const std::string& name) const {
  const auto row = rows_.find(name);
  return row == rows_.end() ? nullptr : row->second.editor;
}

bool ParameterForm::isMarkedChanged(const std::string& name) const { return rows_.at(name).changed; }

bool ParameterForm::advancedShown() const { return unfolded_; }

}  // namespace beam
