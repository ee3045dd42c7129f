// SPDX-License-Identifier: Apache-2.0
#include "ui/field_editors.h"

#include <QCheckBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLineEdit>
#include <QRegularExpression>
#include <QStyle>

#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/base/field_text.h"
#include "ui/quiet_combo.h"
#include "ui/words.h"

namespace beam {
namespace {

constexpr int kLongestFound = 24;  // characters of a refused text that are said again

QHBoxLayout* rowOf(QWidget* owner) {
  auto* row = new QHBoxLayout(owner);
  row->setContentsMargins(0, 0, 0, 0);
  return row;
}

bool isReturn(const QKeyEvent& event) {
  return event.key() == Qt::Key_Return || event.key() == Qt::Key_Enter;
}

bool isCommand(const QKeyEvent& event) {
  return event.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier);
}

class BoolEditor final : public FieldEditor {
 public:
  BoolEditor(const Field& field, QWidget* parent) : FieldEditor(parent), box_(new QCheckBox) {
    rowOf(this)->addWidget(box_);
    setFocusProxy(box_);
    show(field.value);
    connect(box_, &QCheckBox::clicked, this, [this](bool on) { Q_EMIT edited(FieldValue(on)); });
  }
  void show(const FieldValue& value) override { box_->setChecked(std::get<bool>(value)); }
  void setReadOnly(bool read_only) override { box_->setEnabled(!read_only); }
  void setTip(const QString& tip) override { box_->setToolTip(tip); }
  bool isSmall() const override { return true; }

 private:
  QCheckBox* box_;
};

class ChoiceEditor final : public FieldEditor {
 public:
  ChoiceEditor(const Field& field, QWidget* parent) : FieldEditor(parent), box_(new QuietCombo) {
    for (const std::string& choice : field.info.choices) box_->addItem(QString::fromStdString(choice));
    rowOf(this)->addWidget(box_);
    setFocusProxy(box_);
    show(field.value);
    connect(box_, QOverload<int>::of(&QComboBox::activated), this,
            [this] { Q_EMIT edited(FieldValue(box_->currentText().toStdString())); });
  }
  void show(const FieldValue& value) override {
    box_->setCurrentText(QString::fromStdString(std::get<std::string>(value)));
  }
  void setReadOnly(bool read_only) override { box_->setEnabled(!read_only); }
  void setTip(const QString& tip) override { box_->setHelp(tip); }

 private:
  QuietCombo* box_;
};

// 1,000 and 1e3 are whole numbers, too.
std::optional<int> wholeNumber(QString text) {
  static const QRegularExpression kGrouped("^[+-]?[0-9]{1,3}(,[0-9]{3})+$");
  if (kGrouped.match(text).hasMatch()) text.remove(',');
  bool good = true;
  const int whole = text.toInt(&good);
  if (good) return whole;
  const double number = text.toDouble(&good);
  if (!good || number != std::floor(number) || std::abs(number) > 2147483647.0) return std::nullopt;
  return static_cast<int>(number);
}

std::optional<FieldValue> parsed(const FieldInfo& info, const FieldValue& like, const QString& text) {
  FieldValue value = text.toStdString();
  if (std::holds_alternative<int>(like)) {
    const std::optional<int> whole = wholeNumber(text);
    if (!whole) return std::nullopt;
    value = *whole;
  } else if (std::holds_alternative<double>(like)) {
    bool good = true;
    value = text.toDouble(&good);
    if (!good) return std::nullopt;
  }
  try {
    checkRange(info, value);
  } catch (const Error&) {  // typing is not failing: the caller says what is expected
    return std::nullopt;
  }
  return value;
}

// Numbers are typed: spin boxes round 1.6e-4 away.
class TextEditor final : public FieldEditor {
 public:
  TextEditor(const Field& field, QWidget* parent)
      : FieldEditor(parent), info_(field.info), line_(new QLineEdit) {
    rowOf(this)->addWidget(line_, 1);
    setFocusProxy(line_);
    line_->setMinimumWidth(0);
    line_->installEventFilter(this);
    show(field.value);
    connect(line_, &QLineEdit::textEdited, this, &TextEditor::look);
    connect(line_, &QLineEdit::editingFinished, this, &TextEditor::takeOver);
  }
  // A field that goes while it has the focus is left first: this must not hear of it any more.
  ~TextEditor() override { line_->disconnect(this); }
  void show(const FieldValue& value) override {
    shown_ = value;
    if (!typed_) display();
  }
  QString takeOver() override {
    if (!typed_) return {};
    const QString text = line_->text().trimmed();
    const std::optional<FieldValue> value = parsed(info_, shown_, text);
    if (!value) {
      mark(refusal(text));
      return why_;
    }
    typed_ = false;
    const bool news = *value != shown_;
    shown_ = *value;
    display();
    if (news) Q_EMIT edited(*value);
    return {};
  }
  void restore() override {
    typed_ = false;
    display();
  }
  void setReadOnly(bool read_only) override { line_->setReadOnly(read_only); }
  void setTip(const QString& tip) override {
    tip_ = tip;
    showTip();
  }
  QSize minimumSizeHint() const override {
    const int digits = line_->fontMetrics().horizontalAdvance("0.000001");
    const QSize line = line_->minimumSizeHint();
    return {std::max(line.width(), digits + line_->fontMetrics().maxWidth()), line.height()};
  }

