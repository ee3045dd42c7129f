// SPDX-License-Identifier: Apache-2.0
// Forms under real keys, and the settings of the built-in stages in them: what is typed is never lost, what
// is wrong is said, nothing moves, and everything fits.
#include <gtest/gtest.h>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QScrollArea>
#include <QScrollBar>
#include <QTest>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWheelEvent>

#include <algorithm>
#include <set>

#include "core/base/field_text.h"
#include "core/stages/builtin_stages.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/temp_dir.h"
#include "tests/support/wait_for.h"
#include "ui/field_editors.h"
#include "ui/field_row.h"
#include "ui/parameter_form.h"
#include "ui/scout_dialog.h"
#include "ui/settings_panel.h"

namespace beam {
namespace {

namespace fs = std::filesystem;
using testing::TempDir;
using testing::waitFor;

struct DemoOptions {
  int iterations = 100;
  double rate = 1.6e-4;
  bool careful = true;
  std::string solver = "linear";
  double exact = 0.1234567890123;
};
void describe(Fields& f, DemoOptions& o) {
  f.field({.name = "iterations", .label = "Iterations", .help = "Steps.", .min = 1, .max = 100000},
          o.iterations);
  f.field({.name = "rate", .label = "Rate", .help = "Learning rate.", .min = 0, .max = 1, .advanced = true},
          o.rate);
  f.field({.name = "careful", .label = "Careful", .help = "Look twice."}, o.careful);
  f.field({.name = "solver", .label = "Solver", .help = "How.", .choices = {"linear", "adam"}}, o.solver);
  f.field({.name = "exact", .label = "Exact", .help = "Many digits.", .min = 0}, o.exact);
}

std::vector<FieldValue> valuesOf(const std::vector<Field>& fields) {
  std::vector<FieldValue> values;
  for (const Field& field : fields) values.push_back(field.value);
  return values;
}

// A window around a form that counts the keys that nothing in it took.
class Host final : public QWidget {
 public:
  explicit Host(QWidget* inside) {
    (new QVBoxLayout(this))->addWidget(inside);
    resize(340, 500);
    show();
    QApplication::setActiveWindow(this);
  }
  std::vector<int> keys;

 protected:
  void keyPressEvent(QKeyEvent* event) override { keys.push_back(event->key()); }
};

class Form : public ::testing::Test {
 protected:
  Form() : form(*new ParameterForm), host(&form) {
    refresh();
    QObject::connect(&form, &ParameterForm::edited, &form,
                     [this](const std::string& name, const FieldValue& value) {
                       FieldSetter setter(name, value);
                       describe(setter, options);
                       ++edits;
                       refresh();
                     });
    QApplication::processEvents();  // a layout shows its widgets later
  }
  // As after every change of the project.
  void refresh() { form.setFields(fieldsOf(options), valuesOf(fieldsOf(DemoOptions{}))); }
  QLineEdit& line(const std::string& name) { return *form.editor(name)->findChild<QLineEdit*>(); }
  QLineEdit& type(const std::string& name, const QString& text) {
    QLineEdit& field = line(name);
    field.setFocus();
    field.selectAll();
    QTest::keyClicks(&field, text);
    return field;
  }

