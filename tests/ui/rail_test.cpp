// SPDX-License-Identifier: Apache-2.0
// The stages and the run bar as a person meets them: what they say of a take, what a press and a key do, and
// that they fit beside each other.
#include <gtest/gtest.h>

#include <QApplication>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QMenu>
#include <QMouseEvent>
#include <QToolButton>

#include "tests/support/wait_for.h"
#include "ui/command_table.h"
#include "ui/elided_label.h"
#include "ui/run_bar.h"
#include "ui/stage_rail.h"
#include "ui/theme.h"

namespace beam {
namespace {

using testing::waitFor;

const std::vector<StageInfo>& stages() {
  static const std::vector<StageInfo> kStages = [] {
    std::vector<StageInfo> all;
    for (const char* title : {"Capture", "Light", "Track", "Surface", "Materials", "Relight", "Deliver"}) {
      StageInfo info;
      info.title = title;
      info.id = QString(title).toLower().toStdString();
      info.summary = "What it does.";
      info.steps = {{.id = "fit", .title = "Fit appearance"}};
      all.push_back(info);
    }
    return all;
  }();
  return kStages;
}

StageStatus statusOf(std::vector<CellState> cells, int shown = 0) {
  TakeSurvey survey;
  for (std::size_t f = 0; f < cells.size(); ++f) survey.frames.push_back(std::to_string(f));
  std::vector<std::string> notes(cells.size());
  survey.lanes = {{"capture", "Capture", "", std::move(cells), notes}};
  return stageStatus(survey, stages(), FrameIndex{shown}).front();
}

QString wordsOfTake(std::vector<CellState> cells) { return stageWords(statusOf(std::move(cells))); }

using enum CellState;

TEST(StageStatus, CountsTheWholeTakeWhateverFrameIsShown) {
  for (int shown = 0; shown < 3; ++shown) {
    const StageStatus status = statusOf({Done, Stale, Stale}, shown);
    EXPECT_EQ(markOf(status), StageMark::Stale);
    EXPECT_EQ(stageWords(status).toStdString(), "2 stale of 3");
    EXPECT_EQ(status.done + status.stale_frames + status.failed + status.running + status.interpolated +
                  status.blocked + status.to_do,
              status.frames);
  }
  EXPECT_EQ(statusOf({Done, Stale, Stale}, 0).state, StepState::Done);
  EXPECT_TRUE(statusOf({Done, Stale, Stale}, 1).stale);
}

TEST(StageStatus, SaysInWordsHowTheTakeStands) {
  EXPECT_EQ(wordsOfTake({Done, Done, Done}).toStdString(), "done");
  EXPECT_EQ(wordsOfTake({Done, Done, Empty}).toStdString(), "2 of 3 done");
  EXPECT_EQ(wordsOfTake({Failed, Done, Done}).toStdString(), "1 failed, 2 done");
  EXPECT_EQ(wordsOfTake({Failed, Empty, Empty}).toStdString(), "1 failed of 3");
  EXPECT_EQ(wordsOfTake({Failed}).toStdString(), "failed");
  EXPECT_EQ(wordsOfTake({Empty, Empty}).toStdString(), "to do");
  EXPECT_EQ(wordsOfTake({Stale}).toStdString(), "stale");
  EXPECT_EQ(wordsOfTake({Stale, Stale}).toStdString(), "all stale");
  EXPECT_EQ(wordsOfTake({Running, Done}).toStdString(), "running elsewhere");
  EXPECT_EQ(wordsOfTake({Blocked, Blocked}).toStdString(), "needs a panorama");
  EXPECT_EQ(wordsOfTake({Done, Interpolated, Done}).toStdString(), "2 of 3 done");
}

TEST(StageStatus, AStageThatSomeFramesDoNotNeedSpeaksOfTheOthers) {
  // Frame 0 was solved alone again; 1 and 2 are a take. Going from frame to frame changes no word.
  for (int shown = 0; shown < 3; ++shown)
    EXPECT_EQ(stageWords(statusOf({NotNeeded, Done, Done}, shown)).toStdString(), "done");
  for (int shown = 0; shown < 2; ++shown)
    EXPECT_EQ(stageWords(statusOf({NotNeeded, NotNeeded}, shown)).toStdString(), "not needed");
}

TEST(StageStatus, WhatAsksForAttentionIsTheSign) {
  EXPECT_EQ(markOf(statusOf({Done, Failed, Stale, Running})), StageMark::Failed);
  EXPECT_EQ(markOf(statusOf({Done, Stale, Running})), StageMark::Running);
  EXPECT_EQ(markOf(statusOf({Done, Empty})), StageMark::Partly);
  EXPECT_EQ(markOf(statusOf({Empty, Empty})), StageMark::Nothing);
  EXPECT_EQ(markOf(stagesWithoutTake(stages()).front()), StageMark::Closed);
  EXPECT_TRUE(stageWords(stagesWithoutTake(stages()).front()).isEmpty())
      << "nothing is open: nothing is to do";
}

TEST(StageStatus, TheTooltipTellsCountsAndTheShownFrame) {
  const QString tip = stageTip(statusOf({Done, Stale, Failed}, 1));
  for (const char* part : {"Capture", "What it does.", "Of 3 frames", "1 done", "1 failed", "1 stale",
                           "Frame 1, in view: stale"})
    EXPECT_TRUE(tip.contains(part)) << part << " in " << tip.toStdString();
}

class Rail : public ::testing::Test {
 protected:
  Rail() {
    rail.setStages(stagesWithoutTake(stages()));
    rail.select("surface");
    rail.resize(900, rail.sizeHint().height());
    QObject::connect(&rail, &StageRail::chosen, &rail, [this](const std::string& s) { chosen.push_back(s); });
  }
  void press(const std::string& stage) {
    QMouseEvent event(QEvent::MouseButtonPress, QPointF(rail.cellOf(stage).center()), Qt::LeftButton,
                      Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&rail, &event);
  }
  bool key(int code) {
    QKeyEvent event(QEvent::KeyPress, code, Qt::NoModifier);
    QApplication::sendEvent(&rail, &event);
    return event.isAccepted();
  }

