// SPDX-License-Identifier: Apache-2.0
// The settings of the chosen stage: preset, what the stage does, and the form generated from its fields.
#pragma once

#include <QWidget>

#include <optional>
#include <string>

#include "ui/project_model.h"

class QLabel;
class QScrollArea;
class QStackedWidget;
class QToolButton;

namespace beam {

class ParameterForm;
class QuietCombo;
class WrappedNote;

class SettingsPanel final : public QWidget {
  Q_OBJECT

 public:
  explicit SettingsPanel(ProjectModel& model, QWidget* parent = nullptr);
  // False: a value is typed that cannot be taken; the panel stays at its stage and says why.
  bool setStage(const std::string& stage);
  const std::string& stage() const { return stage_; }
  // Changes are for the next run, then.
  void setRunning(bool running);
  // Takes every typed value over, as if its field had been left. Answers with why one cannot be taken, if so:
  // `Iterations expects a whole number from 10 to 1,000,000, found "abc"`. To be asked before anything that
  // counts on the settings: a run, saving, closing.
  std::optional<QString> takeOver();
  // What is wrong, else why nothing can be changed, else what becomes of changes.
  QString note() const;
  ParameterForm& form() { return *form_; }

 Q_SIGNALS:
  void attentionWanted();  // what is wrong is to be seen

 protected:
  // Return stays here, whatever has the focus: in the window it would look through a camera.
  void keyPressEvent(QKeyEvent* event) override;

 private:
  QWidget* makeHead();
  QWidget* makeStagePage();
  void refresh();
  void refreshPresets();
  void refreshForm();
  void resetAll();
  void showNote();

  ProjectModel& model_;
  std::string stage_;
  QString read_only_;  // why; empty: it is not
  bool running_ = false;
  QStackedWidget* pages_;
  QuietCombo* preset_;
  QLabel *title_, *summary_, *changed_;
  QToolButton* reset_all_;
  QScrollArea* scroll_ = nullptr;
  ParameterForm* form_;
  WrappedNote* note_;
};

}  // namespace beam
