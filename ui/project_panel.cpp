// SPDX-License-Identifier: Apache-2.0
#include "ui/project_panel.h"

#include <QApplication>
#include <QFontMetrics>
#include <QGridLayout>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLabel>
#include <QLocale>
#include <QScrollArea>
#include <QSignalBlocker>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "ui/elided_label.h"
#include "ui/evaluation.h"
#include "ui/quiet_combo.h"
#include "ui/theme.h"
#include "ui/words.h"

namespace beam {
namespace {

constexpr int kLeastLetters = 4;
constexpr int kLeastSizeLetters = 5;                // of the size of a camera's pictures, however narrow
constexpr int kName = 0, kSize = 1, kProblems = 2;  // columns of the cameras

QFrame* line() {
  auto* frame = new QFrame;
  frame->setObjectName("line");
  frame->setFixedHeight(1);
  return frame;
}

ElidedLabel* heading(const QString& text) {
  auto* label = new ElidedLabel(text);
  label->setObjectName("heading");
  label->setLeastLetters(kLeastLetters);
  return label;
}

// Letters and digits belong to the views; what a list takes of them is lost to these.
bool isTyping(const QKeyEvent& key) {
  const bool plain = !(key.modifiers() & ~(Qt::ShiftModifier | Qt::KeypadModifier));
  return plain && key.key() != Qt::Key_Space && !key.text().isEmpty() && key.text()[0].isPrint();
}

}  // namespace

ProjectPanel::ProjectPanel(ProjectModel& model, QWidget* parent)
    : QWidget(parent),
      model_(model),
      name_(heading({})),
      scores_title_(heading("Last evaluation")),
      facts_(new QLabel),
      frames_(new QuietCombo),
      scores_(new QGridLayout),
      cameras_(new QTreeWidget) {
  facts_->setObjectName("quiet");
  facts_->setWordWrap(true);
  facts_->setMinimumWidth(1);  // a long name does not make the panel wide
  frames_->setAccessibleName("Frame");
  frames_->setMinimumContentsLength(kLeastLetters);
  cameras_->setHeaderHidden(true);
  cameras_->setColumnCount(3);
  cameras_->setHeaderLabels({"", "", ""});  // numbers, else, which widen the columns
  cameras_->header()->setStretchLastSection(false);
  cameras_->header()->setMinimumSectionSize(4);
  cameras_->header()->setSectionResizeMode(kName, QHeaderView::Stretch);
  cameras_->header()->setSectionResizeMode(kSize, QHeaderView::Fixed);
  cameras_->header()->setSectionResizeMode(kProblems, QHeaderView::ResizeToContents);
  cameras_->setRootIsDecorated(true);
  cameras_->setIndentation(14);
  cameras_->setFocusPolicy(Qt::StrongFocus);
  cameras_->setTextElideMode(Qt::ElideRight);
  cameras_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  cameras_->setExpandsOnDoubleClick(true);
  cameras_->setAccessibleName("Cameras");
  cameras_->installEventFilter(this);
  cameras_->viewport()->installEventFilter(this);
  makeColumn();
  connectAll();
  refresh();
}

void ProjectPanel::makeColumn() {
  auto* frame_row = new QHBoxLayout;
  frame_row->addWidget(new QLabel("Frame"));
  frame_row->addWidget(frames_, 1);
  auto* inside = new QWidget;
  auto* column = new QVBoxLayout(inside);
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
  auto* scroll = new QScrollArea;
  scroll->setWidget(inside);
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setFocusPolicy(Qt::NoFocus);
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(scroll);
  fitRows();
}

void ProjectPanel::connectAll() {
  connect(frames_, QOverload<int>::of(&QComboBox::activated), this,
          [this](int i) { model_.setFrame(FrameIndex{i}); });
  connect(cameras_, &QTreeWidget::itemClicked, this, [this](QTreeWidgetItem* item) {
    if (const std::optional<ViewIndex> view = viewOf(item)) Q_EMIT cameraChosen(*view);
  });
  connect(cameras_, &QTreeWidget::currentItemChanged, this, [this](QTreeWidgetItem* item) {
    // Of a press the click tells.
    if (QApplication::mouseButtons() != Qt::NoButton) return;
    if (const std::optional<ViewIndex> view = viewOf(item)) Q_EMIT cameraChosen(*view);
  });
  connect(cameras_, &QTreeWidget::itemDoubleClicked, this, [this](QTreeWidgetItem* item) {
    if (const std::optional<ViewIndex> view = viewOf(item)) Q_EMIT cameraActivated(*view);
  });
  connect(&model_, &ProjectModel::opened, this, &ProjectPanel::refresh);
  connect(&model_, &ProjectModel::frameChanged, this,
          [this] { frames_->setCurrentIndex(model_.frame().value); });
  connect(&model_, &ProjectModel::valuesChanged, this, &ProjectPanel::refreshFacts);
  connect(&model_, &ProjectModel::settingsChanged, this, &ProjectPanel::refreshFacts);
}

QSize ProjectPanel::minimumSizeHint() const {
  return {std::min(220, 24 * fontMetrics().averageCharWidth()), 8 * fontMetrics().height()};
}

// Some cameras are always to be seen; beyond that the panel scrolls.
void ProjectPanel::fitRows() { cameras_->setMinimumHeight(6 * (fontMetrics().height() + 8)); }

// The sizes take what the names leave; what is cut ends in an ellipsis, and the tooltip has it whole.
void ProjectPanel::fitColumns() {
  const QFontMetrics metrics = cameras_->fontMetrics();
  int name = 0, size = 0;
  for (QTreeWidgetItemIterator it(cameras_); *it; ++it) {
    if (!viewOf(*it)) continue;
    name = std::max(name, metrics.horizontalAdvance((*it)->text(kName)));
    size = std::max(size, metrics.horizontalAdvance((*it)->text(kSize)));
  }
  constexpr int around = 12;  // of a cell, by the style and the sheet
  const int taken = name + around + 2 * cameras_->indentation() + cameras_->columnWidth(kProblems);
  const int least = std::min(size, kLeastSizeLetters * metrics.averageCharWidth()) + around;
  cameras_->header()->resizeSection(kSize,
                                    std::clamp(cameras_->viewport()->width() - taken, least, size + around));
}

void ProjectPanel::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) {
    fitRows();
    fitColumns();
  }
}

