// SPDX-License-Identifier: Apache-2.0
// A line of words that gives way: what does not fit ends in three dots, and the tooltip then holds all of it.
#pragma once

#include <QLabel>

namespace beam {

class ElidedLabel final : public QLabel {
  Q_OBJECT

 public:
  explicit ElidedLabel(const QString& text = {}, QWidget* parent = nullptr);

  // The whole text, whatever fits; text() of the base is never set.
  void setText(const QString& text);
  QString text() const { return whole_; }
  // Said under the whole text, or alone where that fits.
  void setNote(const QString& note);
  void setElideMode(Qt::TextElideMode mode);
  // Room for so many letters is always kept.
  void setLeastLetters(int letters);
  QString shownText() const;
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void showTip();

  QString whole_, note_;
  Qt::TextElideMode mode_ = Qt::ElideRight;
  int letters_ = 0;
};

}  // namespace beam
