// SPDX-License-Identifier: Apache-2.0
// Words in a place of constant height, so that nothing moves when they come and go; what does not fit ends in
// an ellipsis and is told by the tooltip.
#pragma once

#include <QLabel>

namespace beam {

class WrappedNote final : public QLabel {
  Q_OBJECT

 public:
  explicit WrappedNote(int lines, QWidget* parent = nullptr);
  void setWords(const QString& words);
  const QString& words() const { return words_; }
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  QString fitting() const;
  void lay();

  int lines_;
  QString words_;
};

}  // namespace beam