 protected:
  bool eventFilter(QObject* object, QEvent* event) override {
    const bool asked = event->type() == QEvent::ShortcutOverride;
    if (!asked && event->type() != QEvent::KeyPress) return FieldEditor::eventFilter(object, event);
    const auto& key = *static_cast<QKeyEvent*>(event);
    const bool escape = key.key() == Qt::Key_Escape && !isCommand(key);
    // Ctrl+Return is the window's: it takes the value over itself. Where no shortcut heard it, it ends here.
    const bool enter = isReturn(key) && !(asked && isCommand(key));
    if (!escape && !enter) return FieldEditor::eventFilter(object, event);
    if (!asked && escape) restore();
    if (!asked && enter) takeOver();
    event->accept();
    return true;
  }

 private:
  // The value that is shown rounded is not changed by typing a letter and taking it away.
  void look() {
    const QString text = line_->text().trimmed();
    typed_ = text != shownText(shown_);
    mark(typed_ && !parsed(info_, shown_, text) ? refusal(text) : QString());
  }
  QString refusal(const QString& text) const {
    QString found = text.isEmpty() ? QString("nothing") : '"' + text + '"';
    if (text.size() > kLongestFound) found = '"' + text.left(kLongestFound - 1) + "…\"";
    return QString("%1 expects %2, found %3")
        .arg(QString::fromStdString(info_.label), QString::fromStdString(expectedText(info_, shown_)), found);
  }
  void display() {
    const QString text = shownText(shown_);
    if (line_->text() != text) {
      line_->setText(text);
      if (!line_->hasFocus()) line_->setCursorPosition(0);  // the digits that count stay in view
    }
    mark({});
  }
  void mark(const QString& why) {
    why_ = why;
    if (line_->property("wrong").toBool() == why.isEmpty()) {
      line_->setProperty("wrong", !why.isEmpty());
      line_->style()->unpolish(line_);
      line_->style()->polish(line_);
    }
    showTip();
    Q_EMIT refused(why);
  }
  void showTip() { line_->setToolTip(why_.isEmpty() ? tip_ : why_.toHtmlEscaped()); }

  FieldInfo info_;
  FieldValue shown_;
  QLineEdit* line_;
  QString why_, tip_;
  bool typed_ = false;  // and not taken over
};

}  // namespace

FieldEditor* makeFieldEditor(const Field& field, QWidget* parent) {
  if (std::holds_alternative<bool>(field.value)) return new BoolEditor(field, parent);
  if (!field.info.choices.empty()) return new ChoiceEditor(field, parent);
  return new TextEditor(field, parent);
}

QString valueText(const FieldValue& value) {
  if (const bool* on = std::get_if<bool>(&value)) return *on ? "on" : "off";
  if (const int* whole = std::get_if<int>(&value)) return numberText(*whole);
  if (const double* number = std::get_if<double>(&value)) return figureText(*number);
  return QString::fromStdString(toText(value));
}

QString shownText(const FieldValue& value) {
  const bool text = std::holds_alternative<std::string>(value) || std::holds_alternative<bool>(value);
  return text ? QString::fromStdString(toText(value)) : valueText(value).remove(',');
}

}  // namespace beam
