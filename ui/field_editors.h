// SPDX-License-Identifier: Apache-2.0
// One editor a field kind: check box, choice, number, text. What is typed stays until it is taken over; what
// the field does not take is marked, explained and not handed on.
#pragma once

#include <QWidget>

#include "core/base/fields.h"

namespace beam {

class FieldEditor : public QWidget {
  Q_OBJECT

 public:
  using QWidget::QWidget;
  // The value in force. Emits no edited(); what is typed and not taken over yet stays.
  virtual void show(const FieldValue& value) = 0;
  // As if the field had been left. Answers with why what is typed cannot be taken, in the words of refused();
  // empty: nothing is left to take.
  virtual QString takeOver() { return {}; }
  // Drops what is typed.
  virtual void restore() {}
  virtual void setReadOnly(bool read_only) = 0;
  virtual void setTip(const QString& tip) = 0;
  // A check box: it has no use for width.
  virtual bool isSmall() const { return false; }

 Q_SIGNALS:
  void edited(const beam::FieldValue& value);
  void refused(const QString& why);  // empty: the trouble is over
};

FieldEditor* makeFieldEditor(const Field& field, QWidget* parent = nullptr);

// In a sentence: "on", "20,000", "0.416667".
QString valueText(const FieldValue& value);
// As a field shows it, to be typed over: the same without commas.
QString shownText(const FieldValue& value);

}  // namespace beam
