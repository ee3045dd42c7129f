// SPDX-License-Identifier: Apache-2.0
#include "ui/project_panel.h"

#include <QComboBox>
#include <QFontMetrics>
#include <QGridLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLocale>
#include <QSignalBlocker>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "ui/evaluation.h"

namespace beam {
namespace {

QFrame* line() {
  auto* frame = new QFrame;
  frame->setObjectName("line");
  frame->setFixedHeight(1);
  return frame;
}

QLabel* heading(const QString& text) {
  auto* label = new QLabel(text);
  label->setObjectName("heading");
  return label;
}

}  // namespace

ProjectPanel::ProjectPanel(ProjectModel& model, QWidget* parent)
    : QWidget(parent),
      model_(model),
      name_(heading({})),
      facts_(new QLabel),
      scores_title_(heading("Last evaluation")),
      frames_(new QComboBox),
      scores_(new QGridLayout),
      cameras_(new QTreeWidget) {
  setMinimumWidth(260);
  facts_->setObjectName("quiet");
  facts_->setWordWrap(true);
  frames_->setFocusPolicy(Qt::ClickFocus);
  cameras_->setHeaderHidden(true);
  cameras_->setRootIsDecorated(true);
  cameras_->setIndentation(14);
  cameras_->setFocusPolicy(Qt::ClickFocus);
  auto* frame_row = new QHBoxLayout;
  frame_row->addWidget(new QLabel("Frame"));
  frame_row->addWidget(frames_, 1);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(10, 10, 8, 4);
  column->addWidget(name_);
  column->addWidget(facts_);
  column->addLayout(frame_row);
  column->addWidget(line());
  column->addWidget(scores_title_);
  column->addLayout(scores_);
  column->addWidget(line());
  column->addWidget(heading("Cameras"));
  column->addWidget(cameras_, 1);
  connect(frames_, QOverload<int>::of(&QComboBox::activated), this,
          [this](int i) { model_.setFrame(FrameIndex{i}); });
  connect(cameras_, &QTreeWidget::itemClicked, this, [this](QTreeWidgetItem* item) {
    const QVariant index = item->data(0, Qt::UserRole);
    if (index.isValid()) Q_EMIT cameraActivated(ViewIndex{index.toInt()});
  });
  connect(&model_, &ProjectModel::opened, this, &ProjectPanel::refresh);
  connect(&model_, &ProjectModel::frameChanged, this,
          [this] { frames_->setCurrentIndex(model_.frame().value); });
  connect(&model_, &ProjectModel::valuesChanged, this, &ProjectPanel::refreshFacts);
  connect(&model_, &ProjectModel::settingsChanged, this, &ProjectPanel::refreshFacts);
  refresh();
}

void ProjectPanel::refresh() {
  frames_->clear();
  if (model_.capture()) {
    for (const std::string& frame : model_.capture()->frames) frames_->addItem(QString::fromStdString(frame));
    frames_->setCurrentIndex(model_.frame().value);
  }
  frames_->setEnabled(frames_->count() > 1);
  refreshFacts();
  fillCameras();
  refreshScores();
}

void ProjectPanel::refreshFacts() {
  if (!model_.isOpen()) {
    name_->setText("No project");
    facts_->setText("Open a capture or a project to begin.");
    return;
  }
  const Project& project = model_.project();
  const CaptureSet& capture = *model_.capture();
  name_->setText(QString::fromStdString(project.name()));
  QStringList lines;
  lines << QString("Capture %1 (%2)")
               .arg(QString::fromStdString(capture.name), QString::fromStdString(project.imported().layout));
  lines << QString("%1 cameras, %2 frames%3")
               .arg(capture.views.size())
               .arg(capture.frames.size())
               .arg(capture.masks != MaskKind::None ? ", masks" : ", no masks");
  if (const FrameValues& values = model_.values(); values.cloud) {
    lines << QString("%L1 Gaussians%2")
                 .arg(values.cloud->size())
                 .arg(values.materials ? " with materials" : ", no materials yet");
    if (values.mesh) lines << QString("mesh of %L1 triangles").arg(values.mesh->triangles.size());
  }
  if (project.readOnly() && Project::isProject(project.folder()))
    lines << "The project is read-only: look, do not run";
  if (!Project::isProject(project.folder()))
    lines << "Not on disk yet; the first run makes " + QString::fromStdString(project.folder().string());
  facts_->setText(lines.join("\n"));
  facts_->setToolTip(QString::fromStdString(project.folder().string()));
}

void ProjectPanel::refreshScores() {
  while (QLayoutItem* item = scores_->takeAt(0)) {
    delete item->widget();
    delete item;
  }
  const Evaluation evaluation = model_.isOpen() ? readEvaluation(model_.project().folder()) : Evaluation{};
  scores_title_->setText(evaluation.rows.empty()
                             ? QString("Last evaluation")
                             : "Last evaluation, " + QLocale::c().toString(evaluation.when, "d MMM hh:mm"));
  int row = 0;
  const auto put = [&](const QString& text, int column, const char* role, Qt::Alignment side) {
    auto* label = new QLabel(text);
    label->setObjectName(role);
    scores_->addWidget(label, row, column, side);
  };
  if (!evaluation.rows.empty()) {
    put("SSIM", 2, "quiet", Qt::AlignRight);
    ++row;
  }
  for (const ScoreRow& score : evaluation.rows) {
    put(score.what, 0, "quiet", Qt::AlignLeft);
    put(score.first, 1, "", Qt::AlignRight);
    put(score.ssim, 2, "", Qt::AlignRight);
    ++row;
  }
  scores_->setColumnStretch(0, 1);
  scores_->setVerticalSpacing(3);
  scores_->setHorizontalSpacing(10);
  if (row > 0) return;
  auto* hint =
      new QLabel(model_.isOpen() ? "None yet. Score it with:  beam evaluate " +
                                       QString::fromStdString(model_.project().folder().filename().string())
                                 : "None yet.");
  hint->setObjectName("quiet");
  hint->setWordWrap(true);
  scores_->addWidget(hint, 0, 0, 1, 3);
}

void ProjectPanel::fillCameras() {
  cameras_->clear();
  if (!model_.capture()) return;
  const CaptureSet& capture = *model_.capture();
  for (const Split split : {Split::Train, Split::Test}) {
    auto* group = new QTreeWidgetItem(cameras_);
    group->setFlags(Qt::ItemIsEnabled);
    int count = 0;
    for (std::size_t i = 0; i < capture.views.size(); ++i) {
      const View& view = capture.views[i];
      if (view.split != split) continue;
      ++count;
      auto* item = new QTreeWidgetItem(group);
      item->setText(0, QString("%1   %2 × %3")
                           .arg(QString::fromStdString(view.name))
                           .arg(view.camera.width)
                           .arg(view.camera.height));
      item->setData(0, Qt::UserRole, static_cast<int>(i));
      item->setToolTip(0, "Look through this camera");
    }
    group->setText(0,
                   QString("%1 (%2)").arg(split == Split::Train ? "Training" : "Test, held out").arg(count));
    group->setHidden(count == 0);
  }
  cameras_->expandAll();
}

void ProjectPanel::mark(std::optional<ViewIndex> view) {
  cameras_->clearSelection();
  if (!view) return;
  for (QTreeWidgetItemIterator it(cameras_); *it; ++it) {
    const QVariant index = (*it)->data(0, Qt::UserRole);
    if (!index.isValid() || index.toInt() != view->value) continue;
    (*it)->setSelected(true);
    cameras_->scrollToItem(*it);
  }
}

}  // namespace beam