bool ProjectPanel::eventFilter(QObject* watched, QEvent* event) {
  if (watched == cameras_->viewport() && event->type() == QEvent::Resize) fitColumns();
  if (watched != cameras_) return QWidget::eventFilter(watched, event);
  if (event->type() != QEvent::KeyPress) return QWidget::eventFilter(watched, event);
  const auto& key = static_cast<const QKeyEvent&>(*event);
  if (key.key() == Qt::Key_Return || key.key() == Qt::Key_Enter) {
    const std::optional<ViewIndex> view = viewOf(cameras_->currentItem());
    if (view) Q_EMIT cameraActivated(*view);
    return view.has_value();
  }
  if (!isTyping(key)) return QWidget::eventFilter(watched, event);
  event->ignore();  // goes on to the widget above
  return true;
}

std::optional<ViewIndex> ProjectPanel::viewOf(const QTreeWidgetItem* item) const {
  const QVariant index = item ? item->data(kName, Qt::UserRole) : QVariant();
  return index.isValid() ? std::optional(ViewIndex{index.toInt()}) : std::nullopt;
}

void ProjectPanel::refresh() {
  frames_->clear();
  if (model_.sequence()) {
    for (FrameIndex f{0}; f.value < model_.frameCount(); ++f.value) frames_->addItem(model_.nameOf(f));
    frames_->setCurrentIndex(model_.frame().value);
  }
  frames_->setEnabled(frames_->count() > 1);
  frames_->setHelp(frames_->count() == 0   ? "Open a capture or a project first"
                   : frames_->count() == 1 ? "The capture has this frame alone"
                                           : "The frame in view");
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
  lines << QString("%1, %2, %3")
               .arg(countText(static_cast<std::int64_t>(capture.views.size()), "camera"),
                    countText(model_.frameCount(), "frame"),
                    capture.masks != MaskKind::None ? "masks" : "no masks");
  if (!isTurn(capture.capture_from_world)) {
    QString placed = QString::fromStdString(toText(project.imported().placement));
    placed[0] = placed[0].toUpper();
    lines << placed;
  }
  if (const FrameValues& values = model_.values(); values.cloud) {
    lines << countText(static_cast<std::int64_t>(values.cloud->size()), "Gaussian") +
                 (values.materials ? " with materials" : ", no materials yet");
    if (values.mesh)
      lines << "mesh of " + countText(static_cast<std::int64_t>(values.mesh->triangles.size()), "triangle");
  }
  if (project.readOnly() && Project::isProject(project.folder()))
    lines << "The project is read-only: look, do not run";
  if (model_.onDisk() && !Project::isProject(project.folder()))
    lines << "The folder of the project is gone from where it was";
  if (!model_.onDisk())
    lines << "Not on disk yet; the first run or Save settings makes " +
                 QString::fromStdString(project.folder().filename().string());
  facts_->setText(lines.join("\n"));
  // A name without a space cannot wrap; the tooltip has all of them whole.
  facts_->setToolTip(lines.join("\n") + "\n" + QString::fromStdString(project.folder().string()));
  name_->setNote(QString::fromStdString(project.folder().string()));
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
    auto* label = new ElidedLabel(text);
    label->setObjectName(role);
    label->setAlignment(side | Qt::AlignVCenter);
    if (column == 0) label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
    label->setLeastLetters(column == 0 ? 4 : 7);
    scores_->addWidget(label, row, column);
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
  auto* hint = new ElidedLabel("None yet");
  hint->setObjectName("quiet");
  hint->setNote(
      model_.isOpen()
          ? "Process > Evaluate scores the held-out photographs;\nagainst ground truth: beam evaluate \"" +
                QString::fromStdString(model_.project().folder().string()) + "\" --ground-truth FOLDER"
          : QString("Open a capture or a project first"));
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
      item->setText(kName, QString::fromStdString(view.name));
      item->setText(kSize, QString("%1 × %2").arg(view.camera.width).arg(view.camera.height));
      item->setForeground(kSize, colors().quiet);
      item->setData(kName, Qt::UserRole, static_cast<int>(i));
    }
    group->setFirstColumnSpanned(true);
    group->setText(kName,
                   QString("%1 (%2)").arg(split == Split::Train ? "Training" : "Test, held out").arg(count));
    group->setHidden(count == 0);
  }
  cameras_->expandAll();
  showProblems();
}

