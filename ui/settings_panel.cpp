// SPDX-License-Identifier: Apache-2.0
#include "ui/settings_panel.h"

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QScrollArea>
#include <QStackedWidget>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>

#include "ui/field_editors.h"
#include "ui/parameter_form.h"
#include "ui/quiet_combo.h"
#include "ui/words.h"
#include "ui/wrapped_note.h"

namespace beam {
namespace {

constexpr int kNoteLines = 3;  // the longest refusal at 260 px

enum Page { kNothing, kStage };

// What a field stands under: the step that it is named after; those of the stage itself under nothing.
QString headingOf(const StageInfo& stage, const std::string& key) {
  const std::string name = key.substr(stage.id.size() + 1);
  const std::size_t dot = name.find('.');
  if (dot == std::string::npos) return {};
  const std::string group = name.substr(0, dot);
  for (const StepInfo& step : stage.steps) {
    if (step.id == group) return QString::fromStdString(step.title);
  }
  return group == "later" ? QString("Later frames of a take") : QString::fromStdString(group);
}

}  // namespace

SettingsPanel::SettingsPanel(ProjectModel& model, QWidget* parent)
    : QWidget(parent),
      model_(model),
      pages_(new QStackedWidget),
      preset_(new QuietCombo),
      title_(new QLabel),
      summary_(new QLabel),
      changed_(new QLabel),
      reset_all_(new QToolButton),
      form_(new ParameterForm),
      note_(new WrappedNote(kNoteLines)) {
  auto* nothing = new QLabel("Open a capture or a project to see its settings.");
  nothing->setObjectName("quiet");
  nothing->setWordWrap(true);
  nothing->setAlignment(Qt::AlignHCenter | Qt::AlignTop);
  nothing->setContentsMargins(10, 24, 10, 10);
  pages_->insertWidget(kNothing, nothing);
  pages_->insertWidget(kStage, makeStagePage());
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(pages_);
  connect(preset_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    const std::string name = preset_->currentText().toStdString();
    form_->takeOver();  // what is typed differs from the new preset, too
    model_.setPreset(name);
  });
  connect(form_, &ParameterForm::edited, &model_, &ProjectModel::set);
  connect(form_, &ParameterForm::resetWanted, &model_, &ProjectModel::reset);
  connect(form_, &ParameterForm::troubleChanged, this, &SettingsPanel::showNote);
  connect(reset_all_, &QToolButton::clicked, this, &SettingsPanel::resetAll);
  connect(&model_, &ProjectModel::opened, this, [this] {
    form_->restore();  // it was typed for another project
    refresh();
  });
  connect(&model_, &ProjectModel::settingsChanged, this, &SettingsPanel::refresh);
}

QWidget* SettingsPanel::makeHead() {
  title_->setObjectName("heading");
  title_->setWordWrap(true);
  summary_->setObjectName("quiet");
  summary_->setWordWrap(true);
  changed_->setObjectName("quiet");
  changed_->setWordWrap(true);
  reset_all_->setObjectName("flat");
  reset_all_->setText("Reset all");
  auto* row = new QHBoxLayout;
  row->addWidget(changed_, 1);
  row->addWidget(reset_all_);
  auto* head = new QWidget;
  auto* column = new QVBoxLayout(head);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(title_);
  column->addWidget(summary_);
  column->addLayout(row);
  return head;
}

QWidget* SettingsPanel::makeStagePage() {
  auto* preset_row = new QHBoxLayout;
  auto* words = new QLabel("Preset");
  words->setBuddy(preset_);
  preset_row->addWidget(words);
  preset_row->addWidget(preset_, 1);
  auto* inside = new QWidget;
  auto* inner = new QVBoxLayout(inside);
  inner->setContentsMargins(0, 4, 6, 4);
  inner->addWidget(makeHead());
  inner->addSpacing(4);
  inner->addWidget(form_);
  inner->addStretch();
  scroll_ = new QScrollArea;
  scroll_->setWidgetResizable(true);
  scroll_->setWidget(inside);
  auto* page = new QWidget;
  auto* column = new QVBoxLayout(page);
  column->setContentsMargins(10, 10, 4, 4);
  column->addLayout(preset_row);
  auto* line = new QFrame;  // here the form scrolls on: a row that is cut lies under no words
  line->setObjectName("line");
  line->setFixedHeight(1);
  column->addWidget(scroll_, 1);
  column->addWidget(line);
  column->addWidget(note_);
  return page;
}

