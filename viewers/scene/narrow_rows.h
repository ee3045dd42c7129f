// SPDX-License-Identifier: Apache-2.0
// Rows that fit any width: one whose widgets go on in the next line, and one line of words that is cut with
// an ellipsis and tells all of them in its tooltip.
#pragma once

#include <QLabel>
#include <QLayout>

#include <vector>

namespace beam {

class WrappingRow final : public QLayout {
 public:
  explicit WrappingRow(int spacing_px);
  ~WrappingRow() override;

  void addItem(QLayoutItem* item) override;
  int count() const override { return static_cast<int>(items_.size()); }
  QLayoutItem* itemAt(int index) const override;
  QLayoutItem* takeAt(int index) override;
  QSize sizeHint() const override;  // all in one line
  QSize minimumSize() const override;
  bool hasHeightForWidth() const override { return true; }
  int heightForWidth(int width_px) const override { return arrange(QRect(0, 0, width_px, 0), false); }
  void setGeometry(const QRect& area) override;
  Qt::Orientations expandingDirections() const override { return {}; }

 private:
  int arrange(const QRect& area, bool place) const;  // the height that it takes

  std::vector<QLayoutItem*> items_;  // owned, as every layout owns its items
};

class ElidedLine final : public QLabel {
 public:
  explicit ElidedLine(QWidget* parent = nullptr);
  void setWords(const QString& words);
  const QString& words() const { return words_; }

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void fit();

  QString words_;
};

}  // namespace beam