void ProjectPanel::setProblems(std::map<std::string, QStringList> problems) {
  problems_ = std::move(problems);
  showProblems();
}

void ProjectPanel::showProblems() {
  for (QTreeWidgetItemIterator it(cameras_); *it; ++it) {
    if (!viewOf(*it)) continue;
    const auto found = problems_.find((*it)->text(kName).toStdString());
    const QStringList texts = found == problems_.end() ? QStringList() : found->second;
    (*it)->setText(kProblems, texts.isEmpty() ? QString() : QString("▲ %1").arg(texts.size()));
    (*it)->setForeground(kProblems, colors().warning);
    QString tip = (*it)->text(kName) + ", " + (*it)->text(kSize) +
                  "\nClick: choose it · double click or Enter: look through it";
    if (!texts.isEmpty()) tip += "\n\n" + texts.join("\n");
    for (const int column : {kName, kSize, kProblems}) (*it)->setToolTip(column, tip);
  }
  fitColumns();
}

void ProjectPanel::mark(std::optional<ViewIndex> view) {
  const QSignalBlocker quiet(cameras_);  // nobody chose
  cameras_->clearSelection();
  if (!view) return;
  for (QTreeWidgetItemIterator it(cameras_); *it; ++it) {
    if (viewOf(*it) != view) continue;
    cameras_->setCurrentItem(*it);
    cameras_->scrollToItem(*it);
  }
}

}  // namespace beam
