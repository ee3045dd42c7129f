// SPDX-License-Identifier: Apache-2.0
// A list of fields as a form: basic ones on top, advanced ones folded; what differs from the preset is bold
// and can be put back. It shows and reports, the owner keeps the values.
#pragma once

#include <QWidget>

#include <map>
#include <string>
#include <vector>

#include "core/base/fields.h"

class QFormLayout;
class QGridLayout;
class QLabel;
class QToolButton;

namespace beam {

class FieldEditor;

class ParameterForm final : public QWidget {
  Q_OBJECT

 public:
  explicit ParameterForm(QWidget* parent = nullptr);

  // `standard` holds, field by field, what counts when the user says nothing. Keeps the editors when the
  // names are the same as before.
  void setFields(const std::vector<Field>& fields, const std::vector<FieldValue>& standard);
  FieldEditor* editor(const std::string& name) const;
  bool isMarkedChanged(const std::string& name) const;
  bool advancedShown() const;

 Q_SIGNALS:
  void edited(const std::string& name, const beam::FieldValue& value);
  void resetWanted(const std::string& name);

 private:
  struct Row {
    QLabel* label = nullptr;
    FieldEditor* editor = nullptr;
    QToolButton* reset = nullptr;
    QLabel* trouble = nullptr;
    bool changed = false;
  };
  void rebuild(const std::vector<Field>& fields, const std::vector<FieldValue>& standard);
  void addRow(QGridLayout& grid, const Field& field, const FieldValue& standard);
  void update(Row& row, const Field& field, const FieldValue& standard);

  std::map<std::string, Row> rows_;
  std::vector<std::string> names_;
  QWidget* body_ = nullptr;
  QToolButton* fold_ = nullptr;
  QWidget* advanced_ = nullptr;
  bool unfolded_ = false;
};

}  // namespace beam
