// SPDX-License-Identifier: Apache-2.0
// One editor a field kind: check box, choice, number, text. A value out of range is marked, explained and not
// handed on.
#pragma once

#include <QWidget>

#include "core/base/fields.h"

namespace beam {

class FieldEditor : public QWidget {
  Q_OBJECT

 public:
  using QWidget::QWidget;
  virtual void show(const FieldValue& value) = 0;  // emits nothing

 Q_SIGNALS:
  void edited(const beam::FieldValue& value);
  void refused(const QString& why);  // empty: the trouble is over
};

FieldEditor* makeFieldEditor(const Field& field, QWidget* parent = nullptr);

// "0 to 1", "at least 1", "" without limits.
QString rangeText(const FieldInfo& info);
QString valueText(const FieldValue& value);

}  // namespace beam
