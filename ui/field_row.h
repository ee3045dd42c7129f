// SPDX-License-Identifier: Apache-2.0
// A row of a form: label, editor, and the button that puts the preset's value back; the label stands beside
// the editor, or above it where the form is narrow.
#pragma once

#include <QWidget>

#include "core/base/fields.h"

class QLabel;
class QToolButton;

namespace beam {

class FieldEditor;

class FieldRow final : public QWidget {
  Q_OBJECT

 public:
  FieldRow(const Field& field, QWidget* parent = nullptr);
  // Shows the value; bold and with a button where it is not the standard one. `why_not`: nothing can be
  // changed, and why.
  void update(const Field& field, const FieldValue& standard, const QString& why_not);
  FieldEditor* editor() const { return editor_; }
  bool isChanged() const { return changed_; }

  // The least width at which the label can stand beside the editor; rows of a form agree on the greatest.
  int besideWidth() const;
  void setStackedBelow(int width);
  bool hasHeightForWidth() const override { return true; }
  int heightForWidth(int width) const override;
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 Q_SIGNALS:
  void resetWanted();

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  struct Places {
    QRect label, editor, reset;
    int height = 0;
  };
  Places placesAt(int width) const;
  void place();
  void showChanged();
  int longestWord() const;

  QLabel* label_;
  FieldEditor* editor_;
  QToolButton* reset_;
  int stacked_below_ = 0;
  bool changed_ = false;
};

}  // namespace beam
