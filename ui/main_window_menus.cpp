// SPDX-License-Identifier: Apache-2.0
// Menus and what they start: opening, pictures, layouts, help.
#include <QDockWidget>
#include <QFileDialog>
#include <QMenuBar>
#include <QMessageBox>
#include <QTabBar>

#include "ui/image_page.h"
#include "ui/main_window.h"
#include "ui/message_panel.h"
#include "ui/run_bar.h"
#include "ui/settings_panel.h"
#include "viewers/image/image_view.h"
#include "viewers/scene/scene_view.h"
#include "viewers/splat/splat_view.h"

namespace beam {
namespace {

const char* const kKeys =
    "<h3>Keys of the views</h3><table cellpadding=4>"
    "<tr><td><b>1 … 7</b></td><td>Lit, radiance, base colour, ambient occlusion, roughness, normal, "
    "depth</td></tr>"
    "<tr><td><b>C · M</b></td><td>next channel · back to Lit</td></tr>"
    "<tr><td><b>left · middle · wheel</b></td><td>orbit · pan · zoom</td></tr>"
    "<tr><td><b>F or H</b></td><td>home</td></tr>"
    "<tr><td><b>Shift + right drag</b></td><td>turn the light</td></tr>"
    "<tr><td><b>E · Shift+E · R</b></td><td>exposure up · down half a stop · reset</td></tr>"
    "<tr><td><b>[ · ]</b></td><td>previous · next camera</td></tr>"
    "<tr><td><b>Enter · Esc</b></td><td>look through a camera · leave it; the wheel fades the "
    "photograph</td></tr>"
    "<tr><td><b>W · T · hold Shift</b></td><td>images: wipe · swap sides · B alone</td></tr>"
    "<tr><td><b>K · G · J</b></td><td>scene: cameras · grid · joints</td></tr>"
    "<tr><td><b>Space · ← · →</b></td><td>play or pause · previous · next frame</td></tr>"
    "<tr><td><b>I · O · Home · End · L</b></td><td>in point here · out point here · to them · loop</td></tr>"
    "<tr><td><b>Ctrl+Enter · Ctrl+.</b></td><td>run · cancel</td></tr></table>";

}  // namespace

void MainWindow::makeMenus() {
  const auto add = [this](QMenu* menu, const char* text, const QKeySequence& keys, auto slot) {
    QAction* action = menu->addAction(text);
    action->setShortcut(keys);
    connect(action, &QAction::triggered, this, slot);
    return action;
  };
  QMenu* file = menuBar()->addMenu("&File");
  add(file, "Open capture…", QKeySequence("Ctrl+N"), [this] { openCapture(); });
  add(file, "Open project…", QKeySequence("Ctrl+O"), [this] { openProject(); });
  if (services_.make_sample) add(file, "Open sample", {}, [this] { openSample(); });
  add(file, "Open panorama…", QKeySequence("Ctrl+L"), [this] { openLight(); });
  file->addSeparator();
  add(file, "Save settings", QKeySequence("Ctrl+S"), [this] {
    if (!model_.isOpen()) return;
    if (const auto why = settings_->takeOver()) return say("The settings were not saved", *why);
    model_.save();
  });
  add(file, "Save picture with labels…", QKeySequence("F12"), [this] { savePicture(); });
  file->addSeparator();
  add(file, "Quit", QKeySequence("Ctrl+Q"), [this] { close(); });

  QMenu* process = menuBar()->addMenu("&Process");
  add(process, "Run this frame", QKeySequence("Ctrl+Return"), [this] { run(); });
  add(process, "Run in–out range", QKeySequence("Ctrl+Alt+Return"), [this] { run({}, RunScope::Range); });
  add(process, "Scout in–out range…", QKeySequence("Ctrl+Alt+S"), [this] { scout(); });
  add(process, "Run whole take", QKeySequence("Ctrl+Shift+Return"), [this] { run({}, RunScope::Take); });
  add(process, "Cancel", QKeySequence("Ctrl+."), [this] { cancelRun(); });

  QMenu* view = menuBar()->addMenu("&View");
  add(view, "Splats", QKeySequence("Ctrl+1"), [this] { showView(StudioView::Splat); });
  add(view, "Images", QKeySequence("Ctrl+2"), [this] { showView(StudioView::Image); });
  add(view, "Scene", QKeySequence("Ctrl+3"), [this] { showView(StudioView::Scene); });
  view->addSeparator();
  QMenu* channels = view->addMenu("Channel");
  for (int i = 0; i < kChannelCount; ++i) {
    // The digit is told, not bound: letters and digits belong to the view that has the focus.
    channels->addAction(QString("%1\t%2").arg(infoOf(static_cast<Channel>(i)).title).arg(i + 1), this,
                        [this, i] { splat_->setChannel(static_cast<Channel>(i)); });
  }
  view->addSeparator();
  for (QDockWidget* dock : findChildren<QDockWidget*>()) view->addAction(dock->toggleViewAction());
  add(view, "Reset layout", {}, [this] { restoreState(freshState()); });
  add(view, "Full screen", QKeySequence("F11"), [this] { isFullScreen() ? showNormal() : showFullScreen(); });

  QMenu* help = menuBar()->addMenu("&Help");
  add(help, "Keys", QKeySequence("F1"), [this] { QMessageBox::information(this, "Keys", kKeys); });
  add(help, "About", {}, [this] {
    QMessageBox::about(this, "BEAM Studio",
                       QString("BEAM Studio %1\nPhotographs in, relightable Gaussians out.")
                           .arg(QString::fromStdString(services_.version)));
  });
}

void MainWindow::openCapture() {
  const QString folder = QFileDialog::getExistingDirectory(this, "Open the folder of a capture");
  if (!folder.isEmpty()) open(folder.toStdString());
}

void MainWindow::openProject() {
  const QString folder =
      QFileDialog::getExistingDirectory(this, "Open a project, a folder that ends in .beam");
  if (!folder.isEmpty()) open(folder.toStdString());
}

void MainWindow::openSample() {
  if (!services_.make_sample || sample_.busy() || job_.busy()) return;
  run_bar_->showStarted("Making the sample capture");
  sample_.start(services_);
}

void MainWindow::openLight() {
  const QString file =
      QFileDialog::getOpenFileName(this, "Open a panorama of light", {}, "Panoramas (*.exr *.hdr)");
  if (!file.isEmpty()) open(file.toStdString());
}

void MainWindow::savePicture() {
  const QString file =
      QFileDialog::getSaveFileName(this, "Save the view as a picture", "view.png", "PNG (*.png)");
  if (file.isEmpty()) return;
  QWidget* const widgets[] = {splat_, &images_->view(), scene_};
  if (!widgets[view_tabs_->currentIndex()]->grab().save(file, "PNG")) {
    say("The picture was not saved", file + " cannot be written; choose another folder.");
  }
}

}  // namespace beam
