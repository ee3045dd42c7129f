// SPDX-License-Identifier: Apache-2.0
// The settings of the chosen stage: preset, what the stage does, and the form generated from its fields.
#pragma once

#include <QWidget>

#include <string>

#include "ui/project_model.h"

class QComboBox;
class QLabel;

namespace beam {

class ParameterForm;

class SettingsPanel final : public QWidget {
  Q_OBJECT

 public:
  explicit SettingsPanel(ProjectModel& model, QWidget* parent = nullptr);
  void setStage(const std::string& stage);
  ParameterForm& form() { return *form_; }

 private:
  void refresh();

  ProjectModel& model_;
  std::string stage_;
  QComboBox* preset_;
  QLabel *title_, *summary_;
  ParameterForm* form_;
};

}  // namespace beam
