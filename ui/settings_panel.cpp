// SPDX-License-Identifier: Apache-2.0
#include "ui/settings_panel.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QScrollArea>
#include <QVBoxLayout>

#include "ui/parameter_form.h"

namespace beam {

SettingsPanel::SettingsPanel(ProjectModel& model, QWidget* parent)
    : QWidget(parent),
      model_(model),
      preset_(new QComboBox),
      title_(new QLabel),
      summary_(new QLabel),
      form_(new ParameterForm) {
  title_->setObjectName("heading");
  summary_->setObjectName("quiet");
  summary_->setWordWrap(true);
  preset_->setToolTip("Where all settings start; what you change stays changed");
  auto* row = new QHBoxLayout;
  row->addWidget(new QLabel("Preset"));
  row->addWidget(preset_, 1);
  auto* inside = new QWidget;
  auto* inner = new QVBoxLayout(inside);
  inner->addWidget(title_);
  inner->addWidget(summary_);
  inner->addSpacing(4);
  inner->addWidget(form_);
  inner->addStretch();
  auto* scroll = new QScrollArea;
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setWidget(inside);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(10, 10, 4, 4);
  column->addLayout(row);
  column->addWidget(scroll, 1);
  connect(preset_, QOverload<int>::of(&QComboBox::activated), this,
          [this] { model_.setPreset(preset_->currentText().toStdString()); });
  connect(form_, &ParameterForm::edited, &model_, &ProjectModel::set);
  connect(form_, &ParameterForm::resetWanted, &model_, &ProjectModel::reset);
  connect(&model_, &ProjectModel::opened, this, &SettingsPanel::refresh);
  connect(&model_, &ProjectModel::settingsChanged, this, &SettingsPanel::refresh);
}

void SettingsPanel::setStage(const std::string& stage) {
  stage_ = stage;
  refresh();
}

void SettingsPanel::refresh() {
  setEnabled(model_.isOpen());
  if (!model_.isOpen() || stage_.empty()) return;
  const Project& project = model_.project();
  preset_->clear();
  for (const std::string& name : project.presetNames()) preset_->addItem(QString::fromStdString(name));
  preset_->setCurrentText(QString::fromStdString(project.document().preset));
  const StageInfo& info = project.setup().stages.info(stage_);
  title_->setText(QString::fromStdString(info.title));
  summary_->setText(QString::fromStdString(info.summary));
  Project plain = project;
  for (const auto& [key, value] : project.document().settings) plain.reset(key);
  const std::vector<Field> all = project.fields(), all_plain = plain.fields();
  std::vector<Field> fields;
  std::vector<FieldValue> standard;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].info.name.starts_with(stage_ + ".")) continue;
    fields.push_back(all[i]);
    standard.push_back(all_plain[i].value);
  }
  form_->setFields(fields, standard);
}

}  // namespace beam