  StageRail rail;
  std::vector<std::string> chosen;
};

TEST_F(Rail, EveryPressChoosesAlsoOnTheStageThatIsSelectedAlready) {
  press("surface");
  press("surface");
  press("light");
  EXPECT_EQ(chosen, (std::vector<std::string>{"surface", "surface", "light"}));
  EXPECT_EQ(rail.selected(), "light");
}

TEST_F(Rail, IsWalkedByKeys) {
  EXPECT_TRUE(rail.focusPolicy() & Qt::TabFocus);
  key(Qt::Key_Left);
  EXPECT_EQ(rail.selected(), "surface") << "moving is not choosing";
  EXPECT_TRUE(rail.accessibleDescription().contains("Track"));
  key(Qt::Key_Return);
  key(Qt::Key_Right);
  key(Qt::Key_Right);
  key(Qt::Key_Space);
  EXPECT_EQ(chosen, (std::vector<std::string>{"track", "materials"}));
  EXPECT_FALSE(key(Qt::Key_7)) << "digits belong to the view";
}

TEST_F(Rail, TheFocusIsSeen) {
  QWidget window;
  auto* row = new QHBoxLayout(&window);
  auto* other = new QToolButton;
  row->addWidget(&rail);
  row->addWidget(other);
  window.resize(1000, 80);
  window.show();
  window.activateWindow();
  ASSERT_TRUE(waitFor([&] { return window.isActiveWindow(); }));
  other->setFocus();
  QApplication::processEvents();
  const QImage without = rail.grab().toImage();
  rail.setFocus();
  QApplication::processEvents();
  EXPECT_TRUE(rail.hasFocus());
  EXPECT_NE(rail.grab().toImage(), without);
  rail.setParent(nullptr);
}

TEST_F(Rail, EveryStateHasAShapeOfItsOwn) {
  rail.resize(100, rail.sizeHint().height());
  std::vector<QImage> pictures;
  for (const std::vector<CellState>& cells : {std::vector{Empty, Empty},
                                              {Done, Empty},
                                              {Done, Done},
                                              {Stale, Done},
                                              {Failed, Done},
                                              {Running, Done},
                                              {Blocked, Blocked},
                                              {NotNeeded, NotNeeded}}) {
    rail.setStages({statusOf(cells)});
    const QRect box = rail.cellOf("capture");
    pictures.push_back(rail.grab(QRect(box.left(), 0, rail.height() / 2, rail.height()))
                           .toImage()
                           .convertToFormat(QImage::Format_Mono, Qt::ThresholdDither | Qt::AvoidDither));
  }
  for (std::size_t a = 0; a < pictures.size(); ++a) {
    for (std::size_t b = a + 1; b < pictures.size(); ++b)
      EXPECT_NE(pictures[a], pictures[b]) << a << " " << b;
  }
}

TEST_F(Rail, ShowsProblemsOfAStageAndTellsOfThemInItsTooltip) {
  const QImage before = rail.grab().toImage();
  rail.setWarnings({{"track", 2}});
  EXPECT_NE(rail.grab().toImage(), before);
  EXPECT_TRUE(rail.tipOf("track").contains("2 problems"));
  EXPECT_FALSE(rail.tipOf("light").contains("problem"));
}

TEST_F(Rail, TheStageAtWorkSaysHowFarItIs) {
  rail.setRunning("track", 0.425);
  EXPECT_EQ(rail.wordsOf("track").toStdString(), "running, 42 %");
  rail.setRunning({}, 0);
  EXPECT_TRUE(rail.wordsOf("track").isEmpty());
}

struct Bar {
  explicit Bar(double scale) {
    applyTheme(application(), Theme::Dark, scale);
    auto* row = new QHBoxLayout(&window);
    row->setContentsMargins(10, 4, 10, 4);
    row->setSpacing(14);
    row->addWidget(rail);
    row->addWidget(run, 1);
    rail->setStages(stagesWithoutTake(stages()));
    run->setStages(stages());
  }
  ~Bar() { application().setStyleSheet({}); }
  static QApplication& application() { return *static_cast<QApplication*>(QCoreApplication::instance()); }
  void resize(int width) {
    window.resize(width, 100);
    window.show();
    QApplication::processEvents();
    window.layout()->activate();
  }