bool SettingsPanel::setStage(const std::string& stage) {
  if (stage != stage_ && takeOver()) return false;
  stage_ = stage;
  refresh();
  return true;
}

void SettingsPanel::setRunning(bool running) {
  running_ = running;
  showNote();
}

std::optional<QString> SettingsPanel::takeOver() {
  if (!model_.isOpen()) return std::nullopt;
  std::optional<QString> why = form_->takeOver();
  if (!why) return why;
  Q_EMIT attentionWanted();
  scroll_->ensureWidgetVisible(form_->troubledEditor());
  form_->troubledEditor()->setFocus(Qt::OtherFocusReason);
  return why;
}

void SettingsPanel::refresh() {
  const bool shown = model_.isOpen() && !stage_.empty();
  pages_->setCurrentIndex(shown ? kStage : kNothing);
  if (!shown) return;
  const Project& project = model_.project();
  // One that is not on disk yet stays in memory: there nothing is in the way.
  const bool locked = Project::isProject(project.folder()) && project.readOnly();
  read_only_ = locked ? "This project is read-only: its settings can be looked at, not changed. Copy it, or "
                        "make its folder writable, to change them."
                      : "";
  refreshPresets();
  const StageInfo& info = project.setup().stages.info(stage_);
  title_->setText(QString::fromStdString(info.title));
  summary_->setText(QString::fromStdString(info.summary));
  refreshForm();
  showNote();
}

void SettingsPanel::refreshPresets() {
  const Project& project = model_.project();
  QStringList names, before;
  for (const std::string& name : project.presetNames()) names << QString::fromStdString(name);
  for (int i = 0; i < preset_->count(); ++i) before << preset_->itemText(i);
  if (names != before) {
    preset_->clear();
    preset_->addItems(names);
  }
  preset_->setCurrentText(QString::fromStdString(project.document().preset));
  preset_->setEnabled(read_only_.isEmpty());
  preset_->setHelp(read_only_.isEmpty() ? "Where all settings start; what you change stays changed"
                                        : read_only_);
}

void SettingsPanel::refreshForm() {
  const Project& project = model_.project();
  const StageInfo& info = project.setup().stages.info(stage_);
  Project plain = project;
  for (const auto& [key, value] : project.document().settings) plain.reset(key);
  const std::vector<Field> all = project.fields(), all_plain = plain.fields();
  std::vector<Field> fields;
  std::vector<FieldValue> standard;
  std::vector<QString> headings;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].info.name.starts_with(stage_ + ".")) continue;
    fields.push_back(all[i]);
    standard.push_back(all_plain[i].value);
    headings.push_back(headingOf(info, all[i].info.name));
  }
  form_->setReadOnly(read_only_);
  form_->setFields(fields, standard, headings);
  const int changed = static_cast<int>(form_->changedNames().size());
  changed_->setText(changed == 0
                        ? QString("All settings are those of the preset")
                        : countText(changed, "setting differs", "settings differ") + " from the preset");
  reset_all_->setEnabled(changed > 0 && read_only_.isEmpty());
  reset_all_->setToolTip(!read_only_.isEmpty() ? read_only_
                         : changed > 0         ? QString("Puts the preset's values back into this stage")
                                               : QString("Nothing differs from the preset in this stage"));
}

void SettingsPanel::resetAll() {
  form_->restore();
  for (const std::string& name : form_->changedNames()) model_.reset(name);
}

void SettingsPanel::keyPressEvent(QKeyEvent* event) {
  if (event->key() != Qt::Key_Return && event->key() != Qt::Key_Enter) return QWidget::keyPressEvent(event);
  event->accept();
}

QString SettingsPanel::note() const { return note_->words(); }

void SettingsPanel::showNote() {
  const QString trouble = form_->trouble();
  const QString kind = trouble.isEmpty() ? "quiet" : "trouble";
  if (note_->objectName() != kind) {
    note_->setObjectName(kind);
    note_->style()->unpolish(note_);
    note_->style()->polish(note_);
  }
  note_->setWords(!trouble.isEmpty()      ? trouble
                  : !read_only_.isEmpty() ? read_only_
                  : running_              ? QString("A run is going on: changes are for the next run.")
                                          : QString());
}

}  // namespace beam