  DemoOptions options;
  int edits = 0;
  ParameterForm& form;  // the host's
  Host host;
};

TEST_F(Form, EditsTheOptionsItWasMadeFrom) {
  QTest::keyClick(&type("iterations", "250"), Qt::Key_Tab);
  QTest::keyClick(&type("rate", "3e-5"), Qt::Key_Return);
  auto* solver = form.editor("solver")->findChild<QComboBox*>();
  solver->setFocus();
  QTest::keyClick(solver, Qt::Key_Down);
  QTest::keyClick(form.editor("careful")->findChild<QCheckBox*>(), Qt::Key_Space);
  EXPECT_EQ(options.iterations, 250);
  EXPECT_EQ(options.rate, 3e-5);
  EXPECT_EQ(options.solver, "adam");
  EXPECT_FALSE(options.careful);
  EXPECT_EQ(edits, 4);
}

TEST_F(Form, RefusesWhatIsOutOfRangeOrNoNumberAndSaysSo) {
  for (const char* wrong : {"0", "100001", "many", "2.5", "1,00", "1e9"}) {
    type("iterations", wrong);
    EXPECT_EQ(form.takeOver()->toStdString(),
              "Iterations expects a whole number from 1 to 100,000, found \"" + std::string(wrong) + "\"");
    EXPECT_EQ(options.iterations, 100) << wrong;
    EXPECT_EQ(line("iterations").text().toStdString(), wrong);
    EXPECT_TRUE(line("iterations").property("wrong").toBool());
    EXPECT_TRUE(line("iterations").toolTip().contains("expects")) << wrong;
  }
  QTest::keyClick(&line("iterations"), Qt::Key_Backspace);
  line("iterations").selectAll();
  QTest::keyClick(&line("iterations"), Qt::Key_Delete);
  EXPECT_TRUE(form.trouble().endsWith("found nothing")) << form.trouble().toStdString();
  type("exact", "-1");
  EXPECT_EQ(form.trouble().toStdString(),
            "Exact expects a number of at least 0, found \"-1\" (and 1 more field)");
  EXPECT_EQ(edits, 0);
}

TEST_F(Form, TakesWholeNumbersAsTheyAreWritten) {
  for (const auto& [text, value] : {std::pair{"12,000", 12000}, {"1e3", 1000}, {" 77 ", 77}, {"5.0", 5}}) {
    type("iterations", text);
    EXPECT_FALSE(form.takeOver()) << text;
    EXPECT_EQ(options.iterations, value) << text;
  }
}

TEST_F(Form, KeepsWhatIsTypedThroughRefreshesUntilItIsTakenOver) {
  type("iterations", "25");
  type("rate", "0.5x");
  refresh();
  EXPECT_EQ(line("iterations").text(), "25") << "taken when the field was left";
  EXPECT_EQ(options.iterations, 25);
  EXPECT_EQ(line("rate").text(), "0.5x");
  EXPECT_TRUE(form.takeOver());
  EXPECT_TRUE(form.advancedShown()) << "the wrong field is not in the folded part";
  type("rate", "0.5");
  refresh();
  EXPECT_NE(options.rate, 0.5);
  EXPECT_FALSE(form.takeOver());
  EXPECT_EQ(options.rate, 0.5);
  EXPECT_TRUE(form.trouble().isEmpty());
}

TEST_F(Form, KeepsReturnAndEscapeFromTheWindow) {
  QLineEdit& field = type("iterations", "30");
  QTest::keyClick(&field, Qt::Key_Return);
  EXPECT_EQ(options.iterations, 30);
  EXPECT_TRUE(field.hasFocus());
  type("iterations", "abc");
  QTest::keyClick(&field, Qt::Key_Enter, Qt::KeypadModifier);
  EXPECT_EQ(field.text(), "abc");
  QTest::keyClick(&field, Qt::Key_Escape);
  EXPECT_EQ(field.text(), "30");
  EXPECT_FALSE(field.property("wrong").toBool());
  EXPECT_TRUE(form.trouble().isEmpty());
  EXPECT_TRUE(host.keys.empty());
}

TEST_F(Form, KeepsTheBitsOfWhatNobodyTypedInto) {
  options.rate = 1.6e-4f;
  refresh();
  EXPECT_EQ(line("exact").text().toStdString(), "0.123457");
  EXPECT_FALSE(line("exact").toolTip().contains("0.1234567890123"));
  EXPECT_EQ(line("rate").text().toStdString(), "0.00016");
  for (const char* name : {"exact", "rate"}) {
    line(name).setFocus();
    QTest::keyClick(&line(name), Qt::Key_Return);
    QTest::keyClick(&line(name), Qt::Key_Tab);
    EXPECT_FALSE(form.takeOver());
    QTest::keyClicks(&line(name), "1");
    QTest::keyClick(&line(name), Qt::Key_Backspace);
    EXPECT_FALSE(form.takeOver());
  }
  EXPECT_EQ(options.exact, 0.1234567890123);
  EXPECT_EQ(options.rate, static_cast<double>(1.6e-4f));
  EXPECT_EQ(edits, 0);
}

TEST_F(Form, ShowsNumbersWithoutPowersOfTen) {
  EXPECT_EQ(shownText(5e-5).toStdString(), "0.00005");
  EXPECT_EQ(shownText(1.6e-5).toStdString(), "0.000016");
  EXPECT_EQ(shownText(5e5).toStdString(), "500000");
  EXPECT_EQ(shownText(1234567.0).toStdString(), "1234567");
  EXPECT_EQ(shownText(5.0 / 12).toStdString(), "0.416667");
  EXPECT_EQ(shownText(0.0).toStdString(), "0");
  EXPECT_EQ(shownText(-2.5).toStdString(), "-2.5");
}

TEST_F(Form, TellsValuesInSentencesAsAPersonDoes) {
  EXPECT_EQ(valueText(0.1234567890123).toStdString(), "0.123457");
  EXPECT_EQ(valueText(20000).toStdString(), "20,000");
  EXPECT_EQ(valueText(20000.0).toStdString(), "20,000");
  EXPECT_EQ(valueText(true).toStdString(), "on");
  EXPECT_EQ(valueText(false).toStdString(), "off");
}

TEST_F(Form, MarksWhatDiffersFromThePresetAndFoldsWhatIsAdvanced) {
  EXPECT_FALSE(form.isMarkedChanged("iterations"));
  options.iterations = 7;
  refresh();
  EXPECT_TRUE(form.isMarkedChanged("iterations"));
  EXPECT_FALSE(form.isMarkedChanged("rate"));
  EXPECT_FALSE(form.advancedShown());
  EXPECT_FALSE(form.editor("rate")->isVisibleTo(&form));
  EXPECT_TRUE(form.editor("iterations")->isVisibleTo(&form));
}

TEST_F(Form, LeavesLettersToTheWindowAndTheWheelToTheFormWhereAChoiceIsClosed) {
  auto* solver = form.editor("solver")->findChild<QComboBox*>();
  solver->setFocus();
  for (const char key : {'a', '3', 'w'}) QTest::keyClick(solver, key);
  EXPECT_EQ(host.keys, (std::vector<int>{Qt::Key_A, Qt::Key_3, Qt::Key_W}));
  EXPECT_EQ(solver->currentText(), "linear");
  line("iterations").setFocus();
  const auto turn = [&] {
    QWheelEvent wheel({5, 5}, solver->mapToGlobal({5, 5}), {}, {0, -120}, Qt::NoButton, Qt::NoModifier,
                      Qt::NoScrollPhase, false);
    QApplication::sendEvent(solver, &wheel);
  };
  turn();
  EXPECT_EQ(solver->currentText(), "linear");
  solver->setFocus();
  turn();
  EXPECT_EQ(solver->currentText(), "adam");
}

TEST_F(Form, IsWalkedThroughByTab) {
  options.careful = false;
  refresh();
  line("iterations").setFocus();
  std::set<QWidget*> visited;
  for (int i = 0; i < 12; ++i) {
    visited.insert(QApplication::focusWidget());
    QTest::keyClick(QApplication::focusWidget(), Qt::Key_Tab);
  }
  for (const char* name : {"iterations", "careful", "solver", "exact"})
    EXPECT_TRUE(visited.contains(form.editor(name)->focusProxy())) << name;
  int buttons = 0;
  for (QWidget* widget : visited) buttons += qobject_cast<QToolButton*>(widget) != nullptr;
  EXPECT_EQ(buttons, 2) << "the fold, and the reset of what is changed";
}

TEST(BuiltinStages, NeverGiveTwoSettingsOfAStageOneLabel) {
  StageRegistry registry;
  registerBuiltinStages(registry);
  for (const StageInfo& info : registry.infos()) {
    std::map<std::string, std::string> named;
    for (const Field& field : fieldsOf(*registry.make(info.id))) {
      const auto [found, fresh] = named.emplace(field.info.label, field.info.name);
      EXPECT_TRUE(fresh) << info.id << ": " << field.info.name << " and " << found->second << " are both \""
                         << field.info.label << "\"";
    }
  }
}

TEST(BuiltinStages, SayWhatASettingIsInWords) {
  StageRegistry registry;
  registerBuiltinStages(registry);
  for (const StageInfo& info : registry.infos()) {
    for (const Field& field : fieldsOf(*registry.make(info.id))) {
      const std::string words = field.info.label + " " + field.info.help + " " + rangeText(field.info);
      for (const char* bare : {"eq. ", "e+0", "e-0", "E_", "lambda", "methods ", "fig. "})
        EXPECT_EQ(words.find(bare), std::string::npos) << info.id << "." << field.info.name << ": " << words;
      EXPECT_GT(field.info.help.size(), 20u) << info.id << "." << field.info.name;
      EXPECT_EQ(field.info.help.back(), '.') << info.id << "." << field.info.name;
    }
  }
}

// Pictures that nobody looks at here.
class BlackSource final : public FrameSource {
 public:
  bool has(ViewIndex, FrameIndex) const override { return true; }
  Image<u8vec3> photo(ViewIndex, FrameIndex) const override {
    return Image<u8vec3>(64, 64, u8vec3(0), Encoding::Srgb);
  }
  Image<std::uint8_t> mask(ViewIndex, FrameIndex) const override { return Image<std::uint8_t>(64, 64); }
};

ImportedCapture sphereCapture(const fs::path&, const ImportOptions&) {
  ImportedCapture imported;
  imported.set.name = "sphere";
  for (const FrameView& view : testing::photographs({}))
    imported.set.views.push_back({view.name, view.camera, Split::Train});
  imported.set.frames = {"000000"};
  imported.set.source = std::make_shared<BlackSource>();
  imported.layout = "memory";
  return imported;
}

StudioServices services() {
  auto setup = std::make_shared<PipelineSetup>();
  registerBuiltinStages(setup->stages);
  setup->presets = fs::path(BEAM_SOURCE_DIR) / "resources" / "recipes";
  setup->open_capture = sphereCapture;
  return {.pipeline = setup, .job_device = {}, .new_renderer = {}, .make_sample = {}, .version = "test"};
}

class Settings : public ::testing::Test {
 protected:
  Settings() : model(services()), panel(*new SettingsPanel(model)), host(&panel) {
    panel.setStage("surface");
    fs::create_directory(folder / "capture");
  }
  bool open(const fs::path& path) {
    bool opened = false;
    const auto heard = QObject::connect(&model, &ProjectModel::opened, &host, [&] { opened = true; });
    model.open(path);
    const bool came = waitFor([&] { return opened && model.settled(); });
    QObject::disconnect(heard);
    return came;
  }
  bool openCapture() { return open(folder / "capture"); }
  QLineEdit& line(const std::string& name) { return *panel.form().editor(name)->findChild<QLineEdit*>(); }
  QLineEdit& type(const std::string& name, const QString& text) {
    QLineEdit& field = line(name);
    field.setFocus();
    field.selectAll();
    QTest::keyClicks(&field, text);
    return field;
  }
  FieldValue value(const std::string& name) const { return model.project().value(name); }