  QWidget window;
  StageRail* rail = new StageRail;
  RunBar* run = new RunBar;
};

TEST(Bar, RailAndRunBarFitBesideEachOtherAndNothingOverlaps) {
  for (const double scale : {1.0, 1.5}) {
    for (const int width : {1000, 1024, 1280, 1600, 3840}) {
      Bar bar(scale);
      bar.run->setPlan("1 frame, 5 steps missing, about 2 to 3 min on this machine");
      bar.resize(width);
      EXPECT_EQ(bar.window.width(), width) << "it asks for more at " << scale;
      EXPECT_LE(bar.window.minimumSizeHint().width(), 1000);
      EXPECT_LE(bar.window.sizeHint().height(), 78);
      EXPECT_FALSE(bar.rail->geometry().intersects(bar.run->geometry()));
      EXPECT_LE(bar.run->geometry().right(), width);
      int right = 0;
      for (const StageInfo& info : stages()) {
        const QRect cell = bar.rail->cellOf(info.id);
        EXPECT_GE(cell.left(), right);
        EXPECT_GE(cell.width(), 36 * scale);
        right = cell.right();
      }
      EXPECT_LE(right, bar.rail->width());
      for (const QToolButton* button : bar.run->findChildren<QToolButton*>())
        EXPECT_GE(button->width(), button->sizeHint().width()) << "Run and Cancel are whole";
    }
  }
}

TEST(Bar, WordsThatDoNotFitAreInTheTooltip) {
  Bar bar(1.5);
  bar.resize(1000);
  const QString outcome = "Done in 3 min 12 s: 27 steps computed, 2 were there already, and some more words";
  bar.run->showFinished(outcome);
  QApplication::processEvents();
  EXPECT_EQ(bar.run->text(), outcome);
  bool told = false;
  for (const ElidedLabel* label : bar.run->findChildren<ElidedLabel*>()) {
    if (label->text() != outcome) continue;
    EXPECT_TRUE(label->shownText().endsWith(QChar(0x2026))) << label->shownText().toStdString();
    told = label->toolTip() == outcome;
  }
  EXPECT_TRUE(told);
}

QToolButton* buttonOf(RunBar& run, const QString& text) {
  for (QToolButton* button : run.findChildren<QToolButton*>()) {
    if (button->text() == text) return button;
  }
  return nullptr;
}

// Commands as the window has them.
struct BoundBar {
  BoundBar() {
    const auto add = [this](const QString& id) {
      return commands.add(id, {.text = id,
                               .tip = "What " + id + " does",
                               .act = [this, id] { asked << id; },
                               .refusal = [this, id] { return refusals[id]; }});
    };
    QAction* run = add("run");
    QAction* take = add("take");
    QAction* until = add("until");
    QAction* stop = add("stop");
    QAction* step = add("step");
    QAction* frame = add("frame");
    bar.bind({run, take}, {until}, stop, {step, frame});
    commands.refresh();
  }
  std::map<QString, QString> refusals;
  QStringList asked;
  CommandTable commands;
  RunBar bar;
};

TEST(RunBar, SaysOnItsButtonsWhatTheCommandsSay) {
  BoundBar b;
  QToolButton* button = buttonOf(b.bar, "Run");
  EXPECT_TRUE(button->isEnabled());
  b.refusals["run"] = "The capture is not there";
  b.commands.refresh();
  EXPECT_FALSE(button->isEnabled());
  EXPECT_TRUE(button->toolTip().contains("The capture is not there"));
  b.refusals.clear();
  b.commands.setNote("run", "3 frames, about 2 min");
  b.commands.refresh();
  EXPECT_TRUE(button->isEnabled());
  EXPECT_TRUE(button->toolTip().contains("3 frames, about 2 min"));
  b.bar.setPlan("3 frames, about 2 min");
  EXPECT_EQ(b.bar.text().toStdString(), "3 frames, about 2 min");
}

TEST(RunBar, RunsAndStopsByTheCommandsBehindItsButtons) {
  BoundBar b;
  buttonOf(b.bar, "Run")->click();
  QToolButton* cancel = buttonOf(b.bar, "Cancel");
  ASSERT_EQ(cancel->menu()->actions().size(), 2);
  for (QAction* action : cancel->menu()->actions()) action->trigger();
  b.bar.showStarted("Starting");
  b.bar.showStopping("after this step");
  EXPECT_TRUE(b.bar.text().contains("after this step"));
  StepProgress progress;
  progress.ref = {StepId("surface.fit"), FrameIndex{0}, "000000"};
  b.bar.showProgress(progress);
  EXPECT_TRUE(b.bar.text().contains("after this step")) << "progress does not hide that it stops";
  cancel->click();
  EXPECT_EQ(b.asked, (QStringList{"run", "step", "frame", "stop"}));
  b.bar.showFinished("Cancelled");
  EXPECT_EQ(b.bar.text().toStdString(), "Cancelled");
}

TEST(RunBar, NamesStepsByTheirTitlesAndGroupsThousands) {
  RunBar run;
  run.setStages(stages());
  run.showStarted("Starting");
  StepProgress progress;
  progress.ref = {StepId("surface.fit"), FrameIndex{0}, "000000"};
  progress.report = {0.5, "", 1234, 5000};
  progress.job_fraction = 0.5;
  progress.seconds_elapsed = 100;
  progress.seconds_left = 200;
  run.showProgress(progress);
  const QString text = run.text();
  for (const char* part : {"Surface: fit appearance, frame 000000", "1,234 of 5,000", "min left"})
    EXPECT_TRUE(text.contains(part)) << part << " in " << text.toStdString();
  EXPECT_FALSE(text.contains("surface.fit"));
  progress.rate = 5.5;
  run.showProgress(progress);
  EXPECT_TRUE(run.text().endsWith("1,234 of 5,000 · 5.5/s")) << run.text().toStdString();
  progress.report.unit = "iterations";
  run.showProgress(progress);
  EXPECT_TRUE(run.text().endsWith("5.5 iterations a second")) << run.text().toStdString();
  EXPECT_GE(run.remaining().high_s(), progress.countedLeft());
  run.showWaiting("waits for frame 000000, which process 1234 computes");
  EXPECT_TRUE(run.text().contains("process 1234"));
}

TEST(Words, CountAndGroupInOneWay) {
  EXPECT_EQ(numberText(999).toStdString(), "999");
  EXPECT_EQ(numberText(1000).toStdString(), "1,000");
  EXPECT_EQ(numberText(-1234567).toStdString(), "-1,234,567");
  EXPECT_EQ(numberText(-123).toStdString(), "-123");
  EXPECT_EQ(countText(1, "frame").toStdString(), "1 frame");
  EXPECT_EQ(countText(0, "frame").toStdString(), "0 frames");
  EXPECT_EQ(countText(1200, "entry", "entries").toStdString(), "1,200 entries");
}

TEST(Words, CurvesHaveTitlesAndUnits) {
  const auto title = [](const char* curve) { return curveTitle(stages(), curve).toStdString(); };
  EXPECT_EQ(title("surface.fit.seconds"), "Surface, fit appearance: time (s)");
  EXPECT_EQ(title("track.fit.motion_p95_m"), "Track, fit appearance: motion, 95th percentile (m)");
  EXPECT_EQ(title("surface.fit.gaussians"), "Surface, fit appearance: Gaussians");
  EXPECT_EQ(title("surface.fit.e_smooth"), "Surface, fit appearance: E_smooth (m²)");
  EXPECT_EQ(title("surface.fit.flicker_base_color"),
            "Surface, fit appearance: flicker of base colour (0 to 1)");
  EXPECT_EQ(title("surface.fit.some_color_m2"), "Surface, fit appearance: some colour (m²)");
  EXPECT_EQ(title("nobody.knows.this"), "nobody.knows.this");
}

TEST(Words, ACurveDoesNotNameItsStageTwice) {
  StageInfo track;
  track.id = "track";
  track.title = "Track";
  track.steps = {{.id = "joints", .title = "Track joints"}};
  EXPECT_EQ(curveTitle({track}, "track.joints.joints").toStdString(), "Track joints: number of joints");
}

TEST(Words, StepsOfASentenceHaveTheirTitles) {
  const auto told = [](const char* text) { return withStepTitles(stages(), text).toStdString(); };
  EXPECT_EQ(told("surface.fit, frame 000001 done in 2.0 s"),
            "Surface: fit appearance, frame 000001 done in 2.0 s");
  EXPECT_EQ(told("the result of surface.fit."), "the result of Surface: fit appearance.");
  for (const char* other :
       {"raise surface.fit.weight", "/a/surface.fit/b", "my.surface.fit", "surface.fitting"})
    EXPECT_EQ(told(other), other);
}

TEST(Words, FiguresHaveSixDigitsAndGroupedThousands) {
  EXPECT_EQ(figureText(5.0 / 12).toStdString(), "0.416667");
  EXPECT_EQ(figureText(20000).toStdString(), "20,000");
  EXPECT_EQ(figureText(-12345.678).toStdString(), "-12,345.7");
  EXPECT_EQ(figureText(123456).toStdString(), "123,456");
  EXPECT_EQ(figureText(0.00005).toStdString(), "0.00005");
  EXPECT_EQ(figureText(-0.0).toStdString(), "0");
}

TEST(RunBarWords, ATaskSaysAllTheTimeWhatIsMade) {
  RunBar run;
  run.showStarted("Making the sample");
  run.showReport({0.01, "", 0, 0});
  EXPECT_EQ(run.text().toStdString(), "Making the sample");
  run.showReport({0.1, "photographs", 0, 0});
  EXPECT_EQ(run.text().toStdString(), "Making the sample: photographs");
}

}  // namespace
}  // namespace beam
