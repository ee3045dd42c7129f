// SPDX-License-Identifier: Apache-2.0
// A combo box that leaves to the window what is not meant for it: letters and digits while it is closed,
// which are keys of the views, and the wheel while it has no focus. It shrinks; a choice that is cut is
// elided and told in the tooltip.
#pragma once

#include <QComboBox>

namespace beam {

class QuietCombo final : public QComboBox {
  Q_OBJECT

 public:
  explicit QuietCombo(QWidget* parent = nullptr);
  // The tooltip, before the choice that is cut.
  void setHelp(const QString& help);

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  QString shownText() const;  // elided
  void tellWhatIsCut();

  QString help_;
};

}  // namespace beam