  TempDir folder;
  ProjectModel model;
  SettingsPanel& panel;  // the host's
  Host host;
};

TEST_F(Settings, SayWhatToOpenWhereNothingIsOpen) {
  int words = 0;
  for (const QLabel* label : panel.findChildren<QLabel*>())
    words += label->isVisible() && label->text().contains("Open a capture or a project");
  EXPECT_EQ(words, 1);
  for (const QComboBox* box : panel.findChildren<QComboBox*>()) EXPECT_FALSE(box->isVisible());
  EXPECT_FALSE(panel.takeOver());
  ASSERT_TRUE(openCapture());
  EXPECT_TRUE(line("surface.iterations").isVisible());
}

TEST_F(Settings, ChangeTheProjectWhenTypedThoughTheFieldWasNotLeft) {
  ASSERT_TRUE(openCapture());
  QLineEdit& field = type("surface.iterations", "1234");
  EXPECT_NE(value("surface.iterations"), FieldValue(1234));
  EXPECT_FALSE(panel.takeOver());
  EXPECT_TRUE(field.hasFocus());
  EXPECT_EQ(value("surface.iterations"), FieldValue(1234));
  EXPECT_TRUE(panel.form().isMarkedChanged("surface.iterations"));
}

TEST_F(Settings, KeepWhatIsTypedWhileTheProjectIsSavedAndReadAgain) {
  ASSERT_TRUE(openCapture());
  type("surface.iterations", "4321");
  ASSERT_TRUE(model.save());
  model.set("surface.cap", FieldValue(5000));
  EXPECT_EQ(line("surface.iterations").text(), "4321");
  EXPECT_FALSE(panel.takeOver());
  EXPECT_EQ(value("surface.iterations"), FieldValue(4321));
}

TEST_F(Settings, TakeWhatIsTypedOverWhenAnotherStageIsChosen) {
  ASSERT_TRUE(openCapture());
  type("surface.iterations", "1500");
  EXPECT_TRUE(panel.setStage("materials"));
  EXPECT_EQ(value("surface.iterations"), FieldValue(1500));
  EXPECT_NE(panel.form().editor("materials.roughness"), nullptr);
}

TEST_F(Settings, StayAtAStageWithAValueThatCannotBeTaken) {
  ASSERT_TRUE(openCapture());
  bool attention = false;
  QObject::connect(&panel, &SettingsPanel::attentionWanted, &host, [&] { attention = true; });
  type("surface.iterations", "abc");
  EXPECT_FALSE(panel.setStage("materials"));
  EXPECT_TRUE(attention);
  EXPECT_EQ(panel.stage(), "surface");
  EXPECT_EQ(panel.note().toStdString(),
            "Iterations expects a whole number from 10 to 1,000,000, found \"abc\"");
  EXPECT_TRUE(line("surface.iterations").hasFocus());
  QTest::keyClick(&line("surface.iterations"), Qt::Key_Escape);
  EXPECT_TRUE(panel.note().isEmpty());
  EXPECT_TRUE(panel.setStage("materials"));
}

TEST_F(Settings, DropWhatWasTypedForAnotherProject) {
  ASSERT_TRUE(openCapture());
  type("surface.iterations", "abc");
  fs::create_directory(folder / "other");
  ASSERT_TRUE(open(folder / "other"));
  EXPECT_FALSE(panel.takeOver());
  EXPECT_EQ(line("surface.iterations").text(), shownText(value("surface.iterations")));
}

TEST_F(Settings, MoveNothingWhenSomethingIsWrong) {
  ASSERT_TRUE(openCapture());
  const auto places = [&] {
    std::vector<QRect> found;
    for (const QWidget* widget : panel.findChildren<QWidget*>())
      if (widget->isVisible() && !widget->inherits("QLabel"))
        found.emplace_back(widget->mapTo(&panel, QPoint()), widget->size());
    return found;
  };
  QApplication::processEvents();
  type("surface.iterations", "1");
  QTest::keyClick(&line("surface.iterations"), Qt::Key_Escape);
  const std::vector<QRect> before = places();
  type("surface.iterations", "this is not any number at all");
  QApplication::processEvents();
  EXPECT_FALSE(panel.note().isEmpty());
  EXPECT_EQ(places(), before);
  QTest::keyClick(&line("surface.iterations"), Qt::Key_Escape);
  panel.setRunning(true);
  QApplication::processEvents();
  EXPECT_TRUE(panel.note().contains("next run"));
  EXPECT_EQ(places(), before);
}

TEST_F(Settings, CanBeReadButNotChangedInAReadOnlyProject) {
  ASSERT_TRUE(openCapture());
  EXPECT_FALSE(line("surface.iterations").isReadOnly()) << "one that is not on disk yet can be changed";
  model.set("surface.cap", FieldValue(5000));
  ASSERT_TRUE(model.save());
  const fs::path project = folder / "capture.beam";
  const auto writing = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  fs::permissions(project, writing, fs::perm_options::remove);
  ASSERT_TRUE(open(project));
  EXPECT_TRUE(panel.note().contains("read-only"));
  const FieldValue before = value("surface.iterations");
  type("surface.iterations", "77");
  EXPECT_FALSE(panel.takeOver());
  EXPECT_EQ(value("surface.iterations"), before);
  line("surface.iterations").selectAll();
  EXPECT_TRUE(line("surface.iterations").hasSelectedText());
  for (const std::string stage : {"capture", "light", "track", "surface", "materials"}) {
    ASSERT_TRUE(panel.setStage(stage));
    for (const QLineEdit* field : panel.findChildren<QLineEdit*>()) EXPECT_TRUE(field->isReadOnly());
    for (const QCheckBox* box : panel.findChildren<QCheckBox*>()) EXPECT_FALSE(box->isEnabled());
    for (const QComboBox* box : panel.findChildren<QComboBox*>()) {
      EXPECT_FALSE(box->isEnabled());
      EXPECT_TRUE(box->toolTip().contains("read-only"));
    }
    for (const FieldRow* row : panel.findChildren<FieldRow*>())
      EXPECT_FALSE(row->findChild<QToolButton*>()->isEnabled());
  }
  fs::permissions(project, fs::perms::owner_write, fs::perm_options::add);
}

TEST_F(Settings, KeepReturnFromTheWindowWhateverHasTheFocus) {
  ASSERT_TRUE(openCapture());
  QApplication::processEvents();
  std::set<QWidget*> visited;
  line("surface.iterations").setFocus();
  while (visited.insert(QApplication::focusWidget()).second) {
    QTest::keyClick(QApplication::focusWidget(), Qt::Key_Return);
    QTest::keyClick(QApplication::focusWidget(), Qt::Key_Tab);
  }
  EXPECT_GT(visited.size(), 10u) << "fields, boxes and buttons of the stage";
  EXPECT_TRUE(host.keys.empty());
}

TEST_F(Settings, CountWhatDiffersFromThePresetAndPutItAllBack) {
  ASSERT_TRUE(openCapture());
  const auto saysChanged = [&](const QString& words) {
    for (const QLabel* label : panel.findChildren<QLabel*>())
      if (label->isVisible() && label->text().contains(words)) return true;
    return false;
  };
  EXPECT_TRUE(saysChanged("All settings are those of the preset"));
  model.set("surface.iterations", FieldValue(50));
  EXPECT_TRUE(saysChanged("1 setting differs"));
  model.set("surface.cap", FieldValue(500));
  model.set("materials.roughness", FieldValue(0.5));
  EXPECT_TRUE(saysChanged("2 settings differ"));
  for (QToolButton* button : panel.findChildren<QToolButton*>())
    if (button->text() == "Reset all") QTest::mouseClick(button, Qt::LeftButton);
  EXPECT_TRUE(saysChanged("All settings are those of the preset"));
  EXPECT_EQ(value("materials.roughness"), FieldValue(0.5)) << "that of another stage stays";
}

// Every part lies inside its row and beside the others; labels have the room that their words need.
void expectFits(const FieldRow& row, const std::string& where) {
  const QList<QWidget*> parts = row.findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly);
  for (const QWidget* part : parts) {
    EXPECT_TRUE(row.rect().contains(part->geometry())) << where << " " << part->metaObject()->className();
    for (const QWidget* other : parts)
      EXPECT_TRUE(other == part || !part->geometry().intersects(other->geometry())) << where;
    if (part->inherits("beam::FieldEditor")) {
      EXPECT_GE(part->width(), part->minimumSizeHint().width()) << where;
    }
    const auto* label = qobject_cast<const QLabel*>(part);
    if (!label) continue;
    EXPECT_GE(label->height(), label->heightForWidth(label->width())) << where;
    for (const QString& word : label->text().split(' '))
      EXPECT_LE(label->fontMetrics().horizontalAdvance(word), label->width()) << where;
  }
}

TEST_F(Settings, FitANarrowPanelWithLargeWords) {
  const QFont usual = QApplication::font();
  const auto fold = [&] {
    for (QToolButton* button : panel.findChildren<QToolButton*>())
      if (button->text().startsWith("Advanced") && !panel.form().advancedShown()) button->click();
  };
  const auto laid = [&] {
    const QList<FieldRow*> rows = panel.findChildren<FieldRow*>();
    return std::all_of(rows.begin(), rows.end(), [](const FieldRow* row) {
      return row->isVisible() && row->height() >= row->heightForWidth(row->width());
    });
  };
  ASSERT_TRUE(openCapture());
  host.layout()->setContentsMargins(0, 0, 0, 0);
  for (const int size_px : {13, 20}) {
    QFont font = usual;
    font.setPixelSize(size_px);
    QApplication::setFont(font);
    for (const int width : {260, 340, 600}) {
      host.resize(width, 700);
      for (const std::string stage : {"capture", "light", "track", "surface", "materials"}) {
        ASSERT_TRUE(panel.setStage(stage));
        fold();
        EXPECT_TRUE(waitFor(laid)) << stage;
        const std::string where = stage + " at " + std::to_string(width) + " in " + std::to_string(size_px);
        EXPECT_EQ(host.width(), width) << where;
        const auto* scroll = panel.findChild<QScrollArea*>();
        EXPECT_LE(scroll->widget()->width(), scroll->viewport()->width()) << where;
        EXPECT_FALSE(scroll->horizontalScrollBar()->isVisible()) << where;
        for (const FieldRow* row : panel.findChildren<FieldRow*>()) {
          expectFits(*row, where + ": " + row->findChild<QLabel*>()->text().toStdString());
        }
      }
    }
  }
  QApplication::setFont(usual);
}

TEST(Scout, CountsInWordsThatAgreeWithTheirNumbers) {
  EXPECT_TRUE(scoutText({3, 0, "draft"}, 2).contains("1 between is interpolated"));
  EXPECT_TRUE(scoutText({5, 0, "draft"}, 2).contains("2 between are interpolated"));
  EXPECT_TRUE(scoutText({4, 0, "draft"}, 2).contains("1 after the last shows that one"));
  EXPECT_TRUE(scoutText({4, 0, "draft"}, 2).contains("first look"));
}

}  // namespace
}  // namespace beam
