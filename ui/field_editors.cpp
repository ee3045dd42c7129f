// SPDX-License-Identifier: Apache-2.0
#include "ui/field_editors.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QStyle>

#include <cmath>
#include <optional>

#include "core/base/error.h"

namespace beam {
namespace {

QHBoxLayout* rowOf(QWidget* owner) {
  auto* row = new QHBoxLayout(owner);
  row->setContentsMargins(0, 0, 0, 0);
  return row;
}

class BoolEditor final : public FieldEditor {
 public:
  BoolEditor(const Field& field, QWidget* parent) : FieldEditor(parent), box_(new QCheckBox) {
    rowOf(this)->addWidget(box_);
    show(field.value);
    connect(box_, &QCheckBox::clicked, this, [this](bool on) { Q_EMIT edited(FieldValue(on)); });
  }
  void show(const FieldValue& value) override { box_->setChecked(std::get<bool>(value)); }

 private:
  QCheckBox* box_;
};

class ChoiceEditor final : public FieldEditor {
 public:
  ChoiceEditor(const Field& field, QWidget* parent) : FieldEditor(parent), box_(new QComboBox) {
    for (const std::string& choice : field.info.choices) box_->addItem(QString::fromStdString(choice));
    box_->setFocusPolicy(Qt::StrongFocus);
    rowOf(this)->addWidget(box_);
    show(field.value);
    connect(box_, QOverload<int>::of(&QComboBox::activated), this,
            [this] { Q_EMIT edited(FieldValue(box_->currentText().toStdString())); });
  }
  void show(const FieldValue& value) override {
    box_->setCurrentText(QString::fromStdString(std::get<std::string>(value)));
  }

 private:
  QComboBox* box_;
};

// Numbers are typed: spin boxes round 1.6e-4 away.
class TextEditor final : public FieldEditor {
 public:
  TextEditor(const Field& field, QWidget* parent)
      : FieldEditor(parent), info_(field.info), line_(new QLineEdit) {
    QHBoxLayout* row = rowOf(this);
    row->addWidget(line_, 1);
    show(field.value);
    connect(line_, &QLineEdit::textEdited, this, [this] { check(); });
    connect(line_, &QLineEdit::editingFinished, this, &TextEditor::finish);
  }
  void show(const FieldValue& value) override {
    shown_ = value;
    line_->setText(valueText(value));
    mark({});
  }

 private:
  std::optional<FieldValue> typed(QString& why) const {
    const QString text = line_->text().trimmed();
    bool good = true;
    FieldValue value = text.toStdString();
    if (std::holds_alternative<int>(shown_)) {
      value = text.toInt(&good);
      if (!good) why = "a whole number is expected here";
    } else if (std::holds_alternative<double>(shown_)) {
      const double number = text.toDouble(&good);
      good = good && std::isfinite(number);
      value = number;
      if (!good) why = "a number is expected here";
    }
    if (!good) return std::nullopt;
    try {
      checkRange(info_, value);
    } catch (const Error& e) {  // typing is not failing: the words stay beside the field
      why = QString::fromStdString(e.what());
      return std::nullopt;
    }
    return value;
  }
  std::optional<FieldValue> check() {
    QString why;
    const std::optional<FieldValue> value = typed(why);
    mark(why);
    return value;
  }
  void mark(const QString& why) {
    line_->setProperty("wrong", !why.isEmpty());
    line_->setToolTip(why);
    line_->style()->unpolish(line_);
    line_->style()->polish(line_);
    Q_EMIT refused(why);
  }
  void finish() {
    if (const std::optional<FieldValue> value = check(); value && *value != shown_) {
      shown_ = *value;
      Q_EMIT edited(*value);
    }
  }

  FieldInfo info_;
  FieldValue shown_;
  QLineEdit* line_;
};

}  // namespace

FieldEditor* makeFieldEditor(const Field& field, QWidget* parent) {
  if (std::holds_alternative<bool>(field.value)) return new BoolEditor(field, parent);
  if (!field.info.choices.empty()) return new ChoiceEditor(field, parent);
  return new TextEditor(field, parent);
}

QString valueText(const FieldValue& value) { return QString::fromStdString(toText(value)); }

QString rangeText(const FieldInfo& info) {
  const bool low = std::isfinite(info.min), high = std::isfinite(info.max);
  if (low && high) return QString("%1 to %2").arg(info.min).arg(info.max);
  if (low) return QString("at least %1").arg(info.min);
  if (high) return QString("at most %1").arg(info.max);
  return {};
}

}  // namespace beam
