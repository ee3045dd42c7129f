// SPDX-License-Identifier: Apache-2.0
// A list of fields as a form: basic ones on top, advanced ones folded; what differs from the preset is bold
// and can be put back. It shows and reports, the owner keeps the values. What is typed stays until it is
// taken over.
#pragma once

#include <QWidget>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.h"

class QToolButton;

namespace beam {

class FieldEditor;
class FieldRow;

class ParameterForm final : public QWidget {
  Q_OBJECT

 public:
  explicit ParameterForm(QWidget* parent = nullptr);

  // `standard` holds, field by field, what counts when the user says nothing; `headings`, what a field stands
  // under, where that is anything. Keeps the editors, and what is typed in them, when the names are the same
  // as before.
  void setFields(const std::vector<Field>& fields, const std::vector<FieldValue>& standard,
                 const std::vector<QString>& headings = {});
  // Why nothing can be changed; empty: everything can. Holds from the next setFields() on.
  void setReadOnly(const QString& why) { why_not_ = why; }
  FieldEditor* editor(const std::string& name) const;
  bool isMarkedChanged(const std::string& name) const;
  std::vector<std::string> changedNames() const;
  bool advancedShown() const;

  // Takes everything over that is typed and not taken yet. Answers with why that cannot be, if so: then the
  // field is not in a folded part.
  std::optional<QString> takeOver();
  // Drops everything that is typed and not taken yet.
  void restore();
  // What is wrong with the field that was touched last, and how many more are wrong.
  QString trouble() const;
  // The editor of that field; null: nothing is wrong.
  FieldEditor* troubledEditor() const;

 Q_SIGNALS:
  void edited(const std::string& name, const beam::FieldValue& value);
  void resetWanted(const std::string& name);
  void troubleChanged(const QString& trouble);

 protected:
  void changeEvent(QEvent* event) override;
  void showEvent(QShowEvent* event) override;

 private:
  struct Trouble {
    std::string name;
    QString why;
  };
  void rebuild(const std::vector<Field>& fields, const std::vector<QString>& headings);
  QWidget* makePart(const std::vector<Field>& fields, const std::vector<QString>& headings, bool advanced);
  void addRow(QWidget& part, const Field& field);
  void unfold(bool on);
  void agreeOnStacking();
  void note(const std::string& name, const QString& why);

  std::map<std::string, FieldRow*> rows_;
  std::vector<std::string> names_;
  std::vector<Trouble> troubles_;  // the last touched one last
  QString why_not_;
  QWidget* body_ = nullptr;
  QToolButton* fold_ = nullptr;
  QWidget* advanced_ = nullptr;
  bool unfolded_ = false;
};

}  // namespace beam
